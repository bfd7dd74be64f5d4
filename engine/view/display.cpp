// SPDX-License-Identifier: Apache-2.0
#include "view/display.hpp"

#include "view/develop.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace restage::view {

namespace {

constexpr std::uint32_t pack(std::uint32_t r, std::uint32_t g, std::uint32_t b) {
    return r | g << 8 | b << 16 | 0xff000000u;
}

// A reproducible colour per number; 0 is black.
std::uint32_t id_color(std::uint32_t id) {
    if (id == 0) return pack(0, 0, 0);
    const std::uint32_t h = id * 2654435761u; // Knuth's multiplicative hash
    return pack(64 + (h >> 24) * 3 / 4, 64 + (h >> 16 & 255) * 3 / 4, 64 + (h >> 8 & 255) * 3 / 4);
}

using render::LayerLook;

void show_direction(std::span<const glm::vec3> directions, std::uint32_t* out) {
    for (const glm::vec3& direction : directions) {
        const glm::vec3 c = glm::clamp(direction * 0.5f + 0.5f, 0.f, 1.f) * 255.f;
        *out++ = pack(std::uint32_t(c.x), std::uint32_t(c.y), std::uint32_t(c.z));
    }
}

std::uint32_t grey(float fraction) {
    const auto v = std::uint32_t(std::lround(std::clamp(fraction, 0.f, 1.f) * 255));
    return pack(v, v, v);
}

Scale show_distance(std::span<const float> distances, std::uint32_t* out) { // near is bright
    float farthest = 0;
    for (const float z : distances)
        if (std::isfinite(z)) farthest = std::max(farthest, z);
    for (const float z : distances)
        *out++ = z > 0 ? scale_color(1 - z / std::max(farthest, 1e-30f) * 0.95f) : pack(0, 0, 0);
    return {.dark = farthest / 0.95f, .bright = 0, .unit = " away"};
}

Developing developing(const DisplaySettings& s, const render::FilmImage& image) {
    return {.how = s.development, .factor = s.scale * std::exp2(s.exposure), .coverage = image.opacity()};
}

// Relative standard error of luminance, logarithmic from 1e-3 to 1.
Scale show_error(const render::FilmImage& image, std::uint32_t* out) {
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const float mean = glm::dot(image.color[i], glm::vec3(0.2126f, 0.7152f, 0.0722f));
        const float error = std::sqrt(std::max(image.luminance_variance[i], 0.f)) / (std::abs(mean) + 0.01f);
        out[i] = scale_color(std::log10(std::max(error, 1e-3f)) / 3 + 1);
    }
    return {.dark = 0.1f, .bright = 100, .logarithmic = true, .unit = " %"};
}

Scale show_samples(const render::FilmImage& image, std::span<const std::uint32_t> counts, std::uint32_t* out) {
    const std::size_t n = image.pixels();
    std::uint32_t most = image.samples;
    if (counts.size() == n) most = std::max(*std::ranges::max_element(counts), 1u);
    for (std::size_t i = 0; i < n; ++i)
        out[i] = scale_color(float(counts.size() == n ? counts[i] : most) / float(std::max(most, 1u)));
    return {.dark = 0, .bright = float(most), .unit = " samples"};
}

const char* about(LayerLook look) {
    switch (look) {
        case LayerLook::light:
            return "The path-traced picture";
        case LayerLook::reflectance:
            return "Surface colours, without light";
        case LayerLook::direction:
            return "Where surfaces face: x red, y green, z blue";
        case LayerLook::distance:
            return "Distance from the camera";
        default:
            return "A colour of its own for each";
    }
}

