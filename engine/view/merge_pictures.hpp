// SPDX-License-Identifier: Apache-2.0
// Merges parts of one picture that were rendered separately (other seeds, or other samples of one seed).
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
// Means weighted by sample count, with the standard error of all samples together; ids are those of
// the part with the earliest first sample. An error if sizes differ or a part has no samples. [any]
Result<render::FilmImage> merge_films(std::span<const PicturePart>);

// The sample numbers per pixel that a picture contains.
struct SampleRange {
    std::uint32_t seed = 0, first = 0, count = 0;
};
std::string to_text(std::span<const SampleRange>); // "0:0+64,1:0+64": as metadata "restage:ranges"

// A picture written by write_picture as .exr: the path-traced one, even from a file with a denoised one.
struct StoredPicture {
    render::FilmImage film; // includes the file's exposure; layers missing from the file are 0
    std::set<std::string> layers;
    std::map<std::string, std::string> metadata;
    std::vector<SampleRange> ranges; // in order of seed and first
};
// An error if it lacks the number of samples or the layer `stderr`.
Result<StoredPicture> read_picture(const std::string& path);

// Whether `other` is from a different render than `first`: another scene, other changes or settings. The error states
// the difference.
Result<> same_render(const std::map<std::string, std::string>& first, const std::map<std::string, std::string>& other);

// Merges several such files. Refused: parts of other scenes, sizes or settings, and parts that share samples.
Result<StoredPicture> merge_pictures(std::span<const StoredPicture>);

} // namespace restage::view
