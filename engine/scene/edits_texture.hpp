// SPDX-License-Identifier: Apache-2.0
// Edit builders for textures in slots: parameters of materials, and operands of other textures.
#pragma once

#include "model/texture.hpp"
#include "scene/edits.hpp"

#include <variant>

namespace restage::scene {

// A parameter that a texture may replace.
struct TextureSlot {
    std::variant<Id<Material>, Id<Texture>> of;
    std::string param;
    Value value; // set or default; its type is the parameter's
    bool scalar = false; // reads one channel
};

// Whether `from` is `to`, or has it as an operand at any depth.
bool contains(const Scene&, Id<Texture> from, Id<Texture> to);

// A new texture of this type in the slot. Its first operand is the slot's previous texture or constant; the image of a
// previous texture is kept.
Result<Edit> new_texture(const Scene&, const TextureSlot&, const model::Texture& table);
// An `imagemap` of this image; see set_image_texture of materials.
Result<Edit> set_image_texture(const Scene&, const TextureSlot&, Image);
// The texture's own image; one of the same file and encoding is shared.
Result<Edit> set_image(const Scene&, Id<Texture>, Image);
// Values compatible with the new type are kept; operands without such a value take the old type's, in order. `before`:
// null if no plugin has the old type.
Result<Edit> switch_texture_type(const Scene&, Id<Texture>, const model::Texture* before, const model::Texture& after);
Result<Edit> reset_param(const Scene&, Id<Texture>, std::string_view param); // back to the table's default

} // namespace restage::scene
