// SPDX-License-Identifier: Apache-2.0
// JSON of project files below the level of items: numbers that round-trip exactly, blocks of bytes, geometry and
// pixels not available from a file, and a layout in which changing one value changes one line.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace restage::document {

using json = nlohmann::ordered_json;

inline constexpr const char* type_names[] = {"float", "color",    "int",     "bool", "enum",
                                             "text",  "material", "texture", "table"};

// The shortest decimal that reads back as this number; "inf", "-inf", "nan" as text.
json number_json(float x);
json number_json(double x);
bool read_number(const json& j, float& x);
bool read_number(const json& j, double& x);

json inline_mesh(const scene::MeshData& mesh);
json inline_image(const scene::PixelData& pixels);
Result<std::shared_ptr<const scene::MeshData>> read_inline_mesh(const json& j);
Result<std::shared_ptr<const scene::PixelData>> read_inline_image(const json& j);

// Lists of numbers on one line, everything else indented.
std::string pretty(const json& j);

// Among unknown members, an object with this one only marks a place: it is not to be recreated.
inline constexpr const char* place_mark = "\x01";
void erase_marks(json& j);

} // namespace restage::document
