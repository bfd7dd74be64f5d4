// SPDX-License-Identifier: Apache-2.0
#include "io/strict.hpp"

#include <filesystem>
#include <random>
#include <system_error>

namespace restage::io {

namespace fs = std::filesystem;

namespace {

// "" = all was kept.
std::string losses(const Report& report) {
    constexpr std::size_t most = 20;
    std::string list;
    std::size_t lost = 0;
    for (const ReportEntry& entry : report.entries)
        if (entry.fate != RESTAGE_KEPT && ++lost <= most) list += "\n  " + to_string(entry);
    if (lost == 0) return "";
    if (lost > most) list += "\n  and " + std::to_string(lost - most) + " more";
    return std::to_string(lost) + (lost == 1 ? " thing is not kept:" : " things are not kept:") + list;
}

} // namespace

Result<> refuse_losses(const Report& report, const std::string& path) {
    const std::string list = losses(report);
    return list.empty() ? Result<>() : fail(path + ": refused, since reading is strict: " + list);
}

Result<Report> export_strictly(const scene::Scene& scene, const std::string& path, const plugin::Registry& registry,
                               ExportOptions options) {
    RESTAGE_TRY(const plugin::ExporterEntry chosen, find_exporter(path, options.format, registry));
    options.format = chosen.table->format;
    std::error_code code;
    const fs::path folder =
        fs::temp_directory_path(code) / ("restage-export-" + std::to_string(std::random_device{}()));
    if (code || !fs::create_directory(folder, code))
        return fail("no temporary folder can be made: " + folder.string() + ": " + code.message());
    const auto tried = export_scene(scene, (folder / fs::path(path).filename()).string(), registry, options);
    fs::remove_all(folder, code);
    if (!tried) return fail(tried.error().message);
    if (const std::string list = losses(*tried); !list.empty())
        return fail(path + ": not written, since writing is strict: " + list);
    return export_scene(scene, path, registry, options);
}

} // namespace restage::io
