// SPDX-License-Identifier: Apache-2.0
// LightBoard: which lights shine in a live picture, as on a lighting console: some are muted, or only some are soloed.
// It changes no document.
#pragma once

#include "scene/scene.hpp"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <set>

namespace restage::plugin {
class Registry;
}

namespace restage::view {

struct LightKey {
    enum class Kind { light, object, sky } kind = Kind::sky;
    std::uint32_t id = 0; // of Id<Light> or Id<Instance>; 0: the sky
    auto operator<=>(const LightKey&) const = default;
};
inline LightKey key_of(scene::Id<scene::Light> id) { return {LightKey::Kind::light, id.value}; }
inline LightKey key_of(scene::Id<scene::Instance> id) { return {LightKey::Kind::object, id.value}; }
inline constexpr LightKey sky_key{};

class LightBoard {
  public:
    void mute(LightKey, bool on);
    void solo(LightKey, bool on);
    void clear();  // everything shines again
    void forget(); // the next scene is that of another document
    bool muted(LightKey key) const { return muted_.contains(key); }
    bool soloed(LightKey key) const { return solo_.contains(key); }
    bool any() const { return !muted_.empty() || !solo_.empty(); }
    // While some are soloed only these shine, muted or not.
    bool shines(LightKey key) const { return solo_.empty() ? !muted_.contains(key) : solo_.contains(key); }
    std::uint64_t version() const { return version_; } // of these choices

    // `scene` with the others switched off; itself until something is muted or soloed. Its versions are such that
    // who followed the scene can follow this from then on, item by item. Valid until the next call. [main]
    const scene::Scene& follow(const scene::Scene& scene, const plugin::Registry& registry);

  private:
    bool take_changes(const scene::Scene& scene); // whether some may concern lights
    template <class T, class F>
    void switch_one(scene::Id<T> id, const T& item, F&& off);

    std::set<LightKey> muted_, solo_;
    std::uint64_t version_ = 0, followed_ = 0;
    std::optional<scene::Scene> copy_;
    std::set<LightKey> off_; // in the copy
    std::array<scene::Version, 13> seen_{}; // of the scene's tables and single items, in the order of scene/tables.hpp
};

} // namespace restage::view
