// SPDX-License-Identifier: Apache-2.0
#include "view/picture.hpp"

#include "io/exr.hpp"
#include "io/image_file.hpp"
#include "view/develop.hpp"

#include <fmt/ranges.h>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <type_traits>

namespace restage::view {

namespace {

// Film layers with the same file name become one layer there, with the channels of all.
io::ExrLayer& layer_of(io::ExrImage& image, const std::string& name) {
    for (io::ExrLayer& layer : image.layers)
        if (layer.name == name) return layer;
    return image.layers.emplace_back(io::ExrLayer{.name = name, .channels = {}});
}

// `scale`: the exposure, where it applies. A variance is written as its root, the standard error: also of luminance,
// as it does not follow from those of the channels, whose errors are correlated.
template <class V>
void add_layer(io::ExrImage& image, const std::string& name, const render::FilmLayer<V>& from,
               const std::vector<V>& values, float scale) {
    using T = std::conditional_t<std::is_same_v<V, std::uint32_t>, std::uint32_t, float>;
    constexpr std::size_t count = [] {
        if constexpr (std::is_arithmetic_v<V>)
            return std::size_t(1);
        else
            return std::size_t(V::length());
    }();
    io::ExrLayer& layer = layer_of(image, name);
    if constexpr (std::is_same_v<T, std::uint32_t>) layer.type = io::ExrType::uint32;
    auto& held = [&]() -> std::vector<T>& {
        if constexpr (std::is_same_v<T, float>)
            return layer.values;
        else
            return layer.integers;
    }();
    const std::size_t before = layer.channels.size(), stride = before + count;
    layer.channels.insert(layer.channels.end(), from.channels.begin(), from.channels.begin() + count);
    std::vector<T> all(values.size() * stride);
    for (std::size_t i = 0; i < values.size(); ++i) {
        std::copy_n(held.data() + i * before, before, &all[i * stride]);
        T* out = &all[i * stride + before];
        if constexpr (std::is_same_v<V, glm::vec3> || std::is_same_v<V, glm::vec2>)
            for (std::size_t k = 0; k < count; ++k)
                out[k] = values[i][int(k)] * scale;
        else if constexpr (std::is_same_v<V, float>)
            *out = from.source == render::LayerSource::samples ? std::sqrt(values[i]) * scale : values[i];
        else
            *out = values[i];
    }
    held = std::move(all);
}

std::string extension_of(const std::string& path) { // in lower case
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    return extension;
}

} // namespace

std::vector<std::string> aov_names() {
    std::vector<std::string> names;
    render::each_film_layer([&](const auto& layer) {
        if (*layer.in_file && (names.empty() || names.back() != layer.in_file)) names.push_back(layer.in_file);
    });
    return names;
}

Result<void> check_aovs(const std::string& aovs) {
    if (aovs == "all" || aovs == "none") return {};
    for (std::string_view rest = aovs;;) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::string_view name = rest.substr(0, comma);
        if (const auto names = aov_names(); std::ranges::find(names, name) == names.end())
            return fail(fmt::format("there is no layer \"{}\"; there are {} and {} (separated by commas), all, or none",
                                    name, fmt::join(names.begin(), names.end() - 1, ", "), names.back()));
        if (comma == rest.size()) return {};
        rest.remove_prefix(comma + 1);
    }
}

Result<void> check_picture_path(const std::string& path) {
    const std::filesystem::path p(path);
    static constexpr std::string_view known[] = {".exr", ".png", ".jpg", ".jpeg", ".pfm", ".hdr"};
    if (std::find(std::begin(known), std::end(known), extension_of(path)) == std::end(known))
        return fail(path + ": the extension selects the format: .exr, .png, .jpg, .pfm or .hdr");
    const auto folder = p.has_parent_path() ? p.parent_path() : std::filesystem::path(".");
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error))
        return fail(path + ": there is no folder " + folder.string() + "; create it first, or write elsewhere");
    if (const auto there = std::filesystem::status(p, error); exists(there) && !is_regular_file(there))
        return fail(path + ": exists already, and is not a file that can be replaced");
    return {};
}

Result<void> write_rgba(const std::string& path, std::uint32_t width, std::uint32_t height,
                        std::span<const std::uint32_t> rgba) {
    const bool opaque = std::ranges::all_of(rgba, [](std::uint32_t p) { return p >> 24 == 255; });
    scene::PixelData pixels{.width = width, .height = height, .channels = opaque ? 3u : 4u, .values = {}};
    pixels.values.reserve(rgba.size() * pixels.channels);
    for (const std::uint32_t p : rgba) {
        for (int shift = 0; shift < 24; shift += 8) // encoding gives the same 8 bits
            pixels.values.push_back(io::srgb_to_linear(float(p >> shift & 255) / 255));
        if (!opaque) pixels.values.push_back(float(p >> 24) / 255);
    }
    return io::write_image(path, pixels);
}

Result<void> write_picture(const std::string& path, const Picture& picture, const PictureOptions& o) {
    RESTAGE_CHECK(check_aovs(o.aovs));
    const render::FilmImage& film = picture.film;
    const auto& color = picture.denoised ? *picture.denoised : film.color;
    io::ExrImage image{.width = film.width, .height = film.height, .metadata = o.metadata};
    const auto& seen = std::get<0>(render::film_layers);
    add_layer(image, "", seen, color, picture.exposure);
    const std::string extension = extension_of(path);
    const bool encoded = extension == ".png" || extension == ".jpg" || extension == ".jpeg";
    if (encoded && picture.development != scene::Development{}) {
        scene::Development how = picture.development;
        if (how.backdrop == scene::Backdrop::transparent && extension != ".png") how.backdrop = scene::Backdrop::black;
        std::vector<std::uint32_t> rgba(film.pixels());
        develop(color, film.width, film.height,
                {.how = how,
                 .factor = picture.exposure * std::exp2(o.exposure_stops),
                 .window = picture.window,
                 .coverage = film.opacity()},
                rgba.data());
        return write_rgba(path, film.width, film.height, rgba);
    }
    if (extension != ".exr") {
        scene::PixelData pixels{
            .width = film.width, .height = film.height, .channels = 3, .values = std::move(image.layers[0].values)};
        if (extension == ".png") return io::write_png(path, pixels, o.exposure_stops);
        if (extension == ".jpg" || extension == ".jpeg") return io::write_jpg(path, pixels, o.exposure_stops);
        return io::write_image(path, pixels);
    }
    if (picture.development.backdrop == scene::Backdrop::transparent) // its colours are premultiplied, as in any .exr
        render::each_film_layer([&]<class V>(const render::FilmLayer<V>& layer) {
            if constexpr (std::is_same_v<V, float>)
                if (layer.values == &render::FilmImage::coverage) add_layer(image, "", layer, film.opacity(), 1);
        });
    if (picture.denoised) add_layer(image, "noisy", seen, film.color, picture.exposure);
    render::each_film_layer([&](const auto& layer) {
        const bool wanted =
            o.aovs == "all" || ("," + o.aovs + ",").find(std::string(",") + layer.in_file + ",") != std::string::npos;
        if (!*layer.in_file || !wanted || (film.*layer.values).empty()) return;
        add_layer(image, layer.in_file, layer, film.*layer.values,
                  layer.source == render::LayerSource::samples || layer.source == render::LayerSource::radiance
                      ? picture.exposure
                      : 1);
    });
    return io::write_exr(path, image);
}

} // namespace restage::view
