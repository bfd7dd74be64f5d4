// SPDX-License-Identifier: Apache-2.0
// Material presets: a material with all it refers to, in a JSON file of its own:
//   { "restage": "material", "name": "Gold", "category": "Metal", "type": "conductor",
//     "params": {"eta": [0.0584, 0.5002, 1.4592], "k": [15.2521, 2.2617, 1.7718]},
//     "source": "Johnson and Christy 1972" }
// Values are as the type's table says: a number, [r, g, b] or one number for grey, true, "a choice", "a file" of a
// table, {"texture": "oak"} of "textures", {"material": "base"} of "materials":
//   "textures": {"oak": {"type": "imagemap", "float": false, "params": {...},
//                        "image": {"file": "oak.png", "encoding": "srgb", "gamma": 2.2}}},
//   "materials": {"base": {"type": "diffuse", "params": {...}}}
// Files are relative to the preset's. Unknown members beginning with "x-" are ignored; others are errors.
#pragma once

#include "base/result.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace restage::document {

struct Preset {
    std::string name, category; // "Gold", "Metal": what it is
    std::string source; // of its numbers
    std::filesystem::path file; // ""= of a scene
    scene::Scene parts; // the material and what it refers to, on a small object, so that it can be merged
    scene::Id<scene::Material> material; // in `parts`
    std::uint64_t hash = 0; // of the file, and of sizes and times of the files it names
};

// Images are not decoded yet: read_images(). Every value is checked against the tables of the loaded plugins. Errors:
// "gold.json:7: \"eta\" is 12; it must be from 0 to 10". [any]
Result<Preset> read_preset(const std::filesystem::path& file, const plugin::Registry&);
// Decodes its images, once. [worker]
Result<> read_images(Preset&);

struct PresetFolder {
    std::vector<Preset> presets; // by category and name
    std::vector<std::string> problems; // of files that could not be read
};
// The files *.json in the folder; none if it does not exist. [any]
PresetFolder presets_in(const std::filesystem::path& folder, const plugin::Registry&);

// A material of a scene as a preset; an error if it does not exist. [any]
Result<Preset> preset_of(const scene::Scene&, scene::Id<scene::Material>);

// Writes file, and copies of the files it refers to beside it, named after it: "oak.json", "oak-planks.png". Images
// without a file become OpenEXR files. Existing files are replaced. [any]
Result<> write_preset(const Preset&, const std::filesystem::path& file);
// "Gold, satin" -> "gold-satin.json"
std::string preset_file_name(std::string_view name);

// The material for these objects: an equal one of the scene, or else a new one. One step, "Material Gold".
Result<scene::Edit> give_preset(const scene::Scene&, const Preset&, std::span<const scene::Id<scene::Instance>>);

} // namespace restage::document
