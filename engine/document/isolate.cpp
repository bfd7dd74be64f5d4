// SPDX-License-Identifier: Apache-2.0
#include "document/isolate.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "base/process.hpp"
#include "base/temporary.hpp"
#include "document/project.hpp"
#include "document/session.hpp"
#include "io/image_handover.hpp"
#include "io/options.hpp"
#include "scene/edit.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

namespace restage::document {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

// A private folder for the child's output; removed at the end.
struct Handover {
    fs::path folder;
    static Result<Handover> create() {
#if defined(_WIN32)
        return fail("reading in a separate process is not supported on Windows yet");
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
    const json entries = parse_json<json>(text).value_or(json());
    if (!entries.is_array()) return report;
    for (const json& e : entries)
        if (e.is_array() && e.size() == 5 && e[0].is_number_integer() && e[2].is_number_unsigned() &&
            e[1].is_string() && e[3].is_string() && e[4].is_string())
            report.add(static_cast<io::Fate>(std::clamp(e[0].get<int>(), 0, 2)), e[3].get<std::string>(),
                       e[4].get<std::string>(), e[1].get<std::string>(), e[2].get<std::uint32_t>());
    return report;
}

// Pictures that the scene names by path: decoded here, in the child, within its limits.
using PictureKey = std::tuple<std::string, int, float>;
constexpr std::uint64_t most_picture_bytes = std::uint64_t{16} << 30; // total handed over for one scene

PictureKey key_of(const scene::Image& image) { return {image.path, static_cast<int>(image.encoding), image.gamma}; }

fs::path pictures_folder(const fs::path& out) { return out.parent_path() / "pictures"; }

// "[[path, encoding, gamma, file], ...]"; a problem with one becomes a report line.
Result<std::string> hand_over_pictures(io::ImportedScene& imported, const fs::path& out) {
    struct Job {
        scene::Image image;
        std::string file, problem, warning;
    };
    std::vector<Job> work;
    imported.scene.images.each([&](scene::Id<scene::Image> id, const scene::Image& image) {
        if (!image.data && !image.path.empty()) work.push_back({image, std::to_string(id.value), {}, {}});
    });
    std::error_code code;
    fs::create_directories(pictures_folder(out), code);
    if (code) return fail(pictures_folder(out).string() + ": cannot be created: " + code.message());
    std::atomic<std::uint64_t> total{0};
    Jobs().parallel_for(work.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            Job& job = work[i];
            const fs::path file = pictures_folder(out) / job.file;
            const auto size = io::hand_over_image(job.image.path, file, &job.warning);
            if (!size) {
                job.problem = size.error().message;
                continue;
            }
            const std::uint64_t sum = total += *size;
            if (sum > most_picture_bytes) {
                job.problem = job.image.path + ": the scene's pictures take more than 16 GiB";
                std::error_code ignored;
                fs::remove(file, ignored);
            }
        }
    });
    json list = json::array();
    for (const Job& job : work) {
        const std::string who = "image \"" + job.image.name + "\"";
        const bool told = std::ranges::any_of(imported.report.entries, [&](const io::ReportEntry& entry) {
            return entry.fate == io::Fate::dropped && entry.note.ends_with(": " + job.image.path);
        });
        if (!job.problem.empty() && !told)
            imported.report.add(io::Fate::dropped, who, job.problem, job.image.path);
        else if (!job.warning.empty())
            imported.report.add(io::Fate::approximated, who, job.warning, job.image.path);
        if (job.problem.empty())
            list.push_back({job.image.path, static_cast<int>(job.image.encoding), job.image.gamma, job.file});
    }
    return list.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::map<PictureKey, std::string> read_picture_list(const std::string& text) {
    std::map<PictureKey, std::string> files;
    const json list = parse_json<json>(text).value_or(json());
    for (const json& e : list)
        if (e.is_array() && e.size() == 4 && e[0].is_string() && e[1].is_number_integer() && e[2].is_number() &&
            e[3].is_string() && e[3].get<std::string>().find('/') == std::string::npos)
            files[{e[0].get<std::string>(), e[1].get<int>(), e[2].get<float>()}] = e[3].get<std::string>();
    return files;
}

} // namespace

