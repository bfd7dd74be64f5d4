// SPDX-License-Identifier: Apache-2.0
#include "document/recovery.hpp"

#include "base/file.hpp"
#include "base/json.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#if !defined(_WIN32)
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#else
#include <process.h>
#endif

namespace restage::document {

namespace fs = std::filesystem;

namespace {

constexpr double first_after = 3; // delay from a document's first edit to its first autosave [s]

long process_id() {
#if defined(_WIN32)
    return _getpid();
#else
    return getpid();
#endif
}

// A lock that the system releases with the process, however it ends. -1: held by another process, or unsupported.
int take_lock([[maybe_unused]] const fs::path& path) {
#if defined(_WIN32)
    return 0; // this process's files are recognized by name alone
#else
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    if (file >= 0) close(file);
    return -1;
#endif
}

void drop_lock([[maybe_unused]] int lock) {
#if !defined(_WIN32)
    if (lock >= 0) close(lock);
#endif
}

fs::path lock_of(fs::path file) { return file.replace_extension(".lock"); }

std::string local_time(std::time_t time) {
    std::tm parts{};
#if defined(_WIN32)
    localtime_s(&parts, &time);
#else
    localtime_r(&time, &parts);
#endif
    char text[32];
    return std::string(text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts));
}

} // namespace

Autosave::~Autosave() {
    if (thread_.joinable()) thread_.join();
    drop_lock(lock_);
}

void Autosave::update(const Session& session, double now) {
    if (!session.modified()) {
        if (waiting_ || !file_.empty()) forget();
        return;
    }
    if (session.version() == written_) return;
    if (!waiting_) {
        waiting_ = true;
        due_ = file_.empty() ? now + std::min(every_, first_after) : std::max(due_, now + every_);
    }
    if (now >= due_) start(session, now);
}

void Autosave::write_now(const Session& session, double now) {
    start(session, now);
    if (thread_.joinable()) thread_.join();
}

void Autosave::start(const Session& session, double now) {
    if (thread_.joinable()) thread_.join();
    waiting_ = false;
    due_ = now + every_;
    written_ = session.version();
    const std::time_t time = std::time(nullptr);
    if (file_.empty()) {
        std::error_code ignored; // writing reports the problem
        fs::create_directories(folder_, ignored);
        const std::string name = std::to_string(process_id()) + "-" + std::to_string(time);
        file_ = folder_ / (name + std::string(project_extension));
        lock_path_ = folder_ / (name + ".lock");
        lock_ = take_lock(lock_path_);
    }
    const fs::path path = session.path();
    std::string text = session.recovery_text({{"pid", std::to_string(process_id())},
                                              {"name", path.empty() ? "untitled" : path.filename().string()},
                                              {"path", session.path()},
                                              {"base", session.base().file},
                                              {"time", local_time(time)},
                                              {"changes", std::to_string(session.history().position())}});
    thread_ = std::thread([this, file = file_, text = std::move(text)] {
        if (const auto written = write_file_atomic(file, text); !written) {
            std::lock_guard lock(mutex_);
            problem_ = "Autosave failed: " + written.error().message;
        }
    });
}

void Autosave::forget() {
    if (thread_.joinable()) thread_.join();
    waiting_ = false;
    written_ = 0;
    if (file_.empty()) return;
    std::error_code ignored;
    fs::remove(file_, ignored);
    fs::remove(lock_path_, ignored);
    drop_lock(std::exchange(lock_, -1));
    file_.clear();
}

std::string Autosave::take_problem() {
    std::lock_guard lock(mutex_);
    return std::exchange(problem_, {});
}

std::vector<Recoverable> find_recoverable(const fs::path& folder) {
    struct Found {
        fs::file_time_type time;
        Recoverable what;
    };
    std::vector<Found> found;
    std::error_code code;
    for (const auto& entry : fs::directory_iterator(folder, code)) {
        if (!is_project(entry.path())) continue;
        // A process that holds the lock is alive, and takes care of its file itself.
        std::error_code none;
        if (fs::exists(lock_of(entry.path()), none)) {
            const int lock = take_lock(lock_of(entry.path()));
            if (lock < 0) continue;
            drop_lock(lock);
        }
        const auto text = read_file(entry.path());
        const auto j = text ? parse_json<nlohmann::json>(*text).value_or(nlohmann::json()) : nlohmann::json();
        const auto note = j.is_object() && j.contains("recovery") ? j["recovery"] : nlohmann::json::object();
        const auto value = [&](const char* key) {
            return note.contains(key) && note[key].is_string() ? note[key].get<std::string>() : std::string();
        };
        found.push_back({entry.last_write_time(none),
                         {.file = entry.path(),
                          .name = value("name").empty() ? entry.path().filename().string() : value("name"),
                          .base = value("base"),
                          .time = value("time"),
                          .changes = value("changes")}});
    }
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.time > b.time; });
    std::vector<Recoverable> result;
    for (Found& f : found)
        result.push_back(std::move(f.what));
    return result;
}

void discard_recoverable(const Recoverable& what) {
    std::error_code ignored;
    fs::remove(what.file, ignored);
    fs::remove(lock_of(what.file), ignored);
}

} // namespace restage::document
