// SPDX-License-Identifier: Apache-2.0
// One import: the model, and what has been made of it so far. Each kind of thing has a file of its own.
#pragma once

#include "common/mesh.hpp"
#include "common/report.hpp"
#include "common/textures.hpp"
#include "model.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

namespace restage::gltf {

// KHR_texture_transform as an affine map of (u, v), v downwards as glTF has it.
struct UvTransform {
    double a = 1, b = 0, c = 0, d = 1, x = 0, y = 0; // u' = a u + b v + x, v' = c u + d v + y
    bool diagonal() const { return b == 0 && c == 0; }
    bool operator==(const UvTransform&) const = default;
};
UvTransform relative(const UvTransform& t, const UvTransform& base); // t * base^-1

struct TextureUse { // a textureInfo, wherever in the file it stands
    int index = -1, set = 0;
    UvTransform transform;
    std::string slot; // "base colour", for messages
    explicit operator bool() const { return index >= 0; }
};

// What a mesh must know of its material: one uv set reaches the renderer, and no rotation of it.
struct UvPlan {
    int set = 0;
    UvTransform baked; // into the vertices; textures have the rest
    bool operator==(const UvPlan&) const = default;
    auto key() const { return std::tuple(set, baked.a, baked.b, baked.c, baked.d, baked.x, baked.y); }
};

// What vertex colours do to a material.
struct VertexColor {
    Rgb factor{1, 1, 1};
    RestageHandle image = 0; // a picture made of them, see bake_colors in meshes.cpp
    bool plain() const { return image == 0 && factor == Rgb{1, 1, 1}; }
};

struct MadeMaterial { // a material, and what of it the scene says of an instance
    std::string name;
    RestageHandle material = 0, alpha_texture = 0, interior = 0;
    float alpha = 1;
    bool has_interior = false, two_sided = false, normal_mapped = false;
    Rgb emission{};              // of all of it, or
    TextureUse emission_texture; // times this
    UvPlan uv;
};

class Importer {
  public:
    Importer(const RestageSceneWriter1& writer, const std::filesystem::path& path, const tinygltf::Model& model)
        : out_(writer), path_(path), model_(model), report_(writer, path.string()) {}
    void run();

  private:
    // load.cpp
    void check_extensions();
    void tell_leftovers();
    void progress(float done, const char* what) const;

    // nodes.cpp
    int choose_scene();
    void find_transforms(int node, const Matrix& parent, int depth);
    bool shows_something(int node) const;
    void node(int node, RestageHandle group);
    void mesh_node(int node, RestageHandle group, const std::string& name);
    std::vector<Matrix> placements(int node); // EXT_mesh_gpu_instancing
    std::string node_name(int node) const;

    // lights.cpp
    void light(int node, int light);
    void camera(int node);

    // meshes.cpp
    struct Piece { // what becomes an instance
        RestageHandle mesh = 0;
        Bounds bounds;
        Rgb emission{};
        const MadeMaterial* material = nullptr;
    };
    std::vector<Piece> primitive(int mesh, std::size_t primitive, int node);
    std::optional<MeshBuffer> read_primitive(const tinygltf::Primitive&, const std::string& who, int node, int mesh,
                                             const UvPlan&, std::vector<float>& colors);
    void morph(const tinygltf::Primitive&, const std::string& who, int node, int mesh, MeshBuffer&);
    void pose(const tinygltf::Primitive&, const std::string& who, int node, MeshBuffer&);
    VertexColor vertex_color(const tinygltf::Primitive&, const std::string& who, const std::vector<float>& colors,
                             MeshBuffer&);
    std::vector<Piece> by_emission(MeshBuffer, const MadeMaterial&, const std::string& name);

    // materials.cpp, material_extensions.cpp
    UvPlan uv_plan(int material);
    const MadeMaterial& material(int index, const VertexColor&);
    MadeMaterial make_material(int index, const VertexColor&);
    void put_color(Values&, const char* id, Rgb factor, const TextureUse&, const MadeMaterial&);
    void put_scalar(Values&, const char* id, double factor, const TextureUse&, unsigned channel, const MadeMaterial&);
    void base_color(const tinygltf::Material&, const VertexColor&, MadeMaterial&, Values&);
    void alpha(const tinygltf::Material&, const TextureUse&, double factor, MadeMaterial&);
    void extensions(const tinygltf::Material&, MadeMaterial&, Values&);
    void volume(const tinygltf::Value&, const std::string& name, MadeMaterial&, Values&);
    void anisotropy(const tinygltf::Value&, const std::string& what, MadeMaterial&, Values&);
    void iridescence(const tinygltf::Value&, MadeMaterial&, Values&);

    // textures.cpp
    TextureUse use_of(const tinygltf::Value& owner, const char* key, const char* slot) const;
    template <class Info>
    TextureUse use_of(const Info& info, const char* slot) const {
        return make_use(info.index, info.texCoord, info.extensions, slot);
    }
    TextureUse make_use(int index, int set, const tinygltf::ExtensionMap&, const char* slot) const;
    int image_of(const TextureUse&);
    const Picture* picture(int image); // decoded; null: reported
    enum class Purpose { srgb, linear, red, green, blue, alpha, mask, normal };
    RestageHandle texture(const TextureUse&, Purpose, const UvPlan&, const std::string& material, double number = 1);
    RestageHandle image(int image, Purpose, double number, bool mirror_u, bool mirror_v);
    Mapping mapping(const TextureUse&, const UvPlan&, bool& mirror_u, bool& mirror_v, const std::string& material);

    const RestageSceneWriter1& out_;
    const std::filesystem::path path_;
    const tinygltf::Model& model_;
    Report report_;
    std::vector<Matrix> world_;     // of each node
    std::vector<int> visits_;       // of each node: 0 = not in the scene
    std::map<std::tuple<int, RestageHandle, Rgb>, MadeMaterial> materials_;
    std::map<std::pair<int, std::size_t>, std::vector<Piece>> pieces_;
    std::map<int, std::optional<Picture>> pictures_;
    std::map<std::tuple<int, int, double, bool, bool>, RestageHandle> images_;
    Bounds bounds_;
    std::size_t cameras_ = 0, lights_ = 0;
    std::size_t objects_ = 0, emitters_ = 0, nodes_done_ = 0;
};

// Members of an extension's object.
double number_of(const tinygltf::Value&, const char* key, double otherwise);
Rgb color_of(const tinygltf::Value&, const char* key, Rgb otherwise);

} // namespace restage::gltf
