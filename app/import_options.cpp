// SPDX-License-Identifier: Apache-2.0
#include "import_options.hpp"

#include "io/options.hpp"
#include "rendering.hpp"

namespace restage::app {

void add_import_options(CLI::App& command, std::vector<std::string>& assignments) {
    command
        .add_option("--import-set", assignments,
                    "Option of the importer: for OBJ, PLY, STL and glTF units=mm|cm|m|in|ft and up=y|z, for OBJ "
                    "merge=true, for "
                    "glTF scene=NAME and variant=NAME (may be repeated). For a project: replaces the saved ones")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

Result<io::ImportedScene> open_scene_with(Context& context, const std::string& path, bool strict,
                                          std::span<const std::string> assignments, document::Looks* looks) {
    if (assignments.empty()) return open_scene(context, path, strict, {}, looks);
    scene::ParamSet options; // as text: the importer is not known yet
    for (const std::string& assignment : assignments)
        RESTAGE_CHECK(io::set_text_option(assignment, options));
    return open_scene(context, path, strict, options, looks);
}

} // namespace restage::app