constexpr int most_stops = 5; // zones of brighter and darker light are the last ones
constexpr std::array zones{
    ExposureZone{"Black", 0xffa03c78}, ExposureZone{"-5", 0xff781e1e}, ExposureZone{"-4", 0xffb44628},
    ExposureZone{"-3", 0xffdc7828},    ExposureZone{"-2", 0xffc8aa3c}, ExposureZone{"-1", 0xff8caa5a},
    ExposureZone{"0", 0xff46b43c},     ExposureZone{"+1", 0xff50c8aa}, ExposureZone{"+2", 0xff46d2e6},
    ExposureZone{"+3", 0xff3ca0f0},    ExposureZone{"+4", 0xff466ee6}, ExposureZone{"+5", 0xffaa96eb},
    ExposureZone{"White", 0xff2828e6}};
static_assert(zones.size() == 2 * most_stops + 3);

void show_exposure(const render::FilmImage& image, const DisplaySettings& settings, std::uint32_t* out) {
    Developing d = developing(settings, image);
    d.coverage = {};
    develop(image.color, image.width, image.height, d, out);
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        const std::uint32_t seen = out[i] & 0xffffff;
        if (seen == 0) {
            out[i] = zones.front().color;
        } else if ((seen & 0xff) == 0xff || (seen & 0xff00) == 0xff00 || (seen & 0xff0000) == 0xff0000) {
            out[i] = zones.back().color;
        } else {
            const float light = glm::dot(image.color[i], glm::vec3(0.2126f, 0.7152f, 0.0722f)) * d.factor;
            const float stops =
                std::clamp(std::log2(std::max(light, 1e-30f) / 0.18f), -float(most_stops), float(most_stops));
            out[i] = zones[std::size_t(std::lround(stops) + most_stops + 1)].color;
        }
    }
}

} // namespace

static_assert(clay_layer == "clay" && wire_layer == "wires" && uv_layer == "uv" && samples_layer == "samples" &&
              error_layer == "error" && exposure_layer == "exposure"); // as below, where they are C strings

std::span<const ExposureZone> exposure_zones() { return zones; }

std::span<const LayerChoice> layer_choices() {
    static const std::vector<LayerChoice> choices = [] {
        std::vector<LayerChoice> all;
        render::each_film_layer([&](const auto& layer) {
            if (layer.look != LayerLook::hidden) all.push_back({layer.name, layer.label, about(layer.look)});
            if (layer.look == LayerLook::light) {
                all.push_back({"clay", "Clay", "The shape of things alone: nothing is traced meanwhile"});
                all.push_back({"wires", "Wireframe", "Edges of triangles; where these are small, fainter"});
                all.push_back({"uv", "UV checker",
                               "Texture coordinates: chequers of 1/8, redder with u, greener with v; blue = none"});
            }
        });
        all.push_back({"samples", "Samples", "How many samples each pixel got"});
        all.push_back({"error", "Error", "Estimated relative error of each pixel"});
        all.push_back(
            {"exposure", "Exposure", "Light in stops from middle grey, and what is cut off to black and white"});
        return all;
    }();
    return choices;
}

const LayerChoice& layer_choice(std::string_view name) {
    const auto choices = layer_choices();
    const auto found = std::ranges::find_if(choices, [&](const LayerChoice& choice) { return name == choice.name; });
    return found == choices.end() ? choices.front() : *found;
}

std::optional<render::ClayLook> look_of(std::string_view layer) {
    if (layer == clay_layer) return render::ClayLook::clay;
    if (layer == wire_layer) return render::ClayLook::wires;
    if (layer == uv_layer) return render::ClayLook::uv;
    return std::nullopt;
}

// Black, blue, red, yellow, white.
std::uint32_t scale_color(float x) {
    static constexpr std::array<glm::vec3, 5> stops{
        glm::vec3(0), glm::vec3(0.1f, 0.1f, 0.6f), glm::vec3(0.8f, 0.1f, 0.2f), glm::vec3(1, 0.8f, 0.1f), glm::vec3(1)};
    const float s = std::clamp(x, 0.f, 1.f) * 4;
    const auto i = std::min(std::size_t(s), std::size_t(3));
    const glm::vec3 c = glm::mix(stops[i], stops[i + 1], s - float(i)) * 255.f;
    return pack(std::uint32_t(c.x), std::uint32_t(c.y), std::uint32_t(c.z));
}

