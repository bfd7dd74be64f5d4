// SPDX-License-Identifier: Apache-2.0
// Mute and solo: which lights shine in the live picture, and how a renderer can follow it item by item.
#include "view/light_board.hpp"

#include "base/log.hpp"
#include "plugin/registry.hpp"
#include "scene/edits_light.hpp"
#include "scene_room.hpp"

#include <array>
#include <catch2/catch_test_macros.hpp>

using namespace restage;
using namespace restage::scene;
using view::key_of;
using view::LightBoard;
using view::sky_key;

namespace {

struct Lit : test::Room {
    Id<Light> spot, sun;
    Log log;
    plugin::Registry registry{log};
    LightBoard board;
    Lit() {
        spot = add(Light{.name = "spot", .kind = LightKind::spot});
        sun = add(Light{.name = "sun", .kind = LightKind::distant, .hidden = true});
        scene::apply(scene, *set_emission(scene, lamp, Emission{.radiance = glm::vec3(5)}));
        scene::apply(scene, set_environment(scene, Environment{.name = "sky", .scale = glm::vec3(2)}));
    }
    const Scene& seen() { return board.follow(scene, registry); }
    void edit(Edit e) { scene::apply(scene, e); }
    // spot, lamp, sky
    std::array<bool, 3> shining() {
        const Scene& s = seen();
        const auto& emission = s.instances[lamp].emission;
        return {!s.lights[spot].hidden, emission && emission->radiance.x > 0, s.environment.value->scale.x > 0};
    }
};
using Three = std::array<bool, 3>;

} // namespace

TEST_CASE("light board: until something is muted the scene itself is shown") {
    Lit r;
    CHECK(&r.seen() == &r.scene);
    CHECK(r.shining() == Three{true, true, true});
    CHECK_FALSE(r.board.any());
}

TEST_CASE("light board: muted lights are off, soloed ones the only ones that are on") {
    Lit r;
    const Version before = r.scene.clock;
    r.board.mute(key_of(r.spot), true);
    CHECK(r.shining() == Three{false, true, true});
    r.board.mute(sky_key, true);
    CHECK(r.shining() == Three{false, true, false});
    r.board.solo(sky_key, true); // although it is muted
    CHECK(r.shining() == Three{false, false, true});
    r.board.solo(key_of(r.lamp), true);
    CHECK(r.shining() == Three{false, true, true});
    CHECK(r.seen().lights[r.sun].hidden); // as in the document
    r.board.clear();
    CHECK(r.shining() == Three{true, true, true});
    CHECK(r.seen().lights[r.sun].hidden);
    CHECK(r.seen().environment.value->scale == glm::vec3(2));
    CHECK(r.seen().instances[r.lamp].emission->radiance == glm::vec3(5));
    CHECK(r.scene.clock == before); // the document is unchanged
}

TEST_CASE("light board: edits of the document are followed, with rising versions") {
    Lit r;
    r.board.solo(key_of(r.lamp), true);
    Scene previous = r.seen();
    // Everything that differs from the previous one has a version above that table's.
    const auto follows = [&] {
        const Scene& now = r.seen();
        const Version lights = previous.lights.version(), objects = previous.instances.version();
        now.lights.each([&](Id<Light> id, const Light& light) {
            const Light* was = previous.lights.find(id);
            if (!was || !(*was == light)) CHECK(now.lights.version(id) > lights);
        });
        now.instances.each([&](Id<Instance> id, const Instance& instance) {
            const Instance* was = previous.instances.find(id);
            if (!was || !(*was == instance)) CHECK(now.instances.version(id) > objects);
        });
        if (now.environment.value != previous.environment.value)
            CHECK(now.environment.version > previous.environment.version);
        previous = now;
    };
    Light brighter = r.scene.lights[r.spot];
    brighter.value = glm::vec3(9);
    r.edit(Edit{"brighter", {Change<Light>{r.spot, r.scene.lights[r.spot], brighter}}});
    follows();
    CHECK(r.seen().lights[r.spot].value == glm::vec3(9));
    CHECK(r.shining() == Three{false, true, false});
    const auto more = r.add(Light{.name = "more"});
    follows();
    CHECK(r.seen().lights[more].hidden);
    r.board.solo(key_of(more), true);
    follows();
    CHECK_FALSE(r.seen().lights[more].hidden);
    r.edit(*set_emission(r.scene, r.chair, Emission{.radiance = glm::vec3(1)}));
    follows();
    CHECK(r.seen().instances[r.chair].emission->radiance == glm::vec3(0));
    r.edit(*scene::remove(r.scene, r.spot));
    follows();
    CHECK_FALSE(r.seen().lights.find(r.spot));
    r.edit(set_environment(r.scene, std::nullopt));
    follows();
    CHECK_FALSE(r.seen().environment.value);
    r.board.clear();
    follows();
    CHECK(r.seen().instances[r.chair].emission->radiance == glm::vec3(1));
    r.board.forget();
    CHECK(&r.seen() == &r.scene);
}
