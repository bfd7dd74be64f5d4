// SPDX-License-Identifier: Apache-2.0
#include "io/strict.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <random>
#include <system_error>

namespace restage::io {

namespace fs = std::filesystem;

namespace {

bool is_loss(const ReportEntry& entry) { return entry.fate != io::Fate::kept; }

// "" = everything was kept.
std::string losses(const std::vector<ReportEntry>& entries) {
    constexpr std::size_t most = 20;
    std::string list;
    std::size_t lost = 0;
    for (const ReportEntry& entry : entries)
        if (is_loss(entry) && ++lost <= most) list += "\n  " + to_string(entry);
    if (lost == 0) return "";
    if (lost > most) list += "\n  and " + std::to_string(lost - most) + " more";
    return std::to_string(lost) + (lost == 1 ? " thing is not kept:" : " things are not kept:") + list;
}

// What `read` lost from its file, and `written` lacks too: if something is merely rendered differently but is
// complete in the written file, the report of its import says the same.
std::vector<ReportEntry> not_in(const Report& read, const std::string& written, const plugin::Registry& registry) {
    std::vector<ReportEntry> lost;
    std::copy_if(read.entries.begin(), read.entries.end(), std::back_inserter(lost), is_loss);
    if (lost.empty()) return lost;
    const auto again = import_scene(written, registry, {.read_images = false});
    if (!again) return lost;
    std::erase_if(lost, [&](const ReportEntry& entry) {
        return std::any_of(again->report.entries.begin(), again->report.entries.end(), [&](const ReportEntry& same) {
            return same.fate == entry.fate && same.what == entry.what && same.note == entry.note;
        });
    });
    return lost;
}

// `read`: the report of the import before it, or null.
Result<Report> write_strictly(const scene::Scene& scene, const std::string& path, const plugin::Registry& registry,
                              ExportOptions options, const Report* read) {
    RESTAGE_TRY(const plugin::ExporterEntry chosen, find_exporter(path, options.format, registry));
    options.format = chosen.table->format;
    std::error_code code;
    const fs::path folder =
        fs::temp_directory_path(code) / ("restage-export-" + std::to_string(std::random_device{}()));
    if (code || !fs::create_directory(folder, code))
        return fail("cannot create a temporary folder: " + folder.string() + ": " + code.message());
    const std::string trial = (folder / fs::path(path).filename()).string();
    const auto tried = export_scene(scene, trial, registry, options);
    std::vector<ReportEntry> lost;
    if (tried && read) lost = not_in(*read, trial, registry);
    fs::remove_all(folder, code);
    if (!tried) return fail(tried.error().message);
    lost.insert(lost.end(), tried->entries.begin(), tried->entries.end());
    if (const std::string list = losses(lost); !list.empty())
        return fail(path + ": not written, since writing is strict: " + list);
    return export_scene(scene, path, registry, options);
}

} // namespace

Result<> refuse_losses(const Report& report, const std::string& path) {
    const std::string list = losses(report.entries);
    return list.empty() ? Result<>() : fail(path + ": refused, since reading is strict: " + list);
}

Result<Report> export_strictly(const scene::Scene& scene, const std::string& path, const plugin::Registry& registry,
                               ExportOptions options) {
    return write_strictly(scene, path, registry, std::move(options), nullptr);
}

Result<Report> convert_strictly(const ImportedScene& imported, const std::string& path,
                                const plugin::Registry& registry, ExportOptions options) {
    return write_strictly(imported.scene, path, registry, std::move(options), &imported.report);
}

} // namespace restage::io
