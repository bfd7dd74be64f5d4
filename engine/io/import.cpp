// SPDX-License-Identifier: Apache-2.0
#include "io/import.hpp"

#include "base/file.hpp"
#include "io/options.hpp"
#include "io/scene_writer.hpp"
#include "io/sky.hpp"

#include <restage/scene_io.h>

#include <filesystem>
#include <optional>
#include <system_error>

namespace restage::io {

namespace fs = std::filesystem;
using scene::ParamSet;

namespace {

constexpr std::size_t head_bytes = 4096;

Result<std::string> read_head(const std::string& path) {
    std::error_code code;
    if (fs::is_directory(path, code)) return fail(path + ": is a folder; name the scene file in it");
    RESTAGE_TRY(RegularFile file, RegularFile::open(path));
    return file.read(head_bytes);
}

std::string known_formats(const plugin::Registry& registry) {
    std::string list;
    for (const auto& entry : registry.importers())
        list += (list.empty() ? "" : ", ") + std::string(entry.table->label);
    return list.empty() ? "no importer plugin is loaded; `restage plugins` says why" : "known: " + list;
}

Result<plugin::ImporterEntry> choose(const std::string& path, const std::string& head, const plugin::Registry& registry,
                                     const std::string& format) {
    if (!format.empty()) {
        if (auto entry = registry.find_importer(format)) return *std::move(entry);
        return fail(path + ": there is no importer \"" + format + "\"; " + known_formats(registry));
    }
    plugin::ImporterEntry best;
    int best_score = 0;
    for (const auto& entry : registry.importers()) { // ties go to the first in alphabetical order
        if (const int score = probe(entry, path, head); score > best_score) {
            best = entry;
            best_score = score;
        }
    }
    if (!best.table) return fail(path + ": unknown file format; " + known_formats(registry));
    return best;
}

} // namespace

int probe(const plugin::ImporterEntry& entry, const std::string& path, std::string_view head) {
    const CrashNote note(entry.plugin->blame("while it probed " + path));
    return entry.native->probe(path.c_str(), head.data(), head.size());
}

std::string to_string(const ReportEntry& entry) {
    std::string line = entry.file;
    if (entry.line) line += ":" + std::to_string(entry.line);
    line += (line.empty() ? "" : ": ") + std::string(to_string(entry.fate)) + ": " + entry.what;
    return entry.note.empty() ? line : line + ": " + entry.note;
}

Result<plugin::ImporterEntry> importer_of(const std::string& path, const plugin::Registry& registry,
                                          const std::string& format) {
    RESTAGE_TRY(const std::string head, read_head(path));
    return choose(path, head, registry, format);
}

Result<ImportedScene> import_scene(const std::string& path, const plugin::Registry& registry,
                                   const ImportOptions& options) {
    RESTAGE_TRY(const std::string head, read_head(path));
    RESTAGE_TRY(const plugin::ImporterEntry chosen, choose(path, head, registry, options.format));
    const model::Importer* importer = chosen.table;
    RESTAGE_TRY(ParamSet values, fitting_options(*importer, options.values));
    SceneWriter writer(registry, options.progress);
    writer.set_options(all_options(importer->options, values));
    std::optional<CrashNote> note(std::in_place, chosen.plugin->blame("while it read " + path));
    const bool loaded = chosen.native->load(path.c_str(), &writer.table()) != 0;
    note.reset();
    if (writer.cancelled()) return cancelled(path + writer.how_stopped());
    if (!writer.error().empty()) return fail(writer.error());
    if (!loaded) return fail(path + ": importer \"" + importer->format + "\" failed without giving a reason");
    std::optional<Jobs> own;
    Jobs& jobs = options.jobs ? *options.jobs : own.emplace();
    if (auto finished = writer.finish(jobs, options.read_images); !finished) return fail(path, finished.error());
    make_missing_sky(writer.scene, registry, writer.report, options.progress);
    if (writer.scene.format.empty()) writer.scene.format = importer->format;
    return ImportedScene{std::move(writer.scene), std::move(writer.report), importer->format, writer.unexposed,
                         std::move(values)};
}

} // namespace restage::io
