// SPDX-License-Identifier: Apache-2.0
#include "render/wave_kernels.hpp"

#include "base/file.hpp"
#include "render/material_composer.hpp"
#include "render/texture_composer.hpp"
#include "shared/wave_data.h"

#include <algorithm>
#include <utility>

namespace restage::render {
namespace {

// But for techniques and spectra, which need data of their own, and borders, which the CPU's side handles.
SceneFeatures all_features(SceneFeatures f) {
    f.environment = f.lens = f.media = f.filter_table = f.emission_textures = f.light_alpha = f.glow = f.quadrics =
        true;
    f.lights = LIGHTS_MESHES | LIGHTS_SURFACES | LIGHTS_LAMPS;
    if (f.light_roots > 0) f.light_roots = std::max(f.light_roots, 8u); // the root's children are padded to so many
    return f;
}

} // namespace

Result<void> WaveKernels::select(const GpuScene& scene, KernelUse use) {
    const bool other_colors = features_.spectral != scene.features().spectral; // and other words of values
    const bool other_scene = std::exchange(scene_, &scene) != &scene; // with other numbers of texture types
    features_ = scene.features();
    if (c_.all_features) features_ = all_features(features_);
    features_.guiding = use.guiding;
    features_.caustics &= use.photons;
    auto before = std::exchange(types_, scene.types());
    texture_types_ = scene.texture_types();
    stand_in_type_ = scene.materials()[0].type;
    if (types_.size() > emit) return fail("a scene may use at most 253 material types");
    slots_.resize(types_.size());
    before.resize(types_.size());
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        // Another type, or a plugin reloaded with a different table
        if (other_colors || other_scene || slots_[i].what != types_[i].type ||
            word_layout(before[i].plugin.table) != word_layout(types_[i].plugin.table))
            slots_[i] = {.what = types_[i].type};
        slots_[i].settled = slots_[i].shown = false;
        slots_[i].wanted = nullptr;
    }
    for (Slot* slot : {&generate_, &emit_, &escape_, &accumulate_, &stand_in_, &decide_, &photons_}) {
        slot->settled = false;
        slot->wanted = nullptr;
    }
    for (Slot* slot : {&generate_, &accumulate_})
        RESTAGE_CHECK(ask(*slot));
    return {};
}

Result<gpu::ComputeRequest> WaveKernels::request(const Slot& slot) const {
    gpu::ComputeRequest r{.push_constant_bytes = sizeof(shared::WavePush), .name = slot.what};
    const MaterialType* type = nullptr;
    if (&slot == &stand_in_) {
        r.shader = compose_stand_in(types_[stand_in_type_], "wave_shade.glsl", gpu::ShaderStage::compute,
                                    color_mode(features_));
    } else if (&slot >= slots_.data() && &slot < slots_.data() + slots_.size()) {
        type = &types_[std::size_t(&slot - slots_.data())];
        r.shader = compose_material(*type, "wave_shade.glsl", gpu::ShaderStage::compute, color_mode(features_),
                                    evaluates_textures(features_, *type) ? texture_types_ : TextureTypes());
        r.blame = type->plugin.blame;
    } else {
        const auto path = c_.shader_dir / slot.what;
        RESTAGE_TRY(auto text, read_file(path));
        r.shader = {.name = path.string(), .text = std::move(text)};
        set_color_mode(color_mode(features_), r.shader);
    }
    r.constants = spec_constants(features_, true, c_.strategy, type);
    if (type && c_.all_features) // textures, bump, tangents
        for (gpu::SpecConstant& c : r.constants)
            if (c.id == 1 || c.id == 2 || c.id == 7) c.value = 1;
    if (&slot == &decide_) r.push_constant_bytes = sizeof(shared::DecidePush);
    if (&slot == &decide_ ||
        ((&slot == &emit_ || &slot == &photons_) && (features_.emission_textures || features_.light_alpha)))
        insert_textures(texture_types_, r.shader);
    return r;
}

Result<void> WaveKernels::ask(Slot& slot) {
    if (slot.settled) return {};
    if (slot.wanted && !slot.wanted->cancelled()) {
        store_.keep(slot.wanted);
    } else {
        RESTAGE_TRY(auto made, request(slot));
        slot.wanted = store_.want(slot.what, std::move(made));
    }
    return {};
}

void WaveKernels::arrive(Slot& slot) {
    slot.now = slot.wanted->pipeline;
    slot.wanted = nullptr;
    slot.settled = true;
    slot.shown = false;
}

Result<bool> WaveKernels::wait(Slot& slot, const std::function<bool()>& keep_going) {
    if (slot.settled) return true;
    RESTAGE_TRY(const bool built, store_.wait(slot.wanted, keep_going));
    if (built) arrive(slot);
    return built;
}

