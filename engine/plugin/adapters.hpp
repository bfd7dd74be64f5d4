// SPDX-License-Identifier: Apache-2.0
// From plugin declarations to the engine's model, one function per interface revision: "restage.material/2" will
// add one here, and change nothing else in the engine. The functions check what reading relies on
// (sizes, required strings); all other rules for tables are in tables.hpp. Errors are sentences about the
// table, without the plugin's name. [main]
#pragma once

#include "base/result.hpp"
#include "model/action.hpp"
#include "model/formats.hpp"
#include "model/material.hpp"
#include "model/sky.hpp"
#include "plugin/texture_source.hpp"

#include <restage/action.h>
#include <restage/denoiser.h>
#include <restage/emission.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/sky.h>
#include <restage/table.h>
#include <restage/texture.h>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace restage::plugin {

struct MaterialAdapter {
    const char* interface_id;
    Result<model::Material> (*read)(const void* table);
};
// Every revision that this program supports, newest first.
std::span<const MaterialAdapter> material_adapters();

Result<model::Material> read_material1(const void* table);
Result<std::vector<model::Param>> read_params(const RestageParam* params, std::uint32_t count);

struct DeclaredTexture {
    model::Texture texture;
    TextureEval eval = nullptr;
};
Result<DeclaredTexture> read_texture1(const RestageTexture1&);

// A table of the model in the form that plugins see. The pointer is non-null even if the table is empty.
class GivenTable {
  public:
    explicit GivenTable(model::ParamTable);
    GivenTable(const GivenTable&) = delete;
    const RestageParam* lines() const { return lines_.data(); }
    std::uint32_t count() const { return static_cast<std::uint32_t>(lines_.size() - 1); }

  private:
    std::vector<model::Param> params_; // owns the strings that lines_ points to
    std::vector<std::string> choices_; // joined
    std::vector<RestageParam> lines_; // plus one dummy at the end
};

// For a material of the same plugin.
struct DeclaredEmission {
    std::string material_type;
    model::Emission emission;
};
Result<DeclaredEmission> read_emission1(const RestageEmission1&);

Result<model::Importer> read_importer1(const RestageImporter1&);
Result<model::Exporter> read_exporter1(const RestageExporter1&);
Result<model::Action> read_action1(const RestageAction1&);
Result<model::Panel> read_panel1(const RestagePanel1&);
Result<model::Sky> read_sky1(const RestageSky1&);

std::vector<std::string> split_words(std::string_view text); // at '|'
std::uint32_t abi_type(model::ParamType); // RestageType
std::optional<model::ParamType> model_type(std::uint32_t type); // nullopt: unknown to this program

} // namespace restage::plugin
