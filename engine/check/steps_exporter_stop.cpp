// SPDX-License-Identifier: Apache-2.0
// Exporters that are cancelled, cannot write, or run a hundred times: an existing file is kept, and nothing leaks.
#include "check/export_scenes.hpp"
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "io/export.hpp"

#include <fmt/format.h>
#include <algorithm>
#if !defined(_WIN32)
#include <sys/resource.h>
#include <csignal>
#endif

namespace restage::check {

namespace fs = std::filesystem;

namespace {

constexpr const char* old_text = "what was there before\n";

// An export over an existing file.
struct Place {
    Subject& s;
    const scene::Scene scene = everything_scene();
    const TemporaryFolder folder;
    const fs::path file = folder.path / ("scene." + s.exporter->extensions[0]);
    io::ExportOptions options{.progress = {}, .format = s.exporter->format, .values = {}};

    Result<io::Report> save(const fs::path& path, const std::string& what) {
        s.doing("save() of a scene with every kind of thing, " + what);
        auto done = io::export_scene(scene, path.string(), s.registry(), options);
        s.alive();
        return done;
    }
    Result<> put_old_file() const {
        std::error_code ignored;
        fs::remove_all(folder.path, ignored);
        fs::create_directories(folder.path, ignored);
        return write_scratch(file, old_text);
    }
    // "" or what is wrong after a save() that failed.
    std::string after(const std::string& what) const {
        bool stays = false;
        for (const auto& [name, text] : contents_of(folder.path)) {
            if (name == file.filename().string())
                stays = text == old_text;
            else if (name.find('/') == std::string::npos)
                return what + ": it leaves " + name + " next to the file";
        }
        return stays ? "" : what + ": the existing file is gone or changed";
    }
    // Likewise for one that should have been refused.
    std::string refused(const Result<io::Report>& done, const std::string& what) const {
        if (done) return what + ": save() returns 1";
        if (done.error().message.ends_with("failed without giving a reason"))
            return what + ": save() returns 0, and error() was not called";
        return "";
    }
};

// Limits the size of files that this process writes, as on a full disk.
class FullDisk {
  public:
#if defined(_WIN32)
    explicit FullDisk(std::size_t) {}
    static constexpr bool possible = false;
#else
    explicit FullDisk(std::size_t bytes) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &limit_);
        rlimit small = limit_;
        small.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &limit_);
        std::signal(SIGXFSZ, before_);
    }
    static constexpr bool possible = true;
#endif
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

#if !defined(_WIN32)
  private:
    void (*before_)(int);
    rlimit limit_{};
#endif
};

} // namespace

Result<StepResult> check_write_stop(Subject& s) {
    Place place{s};
    std::size_t calls = 0, stop_at = ~std::size_t{0}, stops = 0;
    place.options.progress = [&](float, std::string_view) { return ++calls < stop_at; };
    RESTAGE_CHECK(place.put_old_file());
    RESTAGE_CHECK(place.save(place.file, "to completion"));
    const std::size_t all = calls;
    for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(4096, 16), 1)) {
        const std::string what = fmt::format("stopped at call {} of {} of progress()", k, all);
        RESTAGE_CHECK(place.put_old_file());
        calls = 0, stop_at = k, ++stops;
        if (place.save(place.file, what)) return StepResult::failed(what + ", save() continues");
        if (const std::string problem = place.after(what); !problem.empty()) return StepResult::failed(problem);
    }
    return StepResult::passed({{"calls of progress()", double(all)}, {"stopped", double(stops)}},
                              all == 0 ? "it never calls progress(), so it cannot be stopped" : "");
}

Result<StepResult> check_write_place(Subject& s) {
    Place place{s};
    RESTAGE_CHECK(place.put_old_file());
    RESTAGE_CHECK(place.save(place.file, "to completion"));
    std::size_t largest = 0;
    for (const auto& [name, text] : contents_of(place.folder.path))
        largest = std::max(largest, text.size());
    RESTAGE_CHECK(place.put_old_file());
    std::string what = "to a path that leads through a file";
    std::string problem = place.refused(place.save(place.file / place.file.filename(), what), what);
    if (problem.empty()) problem = place.after(what);
    if (!problem.empty()) return StepResult::failed(problem);

    what = "to a path that is a folder";
    std::error_code code;
    fs::remove(place.file, code);
    fs::create_directories(place.file / "not empty", code);
    problem = place.refused(place.save(place.file, what), what);
    if (problem.empty() && !fs::is_directory(place.file / "not empty", code)) problem = what + ": the folder is gone";
    if (!problem.empty()) return StepResult::failed(problem);

    std::string not_done = "no file it writes is long enough to simulate a full disk";
    if (FullDisk::possible && largest > 1) {
        not_done.clear();
        what = "to a full disk";
        RESTAGE_CHECK(place.put_old_file());
        // Longer than the old file's text, which put_old_file() has just written.
        const auto done = [&] {
            const FullDisk full(largest / 2);
            return place.save(place.file, what);
        }();
        problem = place.refused(done, what);
        if (problem.empty()) problem = place.after(what);
        if (!problem.empty()) return StepResult::failed(problem);
    }
    return StepResult::passed({{"longest file", double(largest), "bytes"}}, not_done);
}

Result<StepResult> check_write_leaks(Subject& s) {
    Place place{s};
    std::size_t run = 0;
    const io::Progress stopping = [calls = std::size_t{0}, &run](float, std::string_view) mutable {
        return calls++ % 4 < run % 4;
    };
    return check_nothing_left("save(), completed, cancelled and refused,", [&]() -> Result<> {
        RESTAGE_CHECK(place.put_old_file());
        place.options.progress = {};
        RESTAGE_CHECK(place.save(place.file, "repeatedly"));
        (void)place.save(place.file / "nowhere", "to a path that leads through a file, repeatedly");
        place.options.progress = stopping;
        (void)place.save(place.file, "stopped, repeatedly");
        s.log_lines.clear();
        ++run;
        return {};
    });
}

} // namespace restage::check
