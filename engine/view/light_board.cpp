// SPDX-License-Identifier: Apache-2.0
#include "view/light_board.hpp"

#include "io/material_emission.hpp"
#include "scene/tables.hpp"

#include <tuple>
#include <type_traits>
#include <utility>

namespace restage::view {

using namespace scene;

namespace {

constexpr std::size_t kind_count = std::tuple_size_v<decltype(kinds)>;
static_assert(kind_count + std::tuple_size_v<decltype(singles)> == 13);

void put(std::set<LightKey>& set, LightKey key, bool in) {
    if (in)
        set.insert(key);
    else
        set.erase(key);
}

} // namespace

void LightBoard::mute(LightKey key, bool on) {
    put(muted_, key, on);
    ++version_;
}

void LightBoard::solo(LightKey key, bool on) {
    put(solo_, key, on);
    ++version_;
}

void LightBoard::clear() {
    muted_.clear();
    solo_.clear();
    ++version_;
}

void LightBoard::forget() {
    clear();
    copy_.reset();
    off_.clear();
}

bool LightBoard::take_changes(const Scene& now) {
    bool lights = false;
    std::size_t i = 0;
    each_kind([&]<class T>(const Kind<T>& kind) {
        const Table<T>& theirs = now.*kind.table;
        Version& seen = seen_[i++];
        if (theirs.version() == seen) return;
        theirs.each_changed(seen, [&](Id<T> id, const T* item) {
            (*copy_.*kind.table).set(id, item ? std::optional(*item) : std::nullopt, ++copy_->clock);
            if constexpr (std::is_same_v<T, Light> || std::is_same_v<T, Instance>) off_.erase(key_of(id));
        });
        seen = theirs.version();
        lights = lights || std::is_same_v<T, Light> || std::is_same_v<T, Instance> || std::is_same_v<T, Material>;
    });
    each_single([&](const auto& single) {
        const auto& theirs = now.*single.one;
        Version& seen = seen_[i++];
        if (theirs.version == seen) return;
        *copy_.*single.one = {theirs.value, ++copy_->clock};
        seen = theirs.version;
        if (&theirs == static_cast<const void*>(&now.environment)) {
            off_.erase(sky_key);
            lights = true;
        }
    });
    return lights;
}

template <class T, class F>
void LightBoard::switch_one(Id<T> id, const T& item, F&& off) {
    const LightKey key = key_of(id);
    const bool wanted = !shines(key);
    if (wanted == off_.contains(key)) return;
    put(off_, key, wanted);
    T other = item;
    if (wanted) off(other);
    table<T>(*copy_).set(id, std::move(other), ++copy_->clock);
}

const Scene& LightBoard::follow(const Scene& now, const plugin::Registry& registry) {
    if (!copy_ && !any()) return now; // NOLINT(bugprone-return-const-ref-from-parameter): valid as long as it is
    bool look = !copy_ || followed_ != version_;
    if (!copy_) {
        copy_ = now;
        std::size_t i = 0;
        each_table(now, [&](const auto& table) { seen_[i++] = table.version(); });
        each_single([&](const auto& single) { seen_[i++] = (now.*single.one).version; });
    }
    look = take_changes(now) || look;
    if (!look) return *copy_;
    followed_ = version_;
    now.lights.each(
        [&](Id<Light> id, const Light& light) { switch_one(id, light, [](Light& off) { off.hidden = true; }); });
    const io::MaterialEmissions emissions(registry, now);
    now.instances.each([&](Id<Instance> id, const Instance& instance) {
        if (!emissions.shines(instance)) return;
        switch_one(id, instance, [](Instance& off) {
            if (!off.emission) off.emission.emplace(); // instead of its material's
            off.emission->radiance = glm::vec3(0);
        });
    });
    const bool dark = !shines(sky_key);
    if (now.environment.value && dark != off_.contains(sky_key)) {
        put(off_, sky_key, dark);
        copy_->environment = {now.environment.value, ++copy_->clock};
        if (dark) copy_->environment.value->scale = glm::vec3(0);
    }
    return *copy_;
}

} // namespace restage::view
