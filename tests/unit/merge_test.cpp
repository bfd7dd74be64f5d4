// SPDX-License-Identifier: Apache-2.0
// A file inserted into an open scene: new ids for everything, one undo step, without its camera and light.
#include "document/session.hpp"
#include "model_files.hpp"
#include "scene/validate.hpp"

#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::tests;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Room : ModelFiles {
    document::Session session{registry};
    Room() {
        write("room.pbrt",
              "LookAt 0 1 -5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n"
              "LightSource \"infinite\"\nMakeNamedMaterial \"red\" \"string type\" \"diffuse\"\n"
              "NamedMaterial \"red\"\nShape \"sphere\"\n");
        write("pair.mtl", "newmtl red\nKd 1 1 1\nmap_Kd gone.png\nnewmtl blue\nKd 0 0 1\n");
        write(
            "pair.obj",
            "mtllib pair.mtl\nv 0 0 1\nv 1 0 1\nv 0 1 1\no left\nusemtl red\nf 1 2 3\no right\nusemtl blue\nf 1 2 3\n");
        write("one.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
        const auto opened = session.open(path("room.pbrt"));
        if (!opened) FAIL(opened.error().message);
    }
    scene::Merged insert(const char* name) {
        auto merged = session.insert_file(path(name));
        if (!merged) FAIL(merged.error().message);
        return std::move(*merged);
    }
    bool sound() const {
        for (const auto& problem : scene::validate(session.scene()))
            if (problem.severity == scene::Problem::Severity::error) {
                UNSCOPED_INFO(problem.sentence);
                return false;
            }
        return true;
    }
};

} // namespace

TEST_CASE("insert: objects come with their dependencies and nothing else", "[merge]") {
    Room room;
    const scene::Scene& scene = room.session.scene();
    const auto before = scene;
    const auto merged = room.insert("pair.obj");
    CHECK(room.sound());
    REQUIRE(merged.instances.size() == 2);
    CHECK(scene.instances.live() == before.instances.live() + 2);
    CHECK(scene.meshes.live() == before.meshes.live() + 2);
    CHECK(scene.materials.live() == before.materials.live() + 2);
    CHECK(scene.images.live() == before.images.live() + 1); // its texture, not its studio
    CHECK(scene.cameras.live() == before.cameras.live());
    CHECK(scene.environment.value == before.environment.value);
    CHECK(scene.film.value == before.film.value);
    const auto& left = scene.instances[merged.instances[0]];
    CHECK(left.name == "left");
    CHECK(left.group == merged.group);
    CHECK(scene.groups[merged.group].name == "pair");
    const auto& material = scene.materials[left.material];
    CHECK(material.name == "red 2"); // the room has a red already
    const scene::Value* color = material.params.find("reflectance");
    REQUIRE(color);
    const scene::Texture* texture = scene.textures.find(color->texture);
    REQUIRE(texture);
    REQUIRE(scene.images.find(texture->image));
    CHECK_THAT(scene.images[texture->image].path, ContainsSubstring("gone.png"));
    bool told = false;
    for (const auto& entry : room.session.report().entries)
        told = told || to_string(entry).find("gone.png") != std::string::npos;
    CHECK(told);
}

TEST_CASE("insert: one step that undo removes completely and redo restores", "[merge]") {
    Room room;
    const auto live = [&] { return room.session.scene().instances.live(); };
    const auto merged = room.insert("pair.obj");
    CHECK(room.session.modified());
    REQUIRE(room.session.undo());
    CHECK(live() == 1);
    CHECK(room.session.scene().materials.live() == 1);
    CHECK_FALSE(room.session.modified());
    REQUIRE(room.session.redo());
    CHECK(live() == 3);
    CHECK(room.session.scene().instances.find(merged.instances[1]));
    const auto again = room.insert("pair.obj"); // the same file twice
    CHECK(live() == 5);
    CHECK(room.session.scene().groups[again.group].name == "pair 2");
    CHECK(room.sound());
}

TEST_CASE("insert: a single object needs no group", "[merge]") {
    Room room;
    const auto merged = room.insert("one.obj");
    REQUIRE(merged.instances.size() == 1);
    CHECK_FALSE(merged.group);
    CHECK_FALSE(room.session.scene().instances[merged.instances[0]].group);
}

TEST_CASE("insert: a right-handed model is not mirrored in a left-handed scene", "[merge]") {
    Room room; // pbrt's own frame is left-handed, OBJ's right-handed
    const auto merged = room.insert("one.obj");
    const auto& m = room.session.scene().instances[merged.instances[0]].object_to_world;
    CHECK(glm::determinant(glm::dmat3(m)) == -1);
    CHECK(m[1][1] == 1); // up stays up
}

TEST_CASE("insert: the up axes are aligned", "[merge]") {
    scene::Scene into, from;
    const auto look = [](scene::Scene& s, glm::dvec3 forward, glm::dvec3 up) {
        scene::Camera camera;
        camera.camera_to_world[0] = glm::dvec4(glm::cross(forward, up), 0);
        camera.camera_to_world[1] = glm::dvec4(up, 0);
        camera.camera_to_world[2] = glm::dvec4(forward, 0);
        s.cameras.set(s.cameras.next(), camera, 1);
        s.active_camera = {{1}, 1};
    };
    look(into, {0, 1, 0}, {0, 0, 1}); // both right-handed
    look(from, {0, 0, -1}, {0, 1, 0});
    const glm::dmat4 m = scene::frame_change(into, from);
    CHECK(glm::dvec3(m * glm::dvec4(0, 1, 0, 0)) == glm::dvec3(0, 0, 1));
    CHECK(glm::determinant(glm::dmat3(m)) == Catch::Approx(1));
    const glm::dmat4 back = scene::frame_change(from, into);
    CHECK(back * m == glm::dmat4(1));
    scene::Scene down;
    look(down, {0, 0, -1}, {0, -1, 0});
    const glm::dmat4 over = scene::frame_change(down, from);
    CHECK(glm::dvec3(over * glm::dvec4(0, 1, 0, 0)) == glm::dvec3(0, -1, 0));
    CHECK(glm::determinant(glm::dmat3(over)) == Catch::Approx(1));
}

TEST_CASE("insert: a file that cannot be read changes nothing", "[merge]") {
    Room room;
    const auto version = room.session.version();
    const auto merged = room.session.insert_file(room.path("absent.obj"));
    REQUIRE_FALSE(merged);
    CHECK_THAT(merged.error().message, ContainsSubstring("absent.obj"));
    CHECK(room.session.version() == version);
}
