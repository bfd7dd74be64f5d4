// SPDX-License-Identifier: Apache-2.0
#include "view/merge_pictures.hpp"

#include "io/exr.hpp"
#include "render/catcher.hpp"
#include "render/film_error.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

namespace restage::view {

using render::FilmImage;

namespace {

// Sums and sums of squares are additive: recover them from the film's mean and the error that independent samples have.
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
    Moments<double> light, twin;
    for (const PicturePart& part : parts) {
        const FilmImage& film = *part.film;
        const double n = film.samples;
        const glm::dvec3 error = film.sample_error[i];
        color.add(film.color[i], error * error, n);
        light.add(render::luminance(film.color[i]), render::independent_variance(film, i), n);
        const glm::dvec2 t = film.twin[i];
        if (t.y > 0) twin.add(t.x, t.y * t.y, n);
    }
    out.color[i] = color.mean();
    out.sample_error[i] = glm::sqrt(color.variance_of_mean());
    out.luminance_variance[i] = float(light.variance_of_mean());
    out.twin[i] =
        twin.n > 0 ? glm::dvec2(twin.mean(), std::max(std::sqrt(twin.variance_of_mean()), 1e-20)) : glm::dvec2(0);
}

// Ids and other first-sample layers stay those of `out`.
template <class V>
void merge_means(std::span<const PicturePart> parts, const render::FilmLayer<V>& layer, FilmImage& out) {
    if constexpr (std::is_same_v<V, float> || std::is_same_v<V, glm::vec3>) {
        using Sum = std::conditional_t<std::is_same_v<V, float>, double, glm::dvec3>;
        if (std::ranges::any_of(parts, [&](const PicturePart& p) { return (p.film->*layer.values).empty(); })) {
            (out.*layer.values).clear(); // of catchers
            return;
        }
        double samples = 0;
        std::vector<Sum> sums(out.pixels(), Sum(0));
        for (const PicturePart& part : parts) {
            const double n = part.film->samples;
            samples += n;
            for (std::size_t i = 0; i < sums.size(); ++i)
                sums[i] += n * Sum((part.film->*layer.values)[i]);
        }
        for (std::size_t i = 0; i < sums.size(); ++i)
            (out.*layer.values)[i] = V(sums[i] / samples);
    }
}

// Channel `name` of a layer: its place in the interleaved values, or none.
std::ptrdiff_t place(const io::ExrLayer& layer, const std::string& name) {
    const auto found = std::find(layer.channels.begin(), layer.channels.end(), name);
    return found == layer.channels.end() ? -1 : found - layer.channels.begin();
}

// The positions of a film layer's channels in a file's layer, or empty if it lacks one.
template <class V>
std::vector<std::size_t> places(const io::ExrImage& image, const std::string& name, const render::FilmLayer<V>& layer) {
    const io::ExrLayer* in = image.find(name);
    if (!in || (std::is_same_v<V, std::uint32_t> ? in->integers.empty() : in->values.empty())) return {};
    std::vector<std::size_t> at;
    for (std::size_t k = 0; k < sizeof(V) / 4; ++k) {
        const std::ptrdiff_t found = place(*in, layer.channels[k]);
        if (found < 0) return {};
        at.push_back(std::size_t(found));
    }
    return at;
}

// The inverse of write_picture's add_layer().
template <class V>
void read_layer(const io::ExrImage& image, const std::string& name, const render::FilmLayer<V>& layer,
                FilmImage& film) {
    const std::vector<std::size_t> at = places(image, name, layer);
    const io::ExrLayer& in = *image.find(name);
    const std::size_t stride = in.channels.size();
    std::vector<V>& values = film.*layer.values;
    for (std::size_t i = 0; i < values.size(); ++i)
        if constexpr (std::is_same_v<V, std::uint32_t>) {
            values[i] = in.integers[i * stride + at[0]];
        } else if constexpr (std::is_same_v<V, float>) {
            const float v = in.values[i * stride + at[0]];
            values[i] = layer.source == render::LayerSource::samples ? v * v : v;
        } else {
            for (std::size_t k = 0; k < at.size(); ++k)
                values[i][int(k)] = in.values[i * stride + at[k]];
        }
}

std::string metadata(const StoredPicture& p, const char* key) {
    const auto found = p.metadata.find(key);
    return found == p.metadata.end() ? "" : found->second;
}

// The numbers of "0:0+64,1:0+64", three per range; empty if malformed.
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

// Sorted, adjacent ranges merged; overlap is an error.
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

Result<FilmImage> merge_linear(std::span<const PicturePart> parts) {
    const PicturePart& earliest = *std::ranges::min_element(parts, {}, &PicturePart::first_sample);
    FilmImage out = *earliest.film; // its ids are those of the first sample
    out.alpha.clear();
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
    render::correct_errors(out);
    render::each_film_layer([&](const auto& layer) {
        if (layer.source == render::LayerSource::mean || layer.source == render::LayerSource::radiance)
            merge_means(parts, layer, out);
    });
    return out;
}

} // namespace

