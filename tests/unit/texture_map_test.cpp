// SPDX-License-Identifier: Apache-2.0
// The places of textures: maps of texture coordinates, box projection, places on surfaces.
#include "scene/texture_map.hpp"
#include "query/surface_site.hpp"
#include "scene/box_projection.hpp"
#include "scene/history.hpp"
#include "scene_room.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;

namespace {

bool close(const glm::dvec2& a, const glm::dvec2& b) { return glm::length(a - b) < 1e-6; }

glm::dmat2 turn(double degrees) {
    const double a = glm::radians(degrees);
    return {std::cos(a), std::sin(a), -std::sin(a), std::cos(a)};
}

struct Boards : test::Room { // two materials, both with a mix of an image and a grey
    Id<Texture> image, mix;
    Boards() {
        image = add(Texture{.name = "grain", .type = "imagemap"});
        Value of;
        of.type = ParamType::color;
        of.texture = image;
        Texture t{.name = "stained", .type = "mix"};
        t.params.set("tex1", of);
        mix = add(std::move(t));
        of.texture = mix;
        for (const Id<Material> id : {oak, steel})
            apply(scene, *set_param(scene, id, "reflectance", of));
    }
    Id<Texture> shown(Id<Instance> id) const {
        const auto top = scene.materials[scene.instances[id].material].params.texture("reflectance");
        return scene.textures[top].params.texture("tex1");
    }
};

// A cube from 0 to 2 without texture coordinates, with shared corners.
MeshData cube() {
    MeshData data;
    for (int i = 0; i < 8; ++i)
        data.positions.emplace_back(2 * (i & 1), 2 * (i >> 1 & 1), 2 * (i >> 2));
    data.triangles = {{0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 7, 3}, {2, 6, 7}, {0, 6, 2}, {0, 4, 6}, {1, 3, 7}, {1, 7, 5}};
    compute_bounds(data);
    return data;
}

} // namespace

TEST_CASE("a texture is moved, turned and stretched about a point of its surface", "[texture]") {
    TextureMap map;
    map.linear = {{2, 0.5}, {-0.25, 3}};
    map.shift = {0.1, -0.2};
    const glm::dvec2 at(0.3, 0.7), to(0.4, 0.2);
    CHECK(close(moved(map, at, to)(to), map(at)));
    CHECK(moved(map, at, to).linear == map.linear);
    const TextureMap turned = transformed(map, turn(30), at);
    CHECK(close(turned(at), map(at)));
    CHECK(close(turned(at + turn(30) * glm::dvec2(0.1, 0)), map(at + glm::dvec2(0.1, 0)))); // is seen there then
    const TextureMap larger = stretched(map, {2, 4}, at);
    CHECK(close(larger(at), map(at)));
    CHECK(close(larger.linear * to, map.linear * to / glm::dvec2(2, 4)));
    CHECK(turn_of({}) == 0);
    CHECK(turn_of(transformed({}, turn(30), at)) == Approx(30));
    map.linear = {{-20, 3}, {1, 5}}; // stretched and mirrored
    CHECK(turn_of(transformed(map, turn(30), at)) == Approx(turn_of(map) + 30));
}

TEST_CASE("the map of a texture is in its parameters, and undone", "[texture]") {
    Boards b;
    History history;
    const auto set = [&](const TextureMap& map) {
        const std::pair one(b.image, map);
        return set_texture_maps(b.scene, std::span(&one, 1), "Turn");
    };
    const Texture before = b.scene.textures[b.image];
    TextureMap map = transformed({}, turn(90), {0.5, 0.5});
    map.shift = {0.25, 0.5};
    const auto edit = set(map);
    REQUIRE(edit);
    apply(b.scene, *edit);
    const ParamSet& params = b.scene.textures[b.image].params;
    CHECK(params.number("ushear", 0) == Approx(1));
    CHECK(params.number("vshear", 0) == Approx(-1));
    CHECK(params.number("uscale", 1) == 0); // not the rounding error of a cosine
    const TextureMap read = texture_map(params);
    CHECK(close(read.shift, map.shift));
    apply(b.scene, *set({}));
    CHECK((b.scene.textures[b.image] == before)); // defaults are not stored
    map.shift = {1234.25, -777.5}; // a picture that repeats
    apply(b.scene, *set(map));
    CHECK(texture_map(b.scene.textures[b.image].params).shift.x == Approx(0.25));
    apply(b.scene, *set_param(b.scene, b.image, "wrap", Value::choice("clamp")));
    CHECK_FALSE(set(map));
    map.shift = {};
    map.linear *= 1e4;
    CHECK_FALSE(set(map));
}

