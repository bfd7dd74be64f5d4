// SPDX-License-Identifier: Apache-2.0
// What a plugin's tables must fulfil before anything else looks at them: sizes, strings that are there, ids that are
// GLSL identifiers, defaults in range. Each check returns "" or the sentence that refuses the plugin.
#pragma once

#include <restage/denoiser.h>
#include <restage/emission.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/table.h>
#include <filesystem>
#include <string>
#include <string_view>

namespace restage::plugin {

bool is_glsl_identifier(std::string_view); // and no reserved word
bool is_taken_prefix(std::string_view); // by the functions that call a material's
std::string check_params(const RestageParam* params, std::uint32_t count);
std::string check_table(const RestageMaterial1&, const std::filesystem::path& folder);
std::string check_table(const RestageImporter1&);
std::string check_table(const RestageExporter1&);
std::string check_table(const RestageDenoiser1&);
std::string check_table(const RestageInspector1&);
std::string check_table(const RestageTable1&);
std::string check_table(const RestageEmission1&);
// Does what `emission` names exist in the table of its material?
std::string check_emission(const RestageEmission1& emission, const RestageMaterial1& material);
bool has_table(const RestageMaterial1&); // a parameter of type RESTAGE_TABLE

} // namespace restage::plugin
