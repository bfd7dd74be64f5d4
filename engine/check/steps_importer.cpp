// SPDX-License-Identifier: Apache-2.0
// Importers: any file gets an answer, not a crash; a file of its own format reads identically twice, and it can be
// cancelled. The valid samples are the files in the plugin's folder with one of its extensions.
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "base/file.hpp"
#include "document/project.hpp"
#include "io/import.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::check {

namespace fs = std::filesystem;

namespace {

// The few smallest, sorted by name.
std::vector<fs::path> samples(const fs::path& folder, const std::vector<std::string>& extensions) {
    std::vector<fs::path> found;
    std::error_code code;
    const auto links = fs::directory_options::follow_directory_symlink; // build trees link to the sources
    for (fs::recursive_directory_iterator it(folder, links, code), end; !code && it != end; it.increment(code)) {
        if (it.depth() >= 3) it.disable_recursion_pending();
        std::error_code ignored;
        std::string extension = it->path().extension().string();
        if (!extension.empty()) extension.erase(0, 1);
        if (it->is_regular_file(ignored) && it->file_size(ignored) <= 1 << 20 &&
            std::find(extensions.begin(), extensions.end(), extension) != extensions.end())
            found.push_back(it->path());
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min<std::size_t>(found.size(), 4));
    return found;
}

// The complete scene, as the text of a project without a base.
std::string all_of(const io::ImportedScene& imported) {
    const document::Base base;
    const document::DataSources sources;
    std::string text = document::project_text({.base = base, .scene = imported.scene, .sources = sources}, {});
    for (const auto& line : imported.report.entries)
        text += io::to_string(line) + "\n";
    return text;
}

struct Loading {
    Subject& s;
    io::ImportOptions options;
    std::size_t loads = 0, accepted = 0;

    explicit Loading(Subject& subject) : s(subject) {
        options.format = s.importer->format;
        options.read_images = false;
    }
    // A sentence if the contract is broken, else "".
    std::string load(const fs::path& file, const std::string& what) {
        s.doing("load() of " + what);
        ++loads;
        const auto loaded = io::import_scene(file.string(), s.registry(), options);
        s.alive();
        accepted += loaded.has_value();
        if (!loaded && loaded.error().message.ends_with("failed without giving a reason"))
            return "load() of " + what + " returns 0, and error() was not called";
        return "";
    }
};

// A folder with copies of the file's neighbours, which it may refer to.
fs::path with_neighbours(const fs::path& file, const fs::path& place) {
    std::error_code code;
    fs::copy(file.parent_path(), place, fs::copy_options::recursive, code);
    fs::create_directories(place, code);
    return place / ("broken" + file.extension().string());
}

} // namespace

Result<StepResult> check_probe(Subject& s) {
    const model::Importer& importer = *s.importer;
    const std::string extension = importer.extensions[0];
    Engine e = s.random("importer");
    std::size_t probed = 0, asked = 0;
    std::string problem;
    const auto ask = [&](const std::string& name, std::string_view head, const std::string& what) {
        s.doing("probe() of " + what);
        const int answer = io::probe(s.importer_entry, name, head);
        s.alive();
        ++asked, probed += answer > 0;
        if (problem.empty() && (answer < 0 || answer > 100))
            problem = fmt::format("probe() of {} returns {}, which is not in 0..100", what, answer);
        return answer;
    };
    for (std::size_t i = 0; i < 200; ++i) {
        const std::string bytes = noise(e, i);
        ask("/nowhere/noise." + extension, bytes, fmt::format("{} bytes of noise", bytes.size()));
    }
    for (const fs::path& file : samples(s.folder, importer.extensions)) {
        RESTAGE_TRY(const std::string text, read_file(file));
        const std::string name = file.filename().string();
        const auto head = std::string_view(text).substr(0, 4096);
        if (ask(file.string(), head, "its " + name) == 0)
            return StepResult::failed("probe() of its own " + name + " returns 0: the file would not be read");
        for (std::size_t k = 0; k < 100; ++k) // an exact allocation, so that memory checkers find overruns
            ask(file.string(), std::string(head.substr(0, k < 40 ? k : e() % (head.size() + 1))),
                "its " + name + " cut short");
    }
    if (!problem.empty()) return StepResult::failed(problem);
    return StepResult::passed({{"heads", double(asked)}, {"claimed as its own", double(probed)}});
}