TEST_CASE("an object gets textures of its own, with what leads to them", "[texture]") {
    Boards b;
    const Id<Texture> placed[] = {b.image};
    CHECK(users_of(b.scene, placed).objects == 3);
    CHECK(users_of(b.scene, placed).materials == 2);
    const auto own = own_textures(b.scene, std::span(&b.chair, 1), b.oak, placed);
    REQUIRE(own);
    Scene after = b.scene;
    apply(after, own->edit);
    std::swap(after, b.scene);
    CHECK(b.scene.instances[b.chair].material == own->material);
    CHECK(b.scene.instances[b.chair2].material == b.oak);
    CHECK(b.shown(b.chair) == own->copies.at(b.image));
    CHECK(b.shown(b.chair2) == b.image);
    CHECK(b.shown(b.lamp) == b.image);
    CHECK(b.scene.textures[b.shown(b.chair)].name != "grain");
    // Then nothing is shared any more.
    const Id<Texture> mine[] = {b.shown(b.chair)};
    CHECK(users_of(b.scene, mine).objects == 1);
    const auto again = own_textures(b.scene, std::span(&b.chair, 1), own->material, mine);
    REQUIRE(again);
    CHECK(again->edit.changes.empty());
    // A material of one object, whose texture another material has, too.
    const auto lamp = own_textures(b.scene, std::span(&b.lamp, 1), b.steel, placed);
    REQUIRE(lamp);
    apply(b.scene, lamp->edit);
    CHECK(lamp->material == b.steel);
    CHECK(b.shown(b.lamp) == lamp->copies.at(b.image));
    CHECK(b.shown(b.chair2) == b.image);
    CHECK_FALSE(own_textures(b.scene, std::span(&b.lamp, 1), b.oak, placed));
}

TEST_CASE("box projection gives each side its own coordinates, in lengths of the space", "[texture]") {
    const MeshData mesh = cube();
    const MeshData made = box_projected(mesh, glm::dmat4(1), 0.5, {0, 1, 0});
    CHECK(made.positions.size() == 24); // each corner belongs to three sides
    REQUIRE(made.triangles.size() == mesh.triangles.size());
    REQUIRE(made.uvs.size() == made.positions.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3 was = mesh.triangles[i], now = made.triangles[i];
        double area = 0;
        const glm::vec2 a = made.uvs[now[1]] - made.uvs[now[0]], b = made.uvs[now[2]] - made.uvs[now[0]];
        area = double(a.x * b.y - a.y * b.x) / 2;
        CHECK(area == Approx(2 / (0.5 * 0.5))); // right way round seen from outside, and not distorted
        for (int k = 0; k < 3; ++k)
            CHECK((made.positions[now[k]] == mesh.positions[was[k]]));
    }
    // On the sides v is up.
    for (const std::size_t i : {0, 1, 2, 3, 8, 9, 10, 11})
        for (int k = 0; k < 3; ++k)
            CHECK(made.uvs[made.triangles[i][k]].y == Approx(made.positions[made.triangles[i][k]].y / 0.5f));
}

