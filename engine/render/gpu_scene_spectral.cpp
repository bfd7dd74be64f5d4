// SPDX-License-Identifier: Apache-2.0
// GpuScene in spectral mode: what colours are stored as.
#include "render/gpu_scene.hpp"

namespace restage::render {

bool GpuScene::change_colors(const scene::Scene& scene) {
    const bool spectral = scene.settings.value.spectral && !grey_.passes(scene, lookup_);
    if (spectral == (colors_ != nullptr)) return false;
    colors_ = spectral ? &SpectralColors::get(*jobs_) : nullptr;
    curves_.clear();
    light_curves_ = false;
    return true;
}

Result<void> GpuScene::sync_spectral() {
    if (!colors_) return {};
    if (color_cells_.size() == 0) {
        color_cells_.assign({colors_->cells().begin(), colors_->cells().end()});
        color_film_.assign({colors_->film().begin(), colors_->film().end()});
    }
    curve_entries_.assign({curves_.entries().begin(), curves_.entries().end()});
    RESTAGE_CHECK(color_cells_.flush(*device_));
    RESTAGE_CHECK(color_film_.flush(*device_));
    return curve_entries_.flush(*device_);
}

glm::vec3 GpuScene::stored_light(const scene::Origin& origin, std::string_view id, const glm::vec3& rgb) {
    if (!colors_) return rgb;
    const auto curve = curves_.of_light(origin, id, rgb);
    light_curves_ |= curve.has_value();
    return curve ? stored_curve(*curve, float(0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z))
                 : colors_->unbounded(rgb);
}

glm::vec3 GpuScene::stored_absorption(const scene::Medium& medium) {
    if (!colors_) return medium.sigma_a;
    const auto curve = curves_.of_value(medium.origin, "sigma_a", medium.sigma_a);
    light_curves_ |= curve.has_value();
    return curve ? stored_curve(*curve, 1) : colors_->unbounded(medium.sigma_a);
}

ValueStore GpuScene::value_store(const scene::Origin& origin, bool& curves) {
    return {[&](const model::Param& line, const glm::vec3& rgb) {
                if (const auto curve = curves_.of_value(origin, line.id, rgb)) {
                    curves = true;
                    return stored_curve(*curve, 1);
                }
                return line.max <= 1 ? colors_->reflectance(rgb) : colors_->unbounded(rgb);
            },
            [&](const model::Param& line, float x) {
                const auto curve = curves_.of_value(origin, line.id, glm::vec3(x));
                curves |= curve.has_value();
                return curve ? stored_number(*curve) : std::bit_cast<std::uint32_t>(x);
            }};
}

} // namespace restage::render
