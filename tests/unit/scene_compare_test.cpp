// SPDX-License-Identifier: Apache-2.0
// Comparing scenes: any changed value or mesh is a difference.
#include "io/scene_compare.hpp"

#include "base/log.hpp"
#include "scene/bounds.hpp"

#include <catch2/catch_test_macros.hpp>
#include <memory>

using namespace restage;
using namespace restage::scene;

namespace {

// One triangle of a material without a plugin, with this parameter.
Scene with_value(const Value& value) {
    Scene s;
    auto data = std::make_shared<MeshData>();
    data->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data->triangles = {{0, 1, 2}};
    compute_bounds(*data);
    s.meshes.set({1}, Mesh{.name = "mesh", .data = data}, 1);
    Material material{.name = "material", .type = "nobody's"};
    material.params.set("value", value);
    s.materials.set({1}, std::move(material), 1);
    s.instances.set({1}, Instance{.name = "it", .mesh = {1}, .material = {1}}, 1);
    return s;
}

} // namespace

TEST_CASE("compare: a different value of any type is a difference", "[compare]") {
    Log log;
    const plugin::Registry registry(log);
    const std::pair<Value, Value> pairs[] = {
        {Value::number(0.25f), Value::number(0.5f)},
        {Value::color(1, 0, 0), Value::color(1, 0, 0.5f)},
        {Value::integer(3), Value::integer(4)},
        {Value::integer(16777216), Value::integer(16777217)},
        {Value::boolean(false), Value::boolean(true)},
        {Value::choice("ggx"), Value::choice("beckmann")},
        {Value::table("/a/x.binary"), Value::table("/a/y.binary")},
    };
    for (const auto& [a, b] : pairs) {
        INFO("type " << int(a.type));
        CHECK(io::structurally_equal(with_value(a), with_value(a), registry));
        CHECK_FALSE(io::structurally_equal(with_value(a), with_value(b), registry));
    }
}

TEST_CASE("compare: each array of a mesh counts", "[compare]") {
    Log log;
    const plugin::Registry registry(log);
    const auto changed = [](auto change) {
        Scene s = with_value(Value::number(1));
        auto data = std::make_shared<MeshData>(*s.meshes[{1}].data);
        change(*data);
        s.meshes.set({1}, Mesh{.name = "mesh", .data = data}, 2);
        return s;
    };
    const Scene plain = with_value(Value::number(1));
    CHECK(io::structurally_equal(plain, changed([](MeshData&) {}), registry));
    CHECK_FALSE(io::structurally_equal(plain, changed([](MeshData& d) { d.positions[1].x = 2; }), registry));
    CHECK_FALSE(io::structurally_equal(plain, changed([](MeshData& d) { d.normals.assign(3, {0, 0, 1}); }), registry));
    CHECK_FALSE(io::structurally_equal(plain, changed([](MeshData& d) { d.uvs.assign(3, {0, 1}); }), registry));
    CHECK_FALSE(io::structurally_equal(plain, changed([](MeshData& d) { d.uvs2.assign(3, {0, 1}); }), registry));
    CHECK_FALSE(
        io::structurally_equal(plain, changed([](MeshData& d) { d.tangents.assign(3, {1, 0, 0, 1}); }), registry));
}
