// SPDX-License-Identifier: Apache-2.0
// One import: the model, and the scene built so far. Each kind of thing has its own file.
#pragma once

#include "common/mesh.hpp"
#include "common/options.hpp"
#include "common/report.hpp"
#include "common/textures.hpp"
#include "model.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <tuple>

namespace restage::gltf {

// KHR_texture_transform as an affine map of (u, v), v downwards as in glTF.
struct UvTransform {
    double a = 1, b = 0, c = 0, d = 1, x = 0, y = 0; // u' = a u + b v + x, v' = c u + d v + y
};

struct TextureUse { // a textureInfo from anywhere in the file
    int index = -1, set = 0;
    UvTransform transform;
    std::string slot; // "base colour", for messages
    explicit operator bool() const { return index >= 0; }
};

// The TEXCOORD_n that become the mesh's two sets; -1: none.
struct UvSets {
    std::array<int, 2> texcoord{-1, -1};
    int find(int set) const { return set == texcoord[0] ? 0 : set == texcoord[1] ? 1 : -1; }
};

// How vertex colours modify a material: by one factor, or by baked pictures (Importer::vertex_color).
struct VertexColor {
    Rgb factor{1, 1, 1};
    double alpha = 1;
    RestageHandle image = 0, alpha_image = 0;
    int set = 0; // of the mesh, on which these pictures lie
    auto key() const { return std::tuple(factor, alpha, image, alpha_image, set); }
};

std::string dispersed_index(double ior, double dispersion); // text of an origin's "spectrum:ior"

struct MadeMaterial { // a material, and the part of it that the scene stores per instance
    std::string name;
    RestageHandle material = 0, alpha_texture = 0, interior = 0;
    float alpha = 1;
    bool has_interior = false, two_sided = false;
    bool needs_tangents = false;
    double ior = 1.5, dispersion = 0; // 20 / its Abbe number
    TextureUse normal; // the normal map, if any
    Rgb emission{}; // of the instances; an emissive picture is the material's
    UvSets uv;
};

class Importer {
  public:
    Importer(const RestageSceneWriter1& writer, const std::filesystem::path& path, const tinygltf::Model& model)
        : out_(writer), path_(path), model_(model), placement_(writer, Up::y), report_(writer, path.string()) {}
    void run();

  private:
    // load.cpp
    void check_extensions();
    void tell_leftovers();
    void progress(float done, const char* what) const;

    // choices.cpp
    std::optional<int> asked(const char* option, const std::vector<std::string>& names) const;
    void tell_choices(const char* option, const std::vector<std::string>& names, std::size_t least);
    void choose_variant();
    int material_of(const tinygltf::Primitive&) const;

    // nodes.cpp
    std::vector<int> choose_roots();
    std::string scene_name(int scene) const;
    void find_transforms(int node, const Matrix& parent, bool hidden, int depth);
    bool shows_something(int node) const;
    void node(int node, RestageHandle group);
    void mesh_node(int node, RestageHandle group, const std::string& name);
    std::vector<Matrix> placements(int node); // EXT_mesh_gpu_instancing
    std::string node_name(int node) const;

    // lights.cpp
    void light(int node, int light);
    void camera(int node);

    // meshes.cpp
    struct Piece { // the sources of instances
        RestageHandle mesh = 0;
        Bounds bounds;
        const MadeMaterial* material = nullptr;
    };
    std::optional<Piece> primitive(int mesh, std::size_t primitive, int node);
    std::optional<MeshBuffer> read_primitive(const tinygltf::Primitive&, const std::string& who, int node, int mesh,
                                             const UvSets&, std::vector<float>& colors);
    std::vector<float> read_uvs(const tinygltf::Primitive&, const std::string& who, int set, std::size_t vertices);
    void morph(const tinygltf::Primitive&, const std::string& who, int node, int mesh, MeshBuffer&);
    void pose(const tinygltf::Primitive&, const std::string& who, int node, MeshBuffer&);
    VertexColor vertex_color(const tinygltf::Primitive&, const std::string& who, const std::vector<float>& colors,
                             const UvSets&, MeshBuffer&);
    RestageHandle color_picture(const std::string& name, const std::vector<float>& colors, bool alpha,
                                const MeshBuffer&);
    void tangents(const tinygltf::Primitive&, const std::string& who, const MadeMaterial&, MeshBuffer&);

