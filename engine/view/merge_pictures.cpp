// SPDX-License-Identifier: Apache-2.0
#include "view/merge_pictures.hpp"

#include "io/exr.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>

namespace restage::view {

using render::FilmImage;

namespace {

double luminance(const glm::vec3& c) { return glm::dot(glm::dvec3(c), glm::dvec3(0.2126, 0.7152, 0.0722)); }

// Sums and sums of squares are what adds up: the film's mean and the error of the mean give them back.
template <class D> // double or dvec3
struct Moments {
    D sum{0}, square{0};
    double n = 0;
    void add(const D& mean, const D& variance_of_mean, double count) {
        sum += count * mean;
        square += count * (variance_of_mean * (count - 1) + mean * mean);
        n += count;
    }
    D mean() const { return sum / n; }
    D variance_of_mean() const {
        const D m = mean();
        return n > 1 ? glm::max((square / n - m * m) / (n - 1), D(0)) : D(0);
    }
};

void merge_pixel(std::span<const PicturePart> parts, std::size_t i, FilmImage& out) {
    Moments<glm::dvec3> color;
    Moments<double> light;
    glm::dvec3 albedo(0), normal(0);
    double depth = 0;
    for (const PicturePart& part : parts) {
        const FilmImage& film = *part.film;
        const double n = film.samples;
        const glm::dvec3 error = film.std_error[i];
        color.add(film.color[i], error * error, n);
        light.add(luminance(film.color[i]), film.luminance_variance[i], n);
        albedo += n * glm::dvec3(film.albedo[i]);
        normal += n * glm::dvec3(film.normal[i]);
        depth += n * film.depth[i];
    }
    out.color[i] = color.mean();
    out.std_error[i] = glm::sqrt(color.variance_of_mean());
    out.luminance_variance[i] = float(light.variance_of_mean());
    out.albedo[i] = albedo / color.n;
    out.normal[i] = normal / color.n;
    out.depth[i] = float(depth / color.n);
}

// Channel `name` of a layer: its place in the interleaved values, or none.
std::ptrdiff_t place(const io::ExrLayer& layer, const std::string& name) {
    const auto found = std::find(layer.channels.begin(), layer.channels.end(), name);
    return found == layer.channels.end() ? -1 : found - layer.channels.begin();
}

// f(pixel, values of the channels `names` there) where the image has a layer with all of them.
template <class V, class F>
bool each_pixel(const io::ExrImage& image, const std::string& name, const std::vector<V> io::ExrLayer::* values,
                std::initializer_list<const char*> names, F&& f) {
    const io::ExrLayer* layer = image.find(name);
    if (!layer || (layer->*values).empty()) return false;
    std::vector<std::size_t> at;
    for (const char* channel : names) {
        const std::ptrdiff_t found = place(*layer, channel);
        if (found < 0) return false;
        at.push_back(std::size_t(found));
    }
    std::vector<V> here(at.size());
    for (std::size_t i = 0; i < std::size_t{image.width} * image.height; ++i) {
        for (std::size_t k = 0; k < at.size(); ++k)
            here[k] = (layer->*values)[i * layer->channels.size() + at[k]];
        f(i, here);
    }
    return true;
}

std::string metadata(const StoredPicture& p, const char* key) {
    const auto found = p.metadata.find(key);
    return found == p.metadata.end() ? "" : found->second;
}

// The numbers of "0:0+64,1:0+64", three a range; nothing when it is something else.
std::vector<SampleRange> parse_ranges(const std::string& text) {
    std::vector<SampleRange> out;
    const char *at = text.data(), *end = at + text.size();
    const auto next = [&](std::uint32_t& x, char stop) {
        const auto [to, code] = std::from_chars(at, end, x);
        const bool good = code == std::errc() && (to == end ? stop == ',' : *to == stop);
        at = to == end ? end : to + 1;
        return good;
    };
    while (at < end) {
        SampleRange r;
        if (!next(r.seed, ':') || !next(r.first, '+') || !next(r.count, ',')) return {};
        out.push_back(r);
    }
    return out;
}

std::uint64_t end_of(const SampleRange& r) { return std::uint64_t{r.first} + r.count; }

// Sorted, those that touch as one; what two of them have in common is an error.
Result<std::vector<SampleRange>> join(std::vector<SampleRange> ranges) {
    std::ranges::sort(ranges, {}, [](const SampleRange& r) { return std::pair(r.seed, r.first); });
    std::vector<SampleRange> out;
    for (const SampleRange& r : ranges) {
        if (out.empty() || out.back().seed != r.seed || end_of(out.back()) < r.first) {
            out.push_back(r);
            continue;
        }
        if (end_of(out.back()) > r.first)
            return fail(
                fmt::format("two of the pictures hold the same samples, of seed {} from number {} on; render "
                            "parts with another --seed or --first-sample",
                            r.seed, r.first));
        out.back().count += r.count;
    }
    return out;
}

} // namespace

Result<FilmImage> merge_films(std::span<const PicturePart> parts) {
    if (parts.empty()) return fail("there are no pictures to merge");
    const PicturePart& earliest = *std::ranges::min_element(parts, {}, &PicturePart::first_sample);
    FilmImage out = *earliest.film; // its ids are those of the first sample
    std::uint64_t samples = 0;
    for (const PicturePart& part : parts) {
        if (part.film->width != out.width || part.film->height != out.height)
            return fail("the pictures to merge have different sizes");
        if (part.film->samples == 0) return fail("a picture to merge has no samples");
        samples += part.film->samples;
    }
    out.samples = std::uint32_t(std::min<std::uint64_t>(samples, ~0u));
    for (std::size_t i = 0; i < out.color.size(); ++i)
        merge_pixel(parts, i, out);
    return out;
}

double relative_error(const FilmImage& film) {
    double sum = 0;
    for (std::size_t i = 0; i < film.color.size(); ++i) {
        const double l = luminance(film.color[i]) + 0.01;
        sum += film.luminance_variance[i] / (l * l);
    }
    return film.samples > 1 ? std::sqrt(sum / double(film.color.size())) : 1e30;
}

std::string to_text(std::span<const SampleRange> ranges) {
    std::string text;
    for (const SampleRange& r : ranges)
        text += fmt::format("{}{}:{}+{}", text.empty() ? "" : ",", r.seed, r.first, r.count);
    return text;
}

Result<StoredPicture> read_picture(const std::string& path) {
    RESTAGE_TRY(io::ExrImage image, io::read_exr(path));
    StoredPicture out;
    out.metadata = std::move(image.metadata);
    FilmImage& film = out.film;
    film = FilmImage::blank(image.width, image.height);
    out.ranges = parse_ranges(metadata(out, "restage:ranges"));
    for (const SampleRange& r : out.ranges)
        film.samples += r.count;
    if (film.samples == 0)
        return fail(path +
                    ": does not say how many samples it has; only pictures that `restage render` wrote as .exr "
                    "can be continued and merged");
    const auto to = [](std::vector<glm::vec3>& where) {
        return [&where](std::size_t i, const std::vector<float>& v) { where[i] = {v[0], v[1], v[2]}; };
    };
    constexpr auto floats = &io::ExrLayer::values;
    // Errors are those of the path-traced picture; where it was denoised, that is the layer "noisy".
    if (!each_pixel(image, image.find("noisy") ? "noisy" : "", floats, {"R", "G", "B"}, to(film.color)))
        return fail(path + ": has no colours");
    const bool has_errors = each_pixel(image, "stderr", floats, {"R", "G", "B"}, to(film.std_error)) &&
                            each_pixel(image, "stderr", floats, {"Y"}, [&](std::size_t i, const std::vector<float>& v) {
                                film.luminance_variance[i] = v[0] * v[0];
                            });
    if (!has_errors)
        return fail(path +
                    ": has no layer \"stderr\" with R, G, B and Y, so that nothing can be added to it; render "
                    "with --aov all or stderr");
    out.layers.insert("stderr");
    if (each_pixel(image, "albedo", floats, {"R", "G", "B"}, to(film.albedo))) out.layers.insert("albedo");
    if (each_pixel(image, "normal", floats, {"X", "Y", "Z"}, to(film.normal))) out.layers.insert("normal");
    if (each_pixel(image, "depth", floats, {"Z"},
                   [&](std::size_t i, const std::vector<float>& v) { film.depth[i] = v[0]; }))
        out.layers.insert("depth");
    if (each_pixel(image, "id", &io::ExrLayer::integers, {"instance", "material"},
                   [&](std::size_t i, const std::vector<std::uint32_t>& v) {
                       film.instance_id[i] = v[0];
                       film.material_id[i] = v[1];
                   }))
        out.layers.insert("id");
    return out;
}

Result<> same_render(const std::map<std::string, std::string>& first, const std::map<std::string, std::string>& other) {
    const auto value = [](const auto& all, const char* key) {
        const auto it = all.find(key);
        return it == all.end() ? std::string() : it->second;
    };
    for (const char* key : {"restage:scene", "restage:changes", "restage:strategy", "restage:max_depth"})
        if (value(first, key) != value(other, key))
            return fail(fmt::format("is of another render: its {} is \"{}\", not \"{}\"", std::string(key).substr(8),
                                    value(other, key), value(first, key)));
    return {};
}

Result<StoredPicture> merge_pictures(std::span<const StoredPicture> pictures) {
    if (pictures.empty()) return fail("there are no pictures to merge");
    StoredPicture out{.film = {}, .layers = pictures[0].layers, .metadata = pictures[0].metadata, .ranges = {}};
    std::vector<PicturePart> parts;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        const StoredPicture& p = pictures[i];
        if (auto same = same_render(out.metadata, p.metadata); !same)
            return fail(fmt::format("picture {}", i + 1), same.error());
        out.ranges.insert(out.ranges.end(), p.ranges.begin(), p.ranges.end());
        std::erase_if(out.layers, [&](const std::string& layer) { return !p.layers.contains(layer); });
        parts.push_back({.film = &p.film, .first_sample = p.ranges.empty() ? 0 : p.ranges.front().first});
    }
    RESTAGE_TRY(out.ranges, join(std::move(out.ranges)));
    RESTAGE_TRY(out.film, merge_films(parts));
    out.metadata["restage:samples"] = std::to_string(out.film.samples);
    out.metadata["restage:ranges"] = to_text(out.ranges);
    out.metadata["restage:denoiser"] = "none";
    return out;
}

} // namespace restage::view
