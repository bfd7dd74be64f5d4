// SPDX-License-Identifier: Apache-2.0
// The scene changed by the project tests, in its own folder, and exact comparison of scenes.
#pragma once

#include "base/file.hpp"
#include "document/project.hpp"
#include "document/project_fields.hpp"
#include "document/session.hpp"
#include "io/image_file.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "scene/bounds.hpp"
#include "temporary_folder.hpp"

#include <catch2/catch_test_macros.hpp>
#include <filesystem>

namespace restage::test {

namespace fs = std::filesystem;
using namespace restage::scene;

inline constexpr const char* room = R"(
LookAt 0 2 -6  0 1 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.45 0.5 ]
Texture "checks" "spectrum" "checkerboard" "rgb tex1" [ 0.1 0.1 0.1 ] "rgb tex2" [ 0.8 0.8 0.8 ]
Texture "wood" "spectrum" "imagemap" "string filename" "wood.png"
MakeNamedMaterial "floor" "string type" "diffuse" "texture reflectance" "checks"
MakeNamedMaterial "oak" "string type" "diffuse" "texture reflectance" "wood"
MakeNamedMaterial "steel" "string type" "conductor" "float roughness" 0.3
AttributeBegin
  NamedMaterial "floor"
  Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -5 0 -5  5 0 -5  5 0 5  -5 0 5 ]
AttributeEnd
ObjectBegin "chair"
  NamedMaterial "oak"
  Shape "sphere" "float radius" 0.5
  NamedMaterial "steel"
  Shape "disk" "float radius" 0.7
ObjectEnd
AttributeBegin
  Translate 1 0.5 0
  ObjectInstance "chair"
AttributeEnd
AttributeBegin
  Translate -1 0.5 0
  ObjectInstance "chair"
AttributeEnd
AttributeBegin
  Translate 0 3 0
  AreaLightSource "diffuse" "rgb L" [ 10 10 10 ]
  # name: Lamp
  Shape "disk" "float radius" 0.4
AttributeEnd
LightSource "point" "rgb I" [ 3 3 3 ] "point3 from" [ 2 3 -2 ]
)";

struct Fixture {
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    TemporaryFolder own;
    const fs::path& folder = own.path();
    Fixture() {
        registry.scan(
            std::vector<plugin::SearchPath>{{restage::test::build_dir() / "lib" / "restage" / "plugins", true}});
        fs::create_directories(folder / "scenes");
        PixelData wood{.width = 4, .height = 2, .channels = 3, .values = std::vector<float>(24, 0.25f)};
        REQUIRE(io::write_png(at("scenes/wood.png"), wood));
        REQUIRE(write_file_atomic(at("scenes/room.pbrt"), room));
    }
    std::string at(const char* name) const { return (folder / name).string(); }
    void opened(document::Session& session) const {
        const auto done = session.open(at("scenes/room.pbrt"));
        INFO((done ? "" : done.error().message));
        REQUIRE(done);
    }
};

// --- exact comparison: ids by their order, heavy data by content
// ---------------------------------------------------------

struct ByOrder { // a visitor of fields()
    const Scene& scene;
    template <class T>
    void operator()(const char*, T& value) {
        remap(value);
    }
    void path(const char*, std::string&) {}
    void mesh(Mesh& m) { m.data = nullptr; }
    void image(Image& i) { i.data = nullptr; }

    template <class T>
    void remap(T&) {}
    template <class T>
    void remap(Id<T>& id) {
        std::uint32_t n = 0;
        table<T>(scene).each([&](Id<T> other, const T&) { n += other.value <= id.value; });
        id.value = id ? n : 0;
    }
    template <class T>
    void remap(std::optional<T>& x) {
        if constexpr (requires { document::fields(*this, *x); })
            if (x) document::fields(*this, *x);
    }
    void remap(ParamSet& params) {
        const ParamSet old = params;
        for (const auto& [id, value] : old.entries()) {
            Value v = value;
            remap(v.texture);
            remap(v.material);
            params.set(id, v);
        }
    }
};

template <class D>
bool same_data(const std::shared_ptr<const D>& a, const std::shared_ptr<const D>& b) {
    if (a == b || !a || !b) return a == b;
    if constexpr (std::is_same_v<D, MeshData>)
        return a->positions == b->positions && a->normals == b->normals && a->uvs == b->uvs && a->uvs2 == b->uvs2 &&
               a->tangents == b->tangents && a->triangles == b->triangles && a->lower == b->lower &&
               a->upper == b->upper;
    else
        return a->width == b->width && a->height == b->height && a->channels == b->channels && a->values == b->values;
}

inline void check_same(const Scene& a, const Scene& b) {
    scene::each_kind([&]<class T>(const scene::Kind<T>& kind) {
        std::vector<T> left, right;
        table<T>(a).each([&](auto, const T& item) { left.push_back(item); });
        table<T>(b).each([&](auto, const T& item) { right.push_back(item); });
        INFO(kind.name);
        REQUIRE(left.size() == right.size());
        for (std::size_t i = 0; i < left.size(); ++i) {
            INFO(i << ": " << left[i].name << " / " << right[i].name);
            if constexpr (requires { left[i].data; }) CHECK(same_data(left[i].data, right[i].data));
            ByOrder of_a{a}, of_b{b};
            document::fields(of_a, left[i]);
            document::fields(of_b, right[i]);
            CHECK(left[i] == right[i]);
        }
    });
    auto ea = a.environment.value, eb = b.environment.value;
    ByOrder{a}.remap(ea);
    ByOrder{b}.remap(eb);
    CHECK(ea == eb);
    auto ca = a.active_camera.value, cb = b.active_camera.value;
    ByOrder{a}.remap(ca);
    ByOrder{b}.remap(cb);
    CHECK(ca == cb);
    CHECK(a.film.value == b.film.value);
    auto sa = a.settings.value, sb = b.settings.value;
    ByOrder{a}.remap(sa.camera_medium);
    ByOrder{b}.remap(sb.camera_medium);
    CHECK(sa == sb);
}

} // namespace restage::test