Result<bool> WaveKernels::begin(const std::function<bool()>& keep_going) {
    for (Slot* slot : {&generate_, &accumulate_}) {
        RESTAGE_CHECK(ask(*slot));
        RESTAGE_TRY(const bool built, wait(*slot, keep_going));
        if (!built) return false;
    }
    return true;
}

Result<bool> WaveKernels::need_decide(const std::function<bool()>& keep_going) {
    RESTAGE_CHECK(ask(decide_));
    return wait(decide_, keep_going);
}

Result<bool> WaveKernels::need_photons(const std::function<bool()>& keep_going) {
    RESTAGE_CHECK(ask(photons_));
    return wait(photons_, keep_going);
}

Result<bool> WaveKernels::need(std::span<const std::uint32_t> hits, const std::function<bool()>& keep_going) {
    const auto slot_of = [&](std::size_t t) { return t == escape ? &escape_ : t == emit ? &emit_ : &slots_[t]; };
    bool stand_in = false;
    for (std::size_t t = 0; t < hits.size(); ++t) {
        if (!hits[t] || slot_of(t)->settled) continue;
        Slot& slot = *slot_of(t);
        RESTAGE_CHECK(ask(slot)); // request all that is missing, before waiting for the first
        if (!c_.stand_ins || slot.shown) continue;
        if (slot.wanted->pipeline)
            arrive(slot); // already built: no stand-in was shown
        else if (t < emit)
            slot.shown = true;
    }
    for (std::size_t t = 0; t < hits.size(); ++t) {
        if (!hits[t] || slot_of(t)->settled) continue;
        if (c_.stand_ins && t < emit) {
            stand_in |= !slot_of(t)->now;
            continue;
        }
        RESTAGE_TRY(const bool built, wait(*slot_of(t), keep_going));
        if (!built) return false;
    }
    if (!stand_in) return true;
    RESTAGE_CHECK(ask(stand_in_));
    return wait(stand_in_, keep_going);
}

const gpu::ComputePipeline& WaveKernels::shade(std::size_t type) const {
    if (type >= emit) return type == emit ? *emit_.now : *escape_.now;
    return slots_[type].now ? *slots_[type].now : *stand_in_.now;
}

// Once nothing else is built: so that the next new type need not wait for it.
void WaveKernels::prepare_stand_in() {
    if (!c_.stand_ins || stand_in_.settled || !generate_.settled) return;
    if (!stand_in_.wanted && store_.compiling()) return;
    if (!ask(stand_in_)) return; // reported when it is needed
    if (stand_in_.wanted->pipeline) arrive(stand_in_);
}

bool WaveKernels::adopt() {
    for (const Slot& slot : slots_) // still wanted while its stand-in is visible, even if the last sample missed it
        if (slot.shown && slot.wanted && !slot.wanted->cancelled()) store_.keep(slot.wanted);
    prepare_stand_in();
    store_.settle();
    bool different = false;
    for (Slot& slot : slots_) {
        if (slot.settled || !slot.wanted) continue;
        store_.poll(slot.wanted);
        if (slot.wanted->building()) continue;
        if (slot.wanted->pipeline) {
            different |= slot.shown;
            arrive(slot);
        } else {
            if (slot.shown && !slot.wanted->cancelled()) { // the current look stays until something changes
                c_.log.error(slot.wanted->error);
                slot.settled = true;
            }
            slot.wanted = nullptr;
        }
    }
    return different;
}

std::optional<CompileProgress> WaveKernels::compiling() const {
    auto progress = store_.compiling(stand_in_.wanted.get());
    // First named is a type seen as its stand-in, also if it was built since adopt(): others keep their old code.
    const auto seen = std::ranges::find_if(slots_, [](const Slot& s) { return s.shown && s.wanted && !s.now; });
    const auto any = std::ranges::find_if(slots_, [](const Slot& s) { return s.shown && s.wanted; });
    if (seen != slots_.end()) {
        if (!progress) progress = CompileProgress{.left = 1};
        progress->what = seen->what;
    } else if (!progress && any != slots_.end()) {
        progress = CompileProgress{.what = any->what, .left = 1};
    }
    return progress;
}

void WaveKernels::film_emptied() {
    for (Slot& slot : slots_)
        slot.shown = false;
}

std::size_t WaveKernels::shader_bytes() const {
    std::size_t sum = 0;
    for (const Slot* slot : {&generate_, &emit_, &escape_, &accumulate_, &stand_in_, &decide_, &photons_})
        if (slot->now) sum += slot->now->shader_bytes();
    for (const Slot& slot : slots_)
        if (slot.now) sum += slot.now->shader_bytes();
    return sum;
}

} // namespace restage::render