Result<FilmImage> merge_films(std::span<const PicturePart> parts) {
    if (parts.empty()) return fail("no pictures to merge");
    // Shadows on catchers are ratios of means: those of the whole follow from its layers.
    if (std::ranges::all_of(parts, [](const PicturePart& part) { return render::has_catchers(*part.film); })) {
        std::vector<FilmImage> bare;
        std::vector<PicturePart> bare_parts;
        bare.reserve(parts.size());
        for (const PicturePart& part : parts) {
            render::remove_shadows(bare.emplace_back(*part.film));
            bare_parts.push_back({.film = &bare.back(), .first_sample = part.first_sample});
        }
        RESTAGE_TRY(FilmImage out, merge_linear(bare_parts));
        render::add_shadows(out, render::shadow_ratios(out));
        return out;
    }
    return merge_linear(parts);
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
                    ": does not give its number of samples; only pictures that `restage render` wrote as .exr "
                    "can be continued and merged");
    // Errors belong to the path-traced picture; if denoised, that is the layer "noisy".
    const auto& color = std::get<0>(render::film_layers);
    const std::string traced = image.find("noisy") ? "noisy" : "";
    if (places(image, traced, color).empty()) return fail(path + ": has no colours");
    read_layer(image, traced, color, film);
    std::set<std::string> lacking{""};
    render::each_film_layer([&](const auto& layer) {
        if (places(image, layer.in_file, layer).empty()) lacking.insert(layer.in_file);
    });
    if (lacking.contains("stderr"))
        return fail(path +
                    ": has no layer \"stderr\" as this version writes it, so nothing can be added to it; "
                    "render it with this version and with --aov all or stderr");
    render::each_film_layer([&](const auto& layer) {
        if (lacking.contains(layer.in_file)) return;
        (film.*layer.values).resize(film.pixels());
        read_layer(image, layer.in_file, layer, film);
        out.layers.insert(layer.in_file);
    });
    if (render::has_catchers(film)) render::set_alpha(film, render::shadow_ratios(film));
    return out;
}

Result<> same_render(const std::map<std::string, std::string>& first, const std::map<std::string, std::string>& other) {
    const auto value = [](const auto& all, const char* key) {
        const auto it = all.find(key);
        return it == all.end() ? std::string() : it->second;
    };
    for (const char* key : {"restage:scene", "restage:changes", "restage:strategy", "restage:max_depth"})
        if (value(first, key) != value(other, key))
            return fail(fmt::format("is from another render: its {} is \"{}\", not \"{}\"", std::string(key).substr(8),
                                    value(other, key), value(first, key)));
    return {};
}

Result<StoredPicture> merge_pictures(std::span<const StoredPicture> pictures) {
    if (pictures.empty()) return fail("no pictures to merge");
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
