// SPDX-License-Identifier: Apache-2.0
#include "io/export.hpp"

#include "io/options.hpp"
#include "io/scene_reader.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace restage::io {

using namespace scene;

namespace {

std::string called(const model::Exporter& exporter) { return "exporter \"" + exporter.format + "\""; }

bool has_extension(const model::Exporter& exporter, std::string_view extension) {
    return std::ranges::find(exporter.extensions, extension) != exporter.extensions.end();
}

} // namespace

Result<plugin::ExporterEntry> find_exporter(const std::string& path, const std::string& format,
                                            const plugin::Registry& registry) {
    std::string known;
    for (const auto& entry : registry.exporters())
        known += (known.empty() ? "" : ", ") + std::string(entry.table->format);
    known = known.empty() ? "no exporter plugin is loaded" : "known: " + known;
    if (!format.empty()) {
        if (auto entry = registry.find_exporter(format)) return *std::move(entry);
        return fail("there is no exporter \"" + format + "\"; " + known);
    }
    std::string extension = std::filesystem::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    for (const auto& entry : registry.exporters())
        if (has_extension(*entry.table, extension)) return entry;
    return fail(path +
                (extension.empty() ? ": has no extension to tell the format by; "
                                   : ": no exporter writes files called ." + extension + "; ") +
                known);
}

Result<> set_option(const model::Exporter& exporter, const std::string& assignment, ParamSet& values) {
    return set_option(called(exporter), exporter.options, assignment, values);
}

Result<Report> export_scene(const Scene& scene, const std::string& path, const plugin::Registry& registry,
                            const ExportOptions& options) {
    RESTAGE_TRY(const plugin::ExporterEntry chosen, find_exporter(path, options.format, registry));
    const model::Exporter* exporter = chosen.table;
    for (const auto& [id, value] : options.values.entries())
        RESTAGE_CHECK(check_option(called(*exporter), exporter->options, id, value));
    for (const Problem& problem : validate(scene))
        if (problem.severity == Problem::Severity::error) return fail(path + ": not written: " + problem.sentence);

    const ParamSet all = all_options(exporter->options, options.values);
    const std::vector<RestageValue> values = give_values(all);
    SceneReader reader(scene, registry, options.progress);
    std::optional<CrashNote> note(std::in_place, chosen.plugin->blame("while it wrote " + path));
    const bool saved = chosen.native->save(path.c_str(), &reader.table(), values.data(),
                                           static_cast<std::uint32_t>(values.size())) != 0;
    note.reset();
    if (reader.cancelled()) return cancelled(path + reader.how_stopped());
    if (!reader.error().empty()) return fail(reader.error());
    if (!saved) return fail(path + ": exporter \"" + exporter->format + "\" failed without giving a reason");
    scene.instances.each([&](Id<Instance>, const Instance& instance) {
        if (instance.catcher && !instance.hidden)
            reader.report.add(Fate::approximated, "object \"" + instance.name + "\"",
                              "scene formats have no shadow catchers: it is written as an ordinary object");
    });
    return std::move(reader.report);
}

} // namespace restage::io