TEST_CASE("projected objects keep others' meshes, and share what is equal", "[texture]") {
    test::Room room;
    const auto mesh = room.add(Mesh{
        .name = "cube", .data = std::make_shared<const MeshData>(cube()), .source_file = "/cube.ply", .origin = {}});
    const auto box = [&](const char* name, const glm::dmat4& m) {
        return room.add(Instance{.name = name, .mesh = mesh, .object_to_world = m});
    };
    const glm::dmat4 far = glm::translate(glm::dmat4(1), {5, 0, 0});
    const auto a = box("a", glm::dmat4(1)), b = box("b", far), c = box("c", glm::scale(far, {3, 1, 1})),
               other = box("other", far);
    const Id<Instance> all[] = {a, b, c};
    const auto edit = project_box(room.scene, all, {.size = 1});
    REQUIRE(edit);
    Scene s = room.scene;
    apply(s, *edit);
    CHECK(s.instances[a].mesh == s.instances[b].mesh);
    CHECK(s.instances[c].mesh != s.instances[b].mesh); // other lengths
    CHECK(s.instances[other].mesh == mesh);
    CHECK(s.meshes[mesh].data->uvs.empty());
    CHECK(s.meshes[s.instances[a].mesh].source_file.empty()); // an exporter would write that file's coordinates
    apply(s, inverse(*edit));
    CHECK(s.instances[a].mesh == mesh);
    const auto world = project_box(room.scene, std::span(all, 2), {.size = 1, .world_axes = true});
    REQUIRE(world);
    s = room.scene;
    apply(s, *world);
    CHECK(s.instances[a].mesh != s.instances[b].mesh); // other places
    CHECK_FALSE(project_box(room.scene, all, {.size = 0}));
    const auto ball =
        room.add(Mesh{.name = "ball", .data = test::triangle(), .primitive = "sphere \"float radius\" 1"});
    const auto sphere = room.add(Instance{.name = "sphere", .mesh = ball});
    CHECK_FALSE(project_box(room.scene, std::span(&sphere, 1), {}));
    CHECK_FALSE(has_uv(room.scene.meshes[mesh]));
    CHECK(has_uv(room.scene.meshes[ball]));
    apply(room.scene, *set_material(room.scene, std::span(all, 2), room.oak));
    CHECK(without_uv(room.scene, room.oak) == std::vector{room.chair, room.chair2, a, b});
}

TEST_CASE("a place on a surface has its coordinates and their directions in the world", "[texture]") {
    test::Room room;
    const auto projected = room.add(Mesh{
        .name = "cube", .data = std::make_shared<const MeshData>(box_projected(cube(), glm::dmat4(1), 4, {0, 1, 0}))});
    const auto box =
        room.add(Instance{.name = "box",
                          .mesh = projected,
                          .object_to_world = glm::scale(glm::translate(glm::dmat4(1), {10, 0, 0}), glm::dvec3(3))});
    const auto place = query::place_on(room.scene, box, {11.5, 1.5, 20}, {0, 0, -2});
    REQUIRE(place);
    const auto site = query::site_at(room.scene, *place, 0);
    REQUIRE(site);
    CHECK(glm::length(site->position - glm::dvec3(11.5, 1.5, 6)) < 1e-6);
    CHECK(close(site->uv, {0.5 / 4, 0.5 / 4}));
    CHECK(glm::length(site->dpdu - glm::dvec3(12, 0, 0)) < 1e-5);
    CHECK(glm::length(site->dpdv - glm::dvec3(0, 12, 0)) < 1e-5);
    CHECK(glm::length(site->normal - glm::dvec3(0, 0, 1)) < 1e-6);
    CHECK_FALSE(query::place_on(room.scene, box, {0, 1.5, 20}, {0, 0, -2}));
    // A mesh without coordinates has places, but no sites.
    const auto bare = room.add(Mesh{.name = "bare", .data = std::make_shared<const MeshData>(cube())});
    const auto other = room.add(Instance{.name = "other", .mesh = bare});
    const auto there = query::place_on(room.scene, other, {0.5, 0.5, 20}, {0, 0, -1});
    REQUIRE(there);
    CHECK_FALSE(query::site_at(room.scene, *there, 0));
}
