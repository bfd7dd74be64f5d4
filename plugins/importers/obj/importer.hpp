// SPDX-License-Identifier: Apache-2.0
// One import: what tinyobjloader read, the lines it stood on, and what has been made of it so far.
#pragma once

#include "common/error.hpp"
#include "common/matrix.hpp"
#include "common/mesh.hpp"
#include "common/report.hpp"
#include "common/textures.hpp"
#include "text.hpp"

#include <restage/scene_io.h>
#include <tiny_obj_loader.h>
#include <filesystem>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace restage::obj {

using namespace importing;

struct MadeMaterial { // a material, and what of it the scene says of an instance
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
    void parse();
    void load_libraries(std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* by_name,
                        std::string* warnings);
    void tell_warnings(const std::string& warnings);
    void check_indices();
    void tell_leftovers();
    friend struct LibraryReader;

    // shapes.cpp
    void shape(const tinyobj::shape_t&);
    void smooth(); // normals of smoothing groups, over all shapes
    MeshBuffer mesh(const tinyobj::shape_t&, int material) const;

    // materials.cpp
    const MadeMaterial& material(int id);
    MadeMaterial make_material(const tinyobj::material_t&);
    struct Slot;
    RestageHandle color_texture(const Slot&, const Rgb& factor);
    RestageHandle scalar_texture(const Slot&, double factor = 1, bool invert = false);
    RestageHandle alpha_texture(const Slot&, double factor);
    void bump(const Slot&, Values&);
    void emission(const tinyobj::material_t&, MadeMaterial&);
    Mapping mapping(const Slot&);

    const RestageSceneWriter1& out_;
    const std::filesystem::path path_;
    const std::string_view text_;
    Report report_;
    ObjText lines_;
    struct Library {
        std::filesystem::path path;
        std::map<std::string, MtlEntry> entries;
    };
    std::vector<Library> libraries_;

    tinyobj::attrib_t attributes_;
    std::vector<tinyobj::shape_t> shapes_;
    std::vector<tinyobj::material_t> materials_;
    std::map<int, MadeMaterial> made_;
    std::unordered_map<std::uint64_t, Vec3> smoothed_; // by smoothing group << 32 | vertex
    Bounds bounds_;
    std::size_t triangles_ = 0, objects_ = 0;
};

} // namespace restage::obj