Result<StepResult> check_read(Subject& s) {
    const TemporaryFolder folder;
    const auto& extensions = s.importer->extensions;
    const auto good = samples(s.folder, extensions);
    Engine e = s.random("read");
    Loading loading(s);
    const std::size_t open_before = open_files();
    std::string problem;
    // The heads of its own files, so that noise gets past the first lines.
    std::vector<std::string> heads{""};
    for (const fs::path& file : good) {
        RESTAGE_TRY(std::string text, read_file(file));
        s.doing("load() of its " + file.filename().string());
        const auto first = io::import_scene(file.string(), s.registry(), loading.options);
        if (!first)
            return StepResult::failed("its own " + file.filename().string() + " is not read: " + first.error().message);
        s.doing("load() of its " + file.filename().string() + " for the second time");
        const auto second = io::import_scene(file.string(), s.registry(), loading.options);
        if (!second || all_of(*first) != all_of(*second))
            return StepResult::failed("reading " + file.filename().string() + " twice gives different scenes");
        heads.push_back(text.substr(0, 64));
        const fs::path bad = with_neighbours(file, folder.path / fmt::format("sample {}", heads.size()));
        for (std::size_t k = 0; k < s.size(160, 48); ++k) {
            RESTAGE_CHECK(write_scratch(bad, broken_version(e, text, k)));
            problem = loading.load(bad, fmt::format("a broken version ({}) of its {}", k, file.filename().string()));
            if (!problem.empty()) return StepResult::failed(problem);
        }
    }
    for (std::size_t k = 0; k < s.size(200, 60); ++k) {
        const fs::path file = folder.path / ("noise." + extensions[k % extensions.size()]);
        const std::string bytes = noise(e, k / 2, heads[k % heads.size()]);
        RESTAGE_CHECK(write_scratch(file, bytes));
        problem = loading.load(file, fmt::format("{} bytes of noise", bytes.size()));
        if (!problem.empty()) return StepResult::failed(problem);
    }
    const std::size_t open_after = open_files();
    if (open_after > open_before + 2)
        return StepResult::failed(fmt::format("{} of {} files remain open", open_after - open_before, loading.loads));
    std::vector<Figure> figures = {{"own files", double(good.size())},
                                   {"broken files and noise", double(loading.loads)},
                                   {"accepted", double(loading.accepted)}};
    return StepResult::passed(
        figures, good.empty()
                     ? "there is no file with its extension in its folder: put a small one into samples/ to have "
                       "it read twice, truncated and altered here"
                     : "");
}

Result<StepResult> check_read_options(Subject& s) {
    const auto good = samples(s.folder, s.importer->extensions);
    if (s.importer->options.empty()) return StepResult::skip("it has no options");
    if (good.empty()) return StepResult::skip("there is no file with its extension in its folder");
    io::ImportOptions options;
    options.format = s.importer->format;
    options.read_images = false;
    std::size_t loads = 0;
    std::string idle;
    for (const model::Param& line : s.importer->options) {
        bool matters = false;
        for (const fs::path& file : good) {
            std::string first;
            for (const scene::Value& value : ends(line)) {
                options.values = {};
                options.values.set(line.id, value);
                const std::string what = fmt::format("{} with {}", file.filename().string(), describe(options.values));
                s.doing("load() of its " + what);
                ++loads;
                const auto loaded = io::import_scene(file.string(), s.registry(), options);
                s.alive();
                if (!loaded) return StepResult::failed("its own " + what + " is not read: " + loaded.error().message);
                const auto again = io::import_scene(file.string(), s.registry(), options);
                if (!again || all_of(*loaded) != all_of(*again))
                    return StepResult::failed("reading " + what + " twice gives different scenes");
                if (first.empty()) first = all_of(*loaded);
                matters = matters || first != all_of(*loaded);
            }
        }
        if (!matters && line.type != model::ParamType::text) idle += (idle.empty() ? "" : ", ") + line.id;
    }
    return StepResult::passed({{"options", double(s.importer->options.size())}, {"loads", double(loads)}},
                              idle.empty() ? "" : "no file of its folder is read differently with: " + idle);
}

