// SPDX-License-Identifier: Apache-2.0
#include "session/isolate.hpp"

#include "base/file.hpp"
#include "base/process.hpp"
#include "base/temporary.hpp"
#include "scene/edit.hpp"
#include "session/project.hpp"
#include "session/session.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace restage::session {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

// A folder of our own for what the child writes; gone at the end.
struct Handover {
    fs::path folder;
    static Result<Handover> create() {
#if defined(_WIN32)
        return fail("reading in a process of its own is not supported on Windows yet");
#else
        RESTAGE_TRY(fs::path folder, make_temporary_folder("restage-import"));
        return Handover(std::move(folder));
#endif
    }
    explicit Handover(fs::path f) : folder(std::move(f)) {}
    Handover(Handover&& other) noexcept : folder(std::exchange(other.folder, {})) {}
    Handover& operator=(Handover&&) = delete;
    ~Handover() {
        std::error_code ignored;
        if (!folder.empty()) fs::remove_all(folder, ignored);
    }
};

std::string report_text(const io::Report& report) {
    json entries = json::array();
    for (const io::ReportEntry& e : report.entries)
        entries.push_back({static_cast<int>(e.fate), e.file, e.line, e.what, e.note});
    return entries.dump(-1, ' ', false, json::error_handler_t::replace);
}

io::Report read_report(const std::string& text) {
    io::Report report;
    const json entries = json::parse(text, nullptr, false);
    if (!entries.is_array()) return report;
    for (const json& e : entries)
        if (e.is_array() && e.size() == 5 && e[0].is_number_integer() && e[2].is_number_unsigned() &&
            e[1].is_string() && e[3].is_string() && e[4].is_string())
            report.add(static_cast<RestageFate>(std::clamp(e[0].get<int>(), 0, 2)), e[3].get<std::string>(),
                       e[4].get<std::string>(), e[1].get<std::string>(), e[2].get<std::uint32_t>());
    return report;
}

} // namespace

Result<> import_child(const std::string& path, const std::string& out, const plugin::Registry& registry) {
    io::ImportOptions options;
    options.read_images = false; // they are not the importer's; who asked reads them
    options.progress = [](float done, std::string_view what) {
        fmt::print("{:.4f} {}\n", done, what);
        std::fflush(stdout);
        return true;
    };
    RESTAGE_TRY(io::ImportedScene imported, io::import_scene(path, registry, options));
    const std::map<std::string, std::string> note{
        {"importer", imported.importer}, {"format", imported.scene.format}, {"report", report_text(imported.report)},
        {"unexposed", imported.unexposed ? "yes" : "no"}};
    const Base nothing;
    const DataSources none;
    return write_file_atomic(
        out, project_text({.base = nothing, .scene = imported.scene, .sources = none, .note = &note}, {}));
}

Result<io::ImportedScene> import_isolated(const std::string& path, const plugin::Registry& registry,
                                          const IsolateOptions& options, const io::Progress& progress) {
    RESTAGE_TRY(const Handover handover, Handover::create());
    const fs::path out = handover.folder / "scene.restage";
    std::atomic<bool> cancel{false};
    Process child;
    child.argv = {options.program.string()};
    child.argv.insert(child.argv.end(), options.arguments.begin(), options.arguments.end());
    for (const std::string& argument : {std::string("import-child"), path, out.string()})
        child.argv.push_back(argument);
    child.time_limit = options.time_limit;
    child.memory_limit = options.memory_limit;
    child.cancel = &cancel;
    child.on_out = [&](std::string_view line) {
        float done = 0;
        const char* end = std::from_chars(line.data(), line.data() + line.size(), done).ptr;
        line.remove_prefix(static_cast<std::size_t>(end - line.data()));
        if (line.starts_with(' ')) line.remove_prefix(1);
        if (progress && !progress(0.9f * done, line)) cancel = true;
    };
    RESTAGE_TRY(const ProcessOutcome outcome, run_process(child));
    if (outcome.end == ProcessEnd::cancelled) return fail(path + ": stopped on request");
    if (!outcome.ok()) {
        if (outcome.end == ProcessEnd::exited && outcome.code == 1) { // it could say why
            const auto at = outcome.err.rfind("error: ");
            std::string why = at == std::string::npos ? outcome.err : outcome.err.substr(at + 7);
            while (!why.empty() && why.back() == '\n')
                why.pop_back();
            if (!why.empty()) return fail(why);
        }
        return fail(path + ": reading it ended with " + outcome.what + "; nothing of it was taken");
    }
    RESTAGE_TRY(const Document document, read_project(out.string(), registry));
    io::ImportedScene imported;
    scene::apply(imported.scene, document.changes);
    const auto noted = [&](const char* key) {
        const auto it = document.note.find(key);
        return it == document.note.end() ? std::string() : it->second;
    };
    imported.importer = noted("importer");
    imported.scene.format = noted("format");
    imported.unexposed = noted("unexposed") == "yes";
    imported.report = read_report(noted("report"));
    for (const io::ReportEntry& entry : document.report.entries)
        imported.report.entries.push_back(entry);
    if (progress) progress(1, "done");
    return imported;
}

} // namespace restage::session
