// SPDX-License-Identifier: Apache-2.0
// Parts of one picture that were rendered apart (other seeds, or other samples of one seed), put together.
#pragma once

#include "base/result.hpp"
#include "render/film_layers.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace restage::view {

struct PicturePart {
    const render::FilmImage* film;
    std::uint32_t first_sample = 0;
};
// Means weighted by the numbers of samples, with the standard error that all samples have together; ids are those of
// the part with the earliest first sample. An error when sizes differ or a part has no samples. [any]
Result<render::FilmImage> merge_films(std::span<const PicturePart>);

// As Film::relative_error; 1e30 with less than two samples.
double relative_error(const render::FilmImage&);

// Samples of a pixel, by number, that are in a picture.
struct SampleRange {
    std::uint32_t seed = 0, first = 0, count = 0;
};
std::string to_text(std::span<const SampleRange>); // "0:0+64,1:0+64": as metadata "restage:ranges"

// What write_picture wrote as .exr: the path-traced picture, also of a file that holds a denoised one.
struct StoredPicture {
    render::FilmImage film; // the exposure of the file is in it; layers that the file lacks are 0
    std::set<std::string> layers;
    std::map<std::string, std::string> metadata;
    std::vector<SampleRange> ranges; // in order of seed and first
};
// An error when it does not say how many samples it has, or has no layer `stderr`.
Result<StoredPicture> read_picture(const std::string& path);

// Is `other` of another render than `first`: another scene, other changes or settings? Then a sentence says what
// differs.
Result<> same_render(const std::map<std::string, std::string>& first, const std::map<std::string, std::string>& other);

// Several such files as one. Refused: parts of other scenes, sizes or settings, and parts that share samples.
Result<StoredPicture> merge_pictures(std::span<const StoredPicture>);

} // namespace restage::view
