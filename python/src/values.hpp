// SPDX-License-Identifier: Apache-2.0
// Values of parameters between Python and scenes: numbers, triples, words, materials, textures.
#pragma once

#include "workspace.hpp"

#include <span>

namespace restage::python {

// float | (r, g, b) | int | bool | str | Material | Texture | None
nb::object to_python(const std::shared_ptr<Workspace>&, const scene::Value&);

// `who`: 'parameter "roughness"', for messages. A COLOR takes one number for all three as well. Textures and materials
// are the workspace's; without one they are refused.
scene::Value to_value(const Workspace*, model::ParamType, nb::handle, const std::string& who);

// The type of a value without a table line: from the current value, or guessed from the new one.
model::ParamType guess_type(const scene::Value* before, nb::handle);

// The lines of a material type's table; empty for types without a plugin.
std::vector<model::Param> table_of(Workspace&, const std::string& type);

// Of a texture type, with the map that MAPPED types have; empty for types without a plugin.
std::vector<model::Param> texture_table_of(Workspace&, const std::string& type);

struct Parameter { // of a table, for scripts
    model::Param line;
};
std::vector<Parameter> parameters(model::ParamTable);

// str or os.PathLike: the path of a file, made absolute. Refuses anything else.
std::optional<std::string> to_path(nb::handle);

// The image of a file, ready for an edit. [GIL, which it releases while it reads]
scene::Image read_image(Workspace&, const std::string& path, scene::Encoding);

// An array (H, W, 1, 3 or 4), linear. `who`: of the caller, for messages.
std::shared_ptr<const scene::PixelData> pixels_of(nb::handle array, const char* who);

} // namespace restage::python
