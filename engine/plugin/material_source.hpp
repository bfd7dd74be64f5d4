// SPDX-License-Identifier: Apache-2.0
// MaterialSource: what the host keeps of one material: a copy of its parameter table, and the text of its GLSL as it
// was when the plugin was loaded. Nothing of the plugin's library and nothing of its folder is looked at while a scene
// is rendered, so that both may be replaced meanwhile, and what is on the screen goes on with what it was made of.
// Immutable once made; any thread.
#pragma once

#include "base/result.hpp"

#include <restage/emission.h>
#include <restage/material.h>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace restage::plugin {

class TableReader;

// Text of files, by their absolute, lexically normal path.
using FileTexts = std::map<std::filesystem::path, std::string>;

// Every *.glsl file of a plugin's folder, a few folders deep. Errors: unreadable, or more than 16 MiB in sum.
Result<std::shared_ptr<const FileTexts>> read_glsl(const std::filesystem::path& folder);

class MaterialSource {
  public:
    // `table` must have passed check_table, and `emission` check_emission; null = it does not shine.
    MaterialSource(const RestageMaterial1& table, std::filesystem::path folder, std::shared_ptr<const FileTexts> glsl,
                   std::shared_ptr<TableReader> table_reader = nullptr, const RestageEmission1* emission = nullptr);
    MaterialSource(const MaterialSource&) = delete;

    const RestageMaterial1& table() const { return table_; } // lives as long as this
    const std::filesystem::path& folder() const { return folder_; }
    const std::shared_ptr<const FileTexts>& glsl() const { return glsl_; }
    // Of its RESTAGE_TABLE parameters, whose defaults are absolute paths here; null = it has none.
    const std::shared_ptr<TableReader>& table_reader() const { return table_reader_; }
    const RestageEmission1* emission() const { return emission_ ? &*emission_ : nullptr; } // lives as long as this
    // Equal numbers: equal table, equal emission and equal GLSL.
    std::uint64_t revision() const { return revision_; }

  private:
    const char* keep(const char* text);

    std::filesystem::path folder_;
    std::shared_ptr<const FileTexts> glsl_;
    std::shared_ptr<TableReader> table_reader_;
    std::deque<std::string> strings_; // does not move what it holds
    std::vector<RestageParam> params_;
    RestageMaterial1 table_{};
    std::optional<RestageEmission1> emission_;
    std::uint64_t revision_ = 0;
};

// The materials a manifest describes itself, for plugins without native code: its "materials", see manifest.hpp. Held
// together because the tables point into it.
class JsonMaterials {
  public:
    // `text`: of the manifest, which has been parsed before. Errors name the file and the place in it:
    // 'plugin.json: "materials"[0]."params"[2]: "min" must be a number'.
    static Result<std::unique_ptr<JsonMaterials>> parse(const std::string& text, const std::string& file);
    std::span<const RestageMaterial1> tables() const { return tables_; }
    std::span<const RestageEmission1> emissions() const { return emissions_; } // of those that shine

  private:
    friend struct JsonReader;
    std::deque<std::string> strings_;
    std::deque<std::vector<RestageParam>> params_;
    std::vector<RestageMaterial1> tables_;
    std::vector<RestageEmission1> emissions_;
};

} // namespace restage::plugin