Result<> import_child(const std::string& path, const std::string& out, const plugin::Registry& registry,
                      io::ImportOptions options) {
    options.read_images = false; // the child hands them over one by one
    options.progress = [](float done, std::string_view what) {
        fmt::print("{:.4f} {}\n", done, what);
        std::fflush(stdout);
        return true;
    };
    RESTAGE_TRY(io::ImportedScene imported, io::import_scene(path, registry, options));
    options.progress(0.95f, "images");
    RESTAGE_TRY(const std::string pictures, hand_over_pictures(imported, out));
    RESTAGE_CHECK(write_file_atomic(pictures_folder(out) / "list", pictures));
    const std::map<std::string, std::string> note{{"importer", imported.importer},
                                                  {"format", imported.scene.format},
                                                  {"report", report_text(imported.report)},
                                                  {"unexposed", imported.unexposed ? "yes" : "no"}};
    const Base nothing;
    const DataSources none;
    return write_file_atomic(
        out, project_text({.base = nothing, .scene = imported.scene, .sources = none, .note = &note}, {}));
}

Result<io::ImportedScene> import_isolated(const std::string& path, const plugin::Registry& registry,
                                          const IsolateOptions& options, const io::ImportOptions& reading_file) {
    const io::Progress& progress = reading_file.progress;
    RESTAGE_TRY(const Handover handover, Handover::create());
    const fs::path out = handover.folder / "scene.restage";
    std::atomic<bool> cancel{false};
    Process child;
    child.argv = {options.program.string()};
    child.argv.insert(child.argv.end(), options.arguments.begin(), options.arguments.end());
    for (const std::string& argument : {std::string("import-child"), path, out.string()})
        child.argv.push_back(argument);
    if (!reading_file.format.empty()) child.argv.insert(child.argv.end(), {"--format", reading_file.format});
    for (const auto& [id, value] : reading_file.values.entries())
        child.argv.push_back("--set=" + id + "=" + io::option_text(value));
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
    if (outcome.end == ProcessEnd::cancelled) return cancelled(path + ": stopped on request");
    if (!outcome.ok()) {
        if (outcome.end == ProcessEnd::exited && outcome.code == 1) { // it has reported why
            const auto at = outcome.err.rfind("error: ");
            std::string why = at == std::string::npos ? outcome.err : outcome.err.substr(at + 7);
            while (!why.empty() && why.back() == '\n')
                why.pop_back();
            if (!why.empty()) return fail(why);
        }
        return fail(path + ": reading it ended with " + outcome.what + "; nothing was imported");
    }
    ReadOptions reading;
    RESTAGE_TRY(const std::string list, read_file(pictures_folder(out) / "list"));
    const std::map<PictureKey, std::string> pictures = read_picture_list(list);
    reading.pixels = [&](const scene::Image& image) -> Result<std::shared_ptr<const scene::PixelData>> {
        const auto found = pictures.find(key_of(image));
        if (found == pictures.end()) return nullptr; // the child has reported why
        RESTAGE_TRY(scene::PixelData pixels,
                    io::take_over_image(pictures_folder(out) / found->second, image.encoding, image.gamma));
        return std::make_shared<const scene::PixelData>(std::move(pixels));
    };
    RESTAGE_TRY(const Document document, read_project(out.string(), registry, reading));
    io::ImportedScene imported;
    scene::apply(imported.scene, document.changes);
    const auto noted = [&](const char* key) {
        const auto it = document.note.find(key);
        return it == document.note.end() ? std::string() : it->second;
    };
    imported.importer = noted("importer");
    imported.scene.format = noted("format");
    if (const auto importer = registry.find_importer(imported.importer)) {
        RESTAGE_TRY(imported.options, io::fitting_options(*importer->table, reading_file.values));
    }
    imported.unexposed = noted("unexposed") == "yes";
    imported.report = read_report(noted("report"));
    for (const io::ReportEntry& entry : document.report.entries)
        imported.report.entries.push_back(entry);
    if (progress) progress(1, "done");
    return imported;
}

} // namespace restage::document
