// SPDX-License-Identifier: Apache-2.0
// Recovery: unsaved work is autosaved, a few seconds after a document's first edit and then every minute, as a
// project with absolute paths and a note on its origin; it is removed on a clean exit. Files of dead processes
// can be recovered: live ones hold a lock.
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
    // Files are in `folder`, which is created on demand.
    Autosave(std::filesystem::path folder, double every_seconds) : folder_(std::move(folder)), every_(every_seconds) {}
    ~Autosave(); // the file stays, for recovery
    Autosave(const Autosave&) = delete;
    Autosave& operator=(const Autosave&) = delete;

    // Call often; `now` in seconds. Writes, on its own thread, when there is unsaved work not yet written
    // and it is due; forgets the file when everything is saved.
    void update(const Session& session, double now);
    void write_now(const Session& session, double now); // returns when it is written
    void forget(); // removes the file: all is saved, or discarded
    const std::filesystem::path& file() const { return file_; } // "" = none at present
    std::string take_problem(); // the last write error, returned once

  private:
    void start(const Session& session, double now);

    std::filesystem::path folder_, file_, lock_path_;
    double every_, due_ = 0;
    bool waiting_ = false; // there is unsaved work, to be written at due_
    scene::Version written_ = 0; // the version in the file; 0 = none
    int lock_ = -1;
    std::thread thread_;
    std::mutex mutex_;
    std::string problem_;
};

struct Recoverable {
    std::filesystem::path file;
    std::string name; // of the document: "kitchen.pbrt"
    std::string base; // absolute; "" = a scene that was never saved
    std::string time; // local, when it was written
    std::string changes; // their number
};

// Files left by dead processes, latest first.
std::vector<Recoverable> find_recoverable(const std::filesystem::path& folder);
void discard_recoverable(const Recoverable&);

} // namespace restage::document