Result<StepResult> check_read_cut(Subject& s) {
    const auto good = samples(s.folder, s.importer->extensions);
    if (good.empty()) return StepResult::skip("there is no file with its extension in its folder");
    const TemporaryFolder folder;
    Loading loading(s);
    for (std::size_t i = 0; i < good.size(); ++i) {
        RESTAGE_TRY(const std::string text, read_file(good[i]));
        const fs::path bad = with_neighbours(good[i], folder.path / fmt::format("sample {}", i));
        const std::size_t steps = std::min(text.size(), s.size(400, 60));
        for (std::size_t k = 0; k < steps; ++k) {
            const std::size_t length = k * text.size() / steps;
            RESTAGE_CHECK(write_scratch(bad, std::string_view(text).substr(0, length)));
            const std::string problem = loading.load(bad, fmt::format("the first {} of {} bytes of its {}", length,
                                                                      text.size(), good[i].filename().string()));
            if (!problem.empty()) return StepResult::failed(problem);
        }
    }
    return StepResult::passed({{"truncated files", double(loading.loads)}, {"accepted", double(loading.accepted)}});
}

Result<StepResult> check_read_stop(Subject& s) {
    const auto good = samples(s.folder, s.importer->extensions);
    if (good.empty()) return StepResult::skip("there is no file with its extension in its folder");
    std::size_t calls_in_all = 0, stops = 0;
    for (const fs::path& file : good) {
        std::size_t calls = 0, stop_at = ~std::size_t{0};
        io::ImportOptions options;
        options.format = s.importer->format;
        options.read_images = false;
        options.progress = [&](float, std::string_view) { return ++calls < stop_at; };
        const std::string name = file.filename().string();
        s.doing("load() of its " + name);
        RESTAGE_CHECK(io::import_scene(file.string(), s.registry(), options));
        const std::size_t all = calls;
        calls_in_all += all;
        for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(4096, 16), 1)) {
            calls = 0, stop_at = k, ++stops;
            s.doing(fmt::format("load() of its {}, stopped at call {} of progress()", name, k));
            const auto loaded = io::import_scene(file.string(), s.registry(), options);
            s.alive();
            if (loaded)
                return StepResult::failed(
                    fmt::format("{}: stopped at call {} of progress(), load() continues "
                                "and returns a scene",
                                name, k));
            if (loaded.error().message.find("the plugin continued") != std::string::npos)
                return StepResult::failed(fmt::format("stopped at call {}: {}", k, loaded.error().message));
        }
    }
    return StepResult::passed(
        {{"files", double(good.size())}, {"calls of progress()", double(calls_in_all)}, {"stopped", double(stops)}},
        calls_in_all == 0 ? "it never calls progress(), so it cannot be stopped" : "");
}

Result<StepResult> check_read_leaks(Subject& s) {
    const auto good = samples(s.folder, s.importer->extensions);
    const TemporaryFolder folder;
    io::ImportOptions options;
    options.format = s.importer->format;
    options.read_images = false;
    Jobs none(1);
    options.jobs = &none;
    Engine e = s.random("leaks");
    std::vector<fs::path> bad{folder.path / ("noise." + s.importer->extensions[0])};
    RESTAGE_CHECK(write_scratch(bad[0], noise(e, 30)));
    for (const fs::path& file : good) {
        RESTAGE_TRY(const std::string text, read_file(file));
        bad.push_back(with_neighbours(file, folder.path / fmt::format("sample {}", bad.size())));
        RESTAGE_CHECK(write_scratch(bad.back(), std::string_view(text).substr(0, text.size() * 2 / 3)));
    }
    std::size_t run = 0;
    return check_nothing_left("load(), of good and broken files and cancelled,", [&]() -> Result<> {
        s.doing("load(), repeatedly");
        for (const fs::path& file : good)
            RESTAGE_CHECK(io::import_scene(file.string(), s.registry(), options));
        for (const fs::path& file : bad)
            (void)io::import_scene(file.string(), s.registry(), options);
        io::ImportOptions stopping = options;
        std::size_t calls = 0;
        stopping.progress = [&](float, std::string_view) { return calls++ < run % 3; };
        for (const fs::path& file : good) {
            calls = 0;
            (void)io::import_scene(file.string(), s.registry(), stopping);
        }
        s.log_lines.clear();
        s.alive();
        ++run;
        return {};
    });
}

} // namespace restage::check