    // materials.cpp, material_extensions.cpp
    std::vector<TextureUse> texture_uses(const tinygltf::Material&) const;
    UvSets uv_sets(int material) const;
    const MadeMaterial& material(int index, const VertexColor&);
    MadeMaterial make_material(int index, const VertexColor&);
    RestageHandle color_texture(const char* id, const Rgb& factor, const TextureUse&, const MadeMaterial&);
    void put_color(Values&, const char* id, Rgb factor, const TextureUse&, const MadeMaterial&, double most = 1);
    void put_scalar(Values&, const char* id, double factor, const TextureUse&, unsigned channel, const MadeMaterial&);
    struct BaseColor {
        Rgb factor{1, 1, 1};
        double alpha = 1;
        TextureUse use;
        bool metal = false; // specular-glossiness without diffuse colour: a metal of the specular one
    };
    BaseColor base_color(const tinygltf::Material&) const;
    void put_base(Values&, const char* id, const BaseColor&, const VertexColor&, const MadeMaterial&);
    void alpha(const tinygltf::Material&, const BaseColor&, const VertexColor&, MadeMaterial&);
    void emission(const tinygltf::Material&, MadeMaterial&, Values&);
    void unlit(const BaseColor&, const VertexColor&, MadeMaterial&, Values&, const char*& type);
    void glossiness(const tinygltf::Value&, bool metal, MadeMaterial&, Values&);
    void clear_coat(const tinygltf::Material&, const tinygltf::Value&, MadeMaterial&, Values&);
    void extensions(const tinygltf::Material&, const BaseColor&, MadeMaterial&, Values&);
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
    enum class Purpose { srgb, linear, red, green, blue, alpha, mask, normal, gloss };
    RestageHandle texture(const TextureUse&, Purpose, const UvSets&, const std::string& material, double number = 1);
    RestageHandle image(int image, Purpose, double number, bool mirror_u, bool mirror_v);
    Mapping mapping(const TextureUse&, const UvSets&, bool& mirror_u, bool& mirror_v, const std::string& material);
    std::filesystem::path locate(const std::string& uri) const { return find_named(path_.parent_path(), uri); }

    const RestageSceneWriter1& out_;
    const std::filesystem::path path_;
    const tinygltf::Model& model_;
    const Placement placement_; // of the file's root nodes
    Report report_;
    std::optional<int> variant_; // of the materials; none = the file's own
    std::vector<Matrix> world_;     // of each node
    std::vector<int> visits_;       // of each node: 0 = not in the scene
    std::vector<char> hidden_;      // of each node: KHR_node_visibility, its own or an ancestor's
    std::map<std::tuple<int, decltype(VertexColor().key())>, MadeMaterial> materials_;
    std::map<std::pair<int, std::size_t>, std::optional<Piece>> pieces_;
    std::map<int, std::optional<Picture>> pictures_;
    std::map<std::tuple<int, int, double, bool, bool>, RestageHandle> images_;
    Bounds bounds_, hidden_bounds_;
    std::size_t cameras_ = 0, lights_ = 0, hidden_objects_ = 0;
    std::size_t objects_ = 0, emitters_ = 0, nodes_done_ = 0;
    double aspect_ = 16.0 / 9; // of the picture
};

// Members of an extension's object.
double number_of(const tinygltf::Value&, const char* key, double otherwise);
Rgb color_of(const tinygltf::Value&, const char* key, Rgb otherwise);

} // namespace restage::gltf