Scale to_display(const render::FilmImage& image, const DisplaySettings& settings, std::vector<std::uint32_t>& rgba,
                 std::span<const std::uint32_t> counts) {
    rgba.resize(image.pixels());
    if (settings.layer == error_layer) return show_error(image, rgba.data());
    if (settings.layer == samples_layer) return show_samples(image, counts, rgba.data());
    if (settings.layer == exposure_layer) {
        show_exposure(image, settings, rgba.data());
        return {};
    }
    Scale scale;
    if (look_of(settings.layer)) develop(image.color, image.width, image.height, {}, rgba.data());
    render::each_film_layer([&]<class V>(const render::FilmLayer<V>& layer) {
        if (settings.layer != layer.name) return;
        const std::vector<V>& values = image.*layer.values;
        if constexpr (std::is_same_v<V, glm::vec3>) {
            if (layer.look == LayerLook::light)
                develop(values, image.width, image.height, developing(settings, image), rgba.data());
            else if (layer.look == LayerLook::direction)
                show_direction(values, rgba.data());
            else
                develop(values, image.width, image.height, {}, rgba.data());
        } else if constexpr (std::is_same_v<V, float>) {
            if (layer.look == LayerLook::distance)
                scale = show_distance(values, rgba.data());
            else
                std::ranges::transform(values, rgba.begin(), grey);
        } else if constexpr (std::is_same_v<V, std::uint32_t>) {
            std::ranges::transform(values, rgba.begin(), id_color);
        }
    });
    return scale;
}

void over_checkers(std::uint32_t width, std::vector<std::uint32_t>& rgba) {
    constexpr std::uint32_t side = 8, light = 0x99, dark = 0x66;
    for (std::size_t i = 0; i < rgba.size(); ++i) {
        const std::uint32_t alpha = rgba[i] >> 24;
        if (alpha == 255) continue;
        const std::uint32_t square = ((i % width / side) + (i / width / side)) % 2 ? light : dark;
        const auto mixed = [&](int shift) { return ((rgba[i] >> shift & 255) * alpha + square * (255 - alpha)) / 255; };
        rgba[i] = pack(mixed(0), mixed(8), mixed(16));
    }
}

bool to_outlines(const render::FilmImage& image, std::span<const std::uint8_t> marks, int width,
                 std::array<std::uint32_t, 2> colors, std::vector<std::uint32_t>& rgba) {
    const int w = int(image.width), h = int(image.height), stride = w + 2 * width;
    rgba.clear();
    // With a margin, so that neighbours need no bounds checks.
    std::vector<std::uint8_t> own(std::size_t(stride) * (h + 2 * width), 0);
    bool any = false;
    for (int y = 0; y < h; ++y) {
        const std::uint32_t* ids = image.instance_id.data() + std::size_t(y) * w;
        std::uint8_t* row = own.data() + std::size_t(y + width) * stride + width;
        for (int x = 0; x < w; ++x) {
            row[x] = ids[x] < marks.size() ? marks[ids[x]] : 0;
            any |= row[x] != 0;
        }
    }
    if (!any) return false;
    rgba.resize(std::size_t(w) * h);
    const std::uint32_t ring[3] = {0, colors[0], colors[1]};
    std::vector<std::uint8_t> near(std::size_t(w), 0);
    for (int y = 0; y < h; ++y) {
        const std::uint8_t* row = own.data() + std::size_t(y + width) * stride + width;
        std::ranges::fill(near, std::uint8_t(0));
        for (int d = 1; d <= width; ++d)
            for (int x = 0; x < w; ++x)
                near[x] = std::max({near[x], row[x - d], row[x + d], row[x - d * stride], row[x + d * stride]});
        for (int x = 0; x < w; ++x)
            rgba[std::size_t(y) * w + x] = near[x] > row[x] ? ring[near[x]] : 0;
    }
    return true;
}

} // namespace restage::view
