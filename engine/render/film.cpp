// SPDX-License-Identifier: Apache-2.0
#include "render/film.hpp"

#include "render/catcher.hpp"
#include "render/film_error.hpp"
#include "shared/twins.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace restage::render {

namespace {

struct Moments { // means over a pixel's samples
    glm::dvec3 color, squares;
    double squared_luminance;
};
Moments moments(const shared::FilmPixel& p) {
    const double count = p.count;
    return {(glm::dvec3(p.sum) - glm::dvec3(p.excess)) / count,
            (glm::dvec3(p.sum_sq) - glm::dvec3(p.excess_sq)) / count,
            (double(p.sum_sq_luminance) - double(p.excess_sq_luminance)) / count};
}
// Of the mean, if samples are independent.
double luminance_variance(const Moments& m, double count) {
    return count > 1 ? std::max(0.0, (m.squared_luminance - std::pow(luminance(m.color), 2)) / (count - 1)) : 0;
}

} // namespace

Result<Film> Film::create(gpu::Device& device, std::uint32_t width, std::uint32_t height) {
    Film film;
    film.width_ = width;
    film.height_ = height;
    const std::size_t n = std::size_t(width) * film.rows();
    RESTAGE_TRY(film.pixels_, device.create_buffer(n * sizeof(shared::FilmPixel), gpu::BufferKind::readback, "film"));
    RESTAGE_TRY(film.guides_,
                device.create_buffer(n * sizeof(shared::GuidePixel), gpu::BufferKind::readback, "guides"));
    film.clear();
    return film;
}

void Film::clear() {
    std::memset(pixels_.mapped(), 0, pixels_.size());
    std::memset(guides_.mapped(), 0, guides_.size());
}

FilmImage FilmImage::blank(std::uint32_t width, std::uint32_t height) {
    FilmImage image;
    image.width = width;
    image.height = height;
    each_film_layer([&](const auto& layer) {
        if (layer.source != LayerSource::radiance) (image.*layer.values).resize(image.pixels());
    });
    return image;
}

void FilmImage::expose(float exposure) {
    if (exposure == 1) return;
    each_film_layer([&](const auto& layer) {
        if (layer.source != LayerSource::samples && layer.source != LayerSource::radiance) return;
        for (auto& value : this->*layer.values)
            if constexpr (std::is_same_v<decltype(value), float&>)
                value *= layer.source == LayerSource::samples ? exposure * exposure : 1; // a variance; a fraction
            else if constexpr (!std::is_same_v<decltype(value), std::uint32_t&>)
                value *= exposure;
    });
}

std::uint32_t Film::rows() const { return height_ + (height_ + TWIN_ROWS - 1) / TWIN_ROWS; }

FilmImage Film::read() const {
    FilmImage image = FilmImage::blank(width_, height_);
    const std::size_t n = image.pixels();
    const auto pixels = pixels_.span<shared::FilmPixel>();
    const auto guides = guides_.span<shared::GuidePixel>();
    for (std::size_t i = 0; i < n; ++i) {
        const auto& p = pixels[i];
        if (p.count > 0) {
            const Moments m = moments(p);
            image.color[i] = m.color;
            if (p.count > 1) {
                const glm::dvec3 variance = (m.squares - m.color * m.color) / (double(p.count) - 1);
                image.sample_error[i] = glm::sqrt(glm::max(variance, glm::dvec3(0)));
                image.luminance_variance[i] = float(luminance_variance(m, p.count));
            }
        }
    }
    for (std::uint32_t row = 0; row < rows() - height_; ++row)
        for (std::uint32_t x = 0; x < width_; ++x) {
            const auto& p = pixels[std::size_t(height_ + row) * width_ + x];
            if (p.count <= 0) continue;
            const Moments m = moments(p);
            image.twin[std::size_t(shared::twin_of(x, row, height_)) * width_ + x] = {
                luminance(m.color), std::max(std::sqrt(luminance_variance(m, p.count)), 1e-20)}; // > 0: it is there
        }
    correct_errors(image);
    const bool catchers = std::ranges::any_of(guides.first(n), [](const auto& g) { return g.caught > 0; });
    each_film_layer([&](const auto& layer) {
        if (layer.source == LayerSource::samples || (layer.source == LayerSource::radiance && !catchers)) return;
        auto& values = image.*layer.values;
        values.resize(n);
        for (std::size_t i = 0; i < n; ++i) {
            const shared::GuidePixel& g = guides[i];
            if (g.count <= 0) continue;
            values[i] = layer.guide(g);
            if (layer.source != LayerSource::first) values[i] /= g.count;
        }
    });
    if (catchers) {
        for (std::size_t i = 0; i < n; ++i) // the film has L_with - L_without there
            image.color[i] = (image.caught[i] < 1 ? image.color[i] - image.shade[i] : glm::vec3(0)) + image.backdrop[i];
        add_shadows(image, shadow_ratios(image));
        scale_errors(image);
    }
    image.samples = least_samples();
    return image;
}

std::uint32_t Film::least_samples() const {
    const auto pixels = pixels_.span<shared::FilmPixel>().first(std::size_t(width_) * height_);
    const auto least =
        std::min_element(pixels.begin(), pixels.end(), [](const auto& a, const auto& b) { return a.count < b.count; });
    return least == pixels.end() ? 0 : std::uint32_t(least->count);
}

std::uint32_t Film::most_samples() const {
    const auto pixels = pixels_.span<shared::FilmPixel>().first(std::size_t(width_) * height_);
    const auto most =
        std::max_element(pixels.begin(), pixels.end(), [](const auto& a, const auto& b) { return a.count < b.count; });
    return most == pixels.end() ? 0 : std::uint32_t(most->count);
}

std::uint32_t Film::samples_of(std::size_t pixel) const {
    return std::uint32_t(pixels_.span<shared::FilmPixel>()[pixel].count);
}

double Film::relative_error() const { return render::relative_error(read()); }

} // namespace restage::render
