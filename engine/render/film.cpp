// SPDX-License-Identifier: Apache-2.0
#include "render/film.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::render {

Result<Film> Film::create(gpu::Device& device, std::uint32_t width, std::uint32_t height) {
    Film film;
    film.width_ = width;
    film.height_ = height;
    const std::size_t n = std::size_t(width) * height;
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
    each_film_layer([&](const auto& layer) { (image.*layer.values).resize(image.pixels()); });
    return image;
}

FilmImage Film::read() const {
    FilmImage image = FilmImage::blank(width_, height_);
    const std::size_t n = image.pixels();
    const auto pixels = pixels_.span<shared::FilmPixel>();
    const auto guides = guides_.span<shared::GuidePixel>();
    for (std::size_t i = 0; i < n; ++i) {
        const auto& p = pixels[i];
        if (p.count > 0) {
            const double count = p.count;
            const glm::dvec3 mean = glm::dvec3(p.sum) / count;
            image.color[i] = mean;
            if (p.count > 1) {
                const glm::dvec3 variance = (glm::dvec3(p.sum_sq) / count - mean * mean) / (count - 1);
                image.std_error[i] = glm::sqrt(glm::max(variance, glm::dvec3(0)));
                const double l = glm::dot(mean, glm::dvec3(0.2126, 0.7152, 0.0722));
                image.luminance_variance[i] = float(std::max(0.0, (p.sum_sq_luminance / count - l * l) / (count - 1)));
            }
        }
    }
    each_film_layer([&](const auto& layer) {
        if (layer.source == LayerSource::samples) return;
        auto& values = image.*layer.values;
        for (std::size_t i = 0; i < n; ++i) {
            const shared::GuidePixel& g = guides[i];
            if (g.count <= 0) continue;
            values[i] = layer.guide(g);
            if (layer.source == LayerSource::mean) values[i] /= g.count;
        }
    });
    image.samples = least_samples();
    return image;
}

std::uint32_t Film::least_samples() const {
    const auto pixels = pixels_.span<shared::FilmPixel>().first(std::size_t(width_) * height_);
    const auto least =
        std::min_element(pixels.begin(), pixels.end(), [](const auto& a, const auto& b) { return a.count < b.count; });
    return least == pixels.end() ? 0 : std::uint32_t(least->count);
}

double Film::relative_error() const {
    double sum = 0;
    const auto pixels = pixels_.span<shared::FilmPixel>();
    std::size_t n = 0;
    for (const auto& p : pixels.first(std::size_t(width_) * height_)) {
        if (p.count < 2) continue;
        const double count = p.count;
        const double mean = glm::dot(glm::dvec3(p.sum), glm::dvec3(0.2126, 0.7152, 0.0722)) / count;
        const double variance = std::max(0.0, (p.sum_sq_luminance / count - mean * mean) / (count - 1));
        sum += variance / ((mean + 0.01) * (mean + 0.01));
        ++n;
    }
    return n ? std::sqrt(sum / double(n)) : 1e30;
}

} // namespace restage::render
