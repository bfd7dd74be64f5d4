// SPDX-License-Identifier: Apache-2.0
// Validation of a plugin's tables before anything else uses them: ids are GLSL identifiers, defaults are in
// range, files exist. Each check returns "" or the reason for refusal.
#pragma once

#include "model/action.hpp"
#include "model/formats.hpp"
#include "model/material.hpp"
#include "model/sky.hpp"
#include "model/texture.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace restage::plugin {

bool is_glsl_identifier(std::string_view); // and not a reserved word
bool is_taken_prefix(std::string_view);    // used by the functions that call a material's
bool is_type_name(std::string_view);       // lower_snake, as in scene files
std::string check_params(model::ParamTable);
std::string check_material(const model::Material&, const std::filesystem::path& folder); // including its emission
std::string check_texture(const model::Texture&, const std::filesystem::path& folder);
std::string check_importer(const model::Importer&);
std::string check_exporter(const model::Exporter&);
std::string check_action(const model::Action&);
std::string check_panel(const model::Panel&);
std::string check_sky(const model::Sky&);
bool has_table(const model::Material&); // a table parameter

} // namespace restage::plugin
