// SPDX-License-Identifier: Apache-2.0
#include "import_options.hpp"

#include "document/document.hpp"
#include "document/exposure.hpp"
#include "io/options.hpp"
#include "io/strict.hpp"
#include "rendering.hpp"

namespace restage::app {

void add_import_options(CLI::App& command, std::vector<std::string>& assignments) {
    command
        .add_option("--import-set", assignments,
                    "Option of the importer: of OBJ, PLY and STL, units=mm|cm|m|in|ft and up=y|z, of OBJ merge=true "
                    "(may be repeated)")
        ->type_name("NAME=VALUE")
        ->allow_extra_args(false);
}

Result<io::ImportedScene> open_scene_with(Context& context, const std::string& path, bool strict,
                                          std::span<const std::string> assignments) {
    if (assignments.empty()) return open_scene(context, path, strict);
    if (context.isolate) return fail("--import-set and --isolate cannot be used together");
    if (document::is_project(path))
        return fail(path + ": is a project; --import-set is for the scene files of an importer");
    io::ImportOptions options;
    RESTAGE_TRY(const plugin::ImporterEntry importer, io::importer_of(path, context.registry()));
    options.format = importer.table->format;
    for (const std::string& assignment : assignments)
        RESTAGE_CHECK(io::set_option(*importer.table, assignment, options.values));
    options.progress = [](float, std::string_view) { return !interrupted(); };
    RESTAGE_TRY(io::ImportedScene imported, io::import_scene(path, context.registry(), options));
    document::expose(imported, context.registry());
    if (strict) RESTAGE_CHECK(io::refuse_losses(imported.report, path));
    for (const io::ReportEntry& entry : imported.report.entries)
        if (entry.fate != io::Fate::kept) context.log.warning(io::to_string(entry));
    return imported;
}

} // namespace restage::app
