// SPDX-License-Identifier: Apache-2.0
// The place of a texture on its surface: the affine map from the mesh's texture coordinates uv to the texture's own,
// st, which the mapping parameters of a texture hold (model/texture.hpp). Moving, turning and stretching what is seen
// changes the map the other way round.
#pragma once

#include "scene/edits.hpp"

#include <functional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace restage::scene {

struct TextureMap {
    glm::dmat2 linear{1}; // columns: st of a unit of u, and of v
    glm::dvec2 shift{0};
    int set = 0; // of the mesh's two sets of uv
    glm::dvec2 operator()(const glm::dvec2& uv) const { return linear * uv + shift; }
    bool operator==(const TextureMap&) const = default;
};

TextureMap texture_map(const ParamSet&);

// What is seen at `from` is then seen at `to`. [uv]
TextureMap moved(const TextureMap&, const glm::dvec2& from, const glm::dvec2& to);
// What is seen is transformed by `by` [uv], invertible; what is at `about` stays.
TextureMap transformed(const TextureMap&, const glm::dmat2& by, const glm::dvec2& about);
// What is seen is as many times larger along s and t, from `about` [uv]. Factors are not 0.
TextureMap stretched(const TextureMap&, const glm::dvec2& factor, const glm::dvec2& about);
// The direction in uv along which s grows and t does not, [deg] in [-180, 180]: how far the texture is turned there.
double turn_of(const TextureMap&);

// Sets the maps of textures. An error for a map out of the parameters' range; shifts of repeating textures are brought
// into it, which changes nothing seen.
Result<Edit> set_texture_maps(const Scene&, std::span<const std::pair<Id<Texture>, TextureMap>>, std::string label);

// The textures of the graph that begins in a parameter of the material, operands included, in the order of parameters.
std::vector<Id<Texture>> textures_of(const Scene&, const Material&);

struct OwnTextures {
    Edit edit;
    Id<Material> material; // of the objects then
    std::unordered_map<Id<Texture>, Id<Texture>> copies; // of those that were shared, by original
};
// Gives the objects the textures for themselves: their material, if others have it, and each of `textures`, if another
// material uses it, are replaced by copies, with the textures that lead there. An error if the objects do not have the
// material. Without anything shared the edit is empty.
Result<OwnTextures> own_textures(const Scene&, std::span<const Id<Instance>>, Id<Material>,
                                 std::span<const Id<Texture>> textures);

struct TextureUsers {
    std::size_t objects = 0, materials = 0; // objects: that have one of the materials
};
// Everything that shows one of the textures.
TextureUsers users_of(const Scene&, std::span<const Id<Texture>> textures);

} // namespace restage::scene
