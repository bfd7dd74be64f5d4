// SPDX-License-Identifier: Apache-2.0
// MaterialSource: the host's copy of one material: its declaration, and the text of its GLSL as it
// was when the plugin was loaded. Neither the plugin's library nor its folder is accessed while a scene
// is rendered, so both may be replaced meanwhile, and the picture on screen continues with the old version.
// Immutable; any thread.
#pragma once

#include "base/result.hpp"
#include "model/material.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace restage::plugin {

class TableReader;

// Text of files, by their absolute, lexically normal path.
using FileTexts = std::map<std::filesystem::path, std::string>;

// Every *.glsl file in a plugin's folder, a few folders deep. Errors: unreadable, or more than 16 MiB in total.
Result<std::shared_ptr<const FileTexts>> read_glsl(const std::filesystem::path& folder);

class MaterialSource {
  public:
    // `material` must have passed check_material. Its tables' files are paths in the folder; here absolute.
    MaterialSource(model::Material material, std::filesystem::path folder, std::shared_ptr<const FileTexts> glsl,
                   std::shared_ptr<TableReader> table_reader = nullptr);
    MaterialSource(const MaterialSource&) = delete;

    const model::Material& material() const { return material_; } // valid as long as this
    const std::filesystem::path& folder() const { return folder_; }
    const std::shared_ptr<const FileTexts>& glsl() const { return glsl_; }
    // For its table parameters; null if it has none.
    const std::shared_ptr<TableReader>& table_reader() const { return table_reader_; }
    // Equal numbers mean equal declarations and equal GLSL.
    std::uint64_t revision() const { return revision_; }

  private:
    model::Material material_;
    std::filesystem::path folder_;
    std::shared_ptr<const FileTexts> glsl_;
    std::shared_ptr<TableReader> table_reader_;
    std::uint64_t revision_ = 0;
};

// The materials a manifest describes itself, without native code: its "materials", see manifest.hpp. `text`: the
// manifest's, already parsed once. Errors name the file and the place in it:
// 'plugin.json: "materials"[0]."params"[2]: "min" must be a number'.
Result<std::vector<model::Material>> parse_materials(const std::string& text, const std::string& file);

} // namespace restage::plugin
