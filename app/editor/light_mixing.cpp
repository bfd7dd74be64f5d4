// SPDX-License-Identifier: Apache-2.0
#include "light_mixing.hpp"

#include "document/session.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"

#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace restage::editor {

namespace {

constexpr double patience = 20; // for which the pictures are kept while the panel is not seen [s]
constexpr double most_pixels = 240e3; // of each layer: twelve of 100 bytes a pixel take 290 MB

glm::uvec2 layer_size(glm::uvec2 size) {
    const double pixels = double(size.x) * size.y;
    const double scale = std::min(1.0, std::sqrt(most_pixels / std::max(pixels, 1.0)));
    return glm::max(glm::uvec2(glm::dvec2(size) * scale + 0.5), glm::uvec2(1));
}

} // namespace

bool LightMixing::changed() const {
    return std::ranges::any_of(weights, [](const glm::vec3& w) { return w != glm::vec3(1); });
}

std::uint32_t LightMixing::samples() const {
    const auto pictures = mixer_.pictures();
    return pictures ? pictures->samples() : 0;
}

LightMixing::Of LightMixing::of(const SelectContext& e, glm::uvec2 size) {
    const scene::Scene& s = e.scene();
    return {.versions = {s.meshes.version(), s.images.version(), s.textures.version(), s.materials.version(),
                         s.media.version(), s.instances.version(), s.lights.version(), s.cameras.version(),
                         s.environment.version, s.active_camera.version, s.settings.version},
            .document = e.document(),
            .view = e.views.version(),
            .plugins = e.registry().version(),
            .size = layer_size(size),
            .filter = s.film.value.filter};
}

void LightMixing::restart(SelectContext& e) {
    std::vector<view::LightLayer> now = view::light_layers(e.scene(), e.registry(), most_layers);
    std::vector<glm::vec3> kept(now.size(), glm::vec3(1)); // weights of those that are still there
    for (std::size_t i = 0; i < now.size(); ++i)
        for (std::size_t k = 0; k < std::min(layers_.size(), weights.size()); ++k)
            if (layers_[k].lights.front() == now[i].lights.front()) kept[i] = weights[k];
    layers_ = std::move(now);
    weights = std::move(kept);
    applied_.assign(layers_.size(), glm::vec3(1));
    frame_.reset();
    mixed_ = {};
    spot.reset();
    shares_.clear();
    mixer_.stop();
    if (layers_.empty()) return;
    scene::Scene scene = e.scene();
    if (const auto id = scene.active_camera.value; e.views.now() && scene.cameras.find(id))
        scene.cameras.set(id, e.camera(), ++scene.clock);
    mixer_.start({e.registry(), e.log(), e.options().renderer},
                 {.scene = std::move(scene),
                  .layers = layers_,
                  .size = of_->size,
                  .samples = std::max(e.scene().settings.value.samples, 1u)});
}

void LightMixing::update(PanelUi& e, std::uint64_t document, bool denoise) {
    auto pictures = mixer_.pictures();
    if (!pictures || !pictures->complete() || pictures->layers.empty()) return;
    const view::LightBoard& board = e.panel_state->lights;
    std::vector<glm::vec3> total(layers_.size());
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        const bool shines =
            std::ranges::any_of(layers_[i].lights, [&](view::LightKey key) { return board.shines(key); });
        total[i] = shines ? applied_[i] * weights[i] : glm::vec3(0);
    }
    Mixed wanted{.pictures = std::move(pictures), .weights = std::move(total), .denoised = denoise, .spot = spot};
    if (frame_ && wanted == mixed_) return;
    mixed_ = std::move(wanted);
    shares_.clear();
    if (spot) {
        shares_ = view::light_at(*mixed_.pictures, mixed_.weights, *spot);
        const double sum = std::accumulate(shares_.begin(), shares_.end(), 0.0);
        for (double& share : shares_)
            share = sum > 0 ? share / sum : 0;
    }
    auto frame = std::make_shared<view::Frame>();
    frame->image = view::mix(*mixed_.pictures, mixed_.weights, denoise);
    frame->document = document;
    frame->denoised = denoise && std::ranges::none_of(mixed_.pictures->layers,
                                                      [](const auto& layer) { return layer->clean.empty(); });
    frame_ = std::move(frame);
    wake_(); // the picture is drawn before the panel
}

void LightMixing::follow(SelectContext& e, glm::uvec2 size, bool denoise) {
    if (!std::exchange(drawn_, false) || e.scene().instances.live() == 0) {
        frame_.reset();
        mixer_.pause(true);
        if (of_ && ImGui::GetTime() > drawn_at_ + patience) {
            of_.reset(); // rendered again then
            mixer_.stop();
        }
        return;
    }
    drawn_at_ = ImGui::GetTime();
    const Of now = of(e, size);
    const bool ours = std::exchange(applying_, false);
    if (of_ != now) {
        of_ = now;
        if (!ours) restart(e);
    }
    mixer_.pause(e.files().jobs.picture_paused());
    update(e, e.document(), denoise);
}

bool LightMixing::brighten(std::size_t layer, double factor) {
    const auto by = layer < shares_.size() ? view::brightening(shares_, layer, factor) : std::nullopt;
    if (by) weights[layer] *= float(std::max(*by, 1.0 / 64)); // as low as the fader goes
    return by.has_value();
}

void LightMixing::apply(SelectContext& e) {
    e.change([this, &e](document::Session& session) {
        auto changed = session.edit(view::weigh_lights(session.scene(), e.registry(), layers_, weights));
        if (!changed) return e.notices.add(LogLevel::error, changed.error().message);
        for (std::size_t i = 0; i < weights.size(); ++i)
            applied_[i] *= std::exchange(weights[i], glm::vec3(1));
        applying_ = true;
    });
}

PickTool spot_picker() {
    return {"Click the spot whose light to see", [](PanelContext& e, InstanceId, ImVec2 screen) {
                e.panel_state->mixing.spot = e.viewport.film_point(screen);
            }};
}

void LightMixing::forget() {
    mixer_.stop();
    spot.reset();
    shares_.clear();
    layers_.clear();
    weights.clear();
    of_.reset();
    frame_.reset();
    mixed_ = {};
}

} // namespace restage::editor
