// SPDX-License-Identifier: Apache-2.0
// One import: the model, and the scene built so far.
#pragma once

#include "common/error.hpp"
#include "common/matrix.hpp"
#include "common/mesh.hpp"
#include "common/options.hpp"
#include "common/report.hpp"
#include "common/textures.hpp"
#include "model.hpp"
#include "mtl.hpp"

#include <restage/scene_io.h>
#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace restage::obj {

using namespace importing;

struct MadeMaterial { // a material, and the part of it that the scene stores per instance
    RestageHandle material = 0, alpha_texture = 0;
    float alpha = 1;
    bool emits = false;
    Rgb emission{};
};

class Importer {
  public:
    Importer(const RestageSceneWriter1& writer, const std::filesystem::path& path, std::string_view text);
    void run();

  private:
    // load.cpp
    void read_libraries();
    void tell_leftovers();

    // shapes.cpp
    void shape(const Shape&);
    void smooth(); // normals of smoothing groups, over all shapes
    MeshBuffer mesh(const Shape&, int material, std::vector<std::uint32_t>& vertices) const;
    MadeMaterial colored(MeshBuffer&, const std::vector<std::uint32_t>& vertices, int material,
                         const std::string& name); // the material, with vertex colours if it can show them
    struct Object {
        std::string name;
        RestageHandle group = 0;
    };
    void object(const MeshBuffer&, const MadeMaterial&, const Object&);
    void gather(MeshBuffer, const MadeMaterial&, int material, const std::string& name); // for `merge`
    void merged(); // the objects built from the shapes
    void strokes(); // of a file with points and lines only

    // materials.cpp
    const MadeMaterial& material(int id);
    MadeMaterial make_material(const Mtl&, RestageHandle baked = 0); // an image instead of its colour
    const Mtl* find(const std::string& name) const;
    struct Slot;
    RestageHandle color_texture(const Slot&, const Rgb& factor);
    RestageHandle scalar_texture(const Slot&, double factor = 1, bool invert = false);
    RestageHandle alpha_texture(const Slot&, double factor);
    void bump(const Slot&, Values&);
    void emission(const Mtl&, MadeMaterial&);
    Mapping mapping(const Slot&);

    const RestageSceneWriter1& out_;
    const std::filesystem::path path_;
    const std::string_view text_;
    Report report_;
    Model model_;
    struct Library {
        std::filesystem::path path;
        std::vector<Mtl> materials;
    };
    std::vector<Library> libraries_;
    std::map<int, MadeMaterial> made_;
    std::unordered_map<std::uint64_t, Vec3> smoothed_; // by smoothing group << 32 | vertex
    Bounds bounds_;
    std::size_t triangles_ = 0, objects_ = 0;
    Placement placement_;
    bool merge_ = false;
    struct Gathered {
        MeshBuffer mesh;
        MadeMaterial material;
        std::string name;
    };
    std::vector<Gathered> gathered_;
    std::map<std::array<std::uint32_t, 3>, std::size_t> gathered_at_; // by material, with normals, with uvs
    bool stroked_ = false; // points and lines got a thickness
};

} // namespace restage::obj
