// SPDX-License-Identifier: Apache-2.0
// Recovery: unsaved work is written aside, a few seconds after a document's first edit and every minute then, as a
// project with absolute paths and a note on whose it is; it is gone after a clean end. Files of processes that are no
// more are what can be recovered: a living one holds a lock.
#pragma once

#include "document/session.hpp"

#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace restage::document {

class Autosave { // [main]
  public:
    // Files are in `folder`, which is made when it is needed.
    Autosave(std::filesystem::path folder, double every_seconds) : folder_(std::move(folder)), every_(every_seconds) {}
    ~Autosave(); // what is written stays, to be recovered
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    // Call often; `now` in seconds. Writes, on a thread of its own, when there is unsaved work that is not written yet
    // and its time has come; forgets the file when everything is saved.
    void update(const Session& session, double now);
    void write_now(const Session& session, double now); // returns when it is written
    void forget(); // what is written goes: all is saved, or given up
    const std::filesystem::path& file() const { return file_; } // "" = nothing is written now
    std::string take_problem(); // what went wrong in writing, once

  private:
    void start(const Session& session, double now);

    std::filesystem::path folder_, file_, lock_path_;
    double every_, due_ = 0;
    bool waiting_ = false; // unsaved work is there, and due_ says when it is written
    scene::Version written_ = 0; // what the file holds; 0 = nothing
    int lock_ = -1;
    std::thread thread_;
    std::mutex mutex_;
    std::string problem_;
};

struct Recoverable {
    std::filesystem::path file;
    std::string name; // of what was edited: "kitchen.pbrt"
    std::string base; // absolute; "" = a scene that was never saved
    std::string time; // local, when it was written
    std::string changes; // how many
};

// What dead processes left, the latest first.
std::vector<Recoverable> find_recoverable(const std::filesystem::path& folder);
void discard_recoverable(const Recoverable&);

} // namespace restage::document
