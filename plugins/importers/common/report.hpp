// SPDX-License-Identifier: Apache-2.0
// The import report of one file. Lines that repeat a note about the same kind of thing are folded into the first.
#pragma once

#include <restage/scene_io.h>
#include <cstdint>
#include <deque>
#include <map>
#include <string>

namespace restage::importing {

class Report {
  public:
    Report(const RestageSceneWriter1& out, std::string file) : out_(out), file_(std::move(file)) {}
    ~Report() { flush(); }
    Report(const Report&) = delete;
    Report& operator=(const Report&) = delete;

    void add(RestageFate, std::string what, std::string note, std::uint32_t line = 0, std::string file = {});
    void kept(std::string what, std::string note, std::uint32_t line = 0, std::string file = {}) {
        add(RESTAGE_KEPT, std::move(what), std::move(note), line, std::move(file));
    }
    void approximated(std::string what, std::string note, std::uint32_t line = 0, std::string file = {}) {
        add(RESTAGE_APPROXIMATED, std::move(what), std::move(note), line, std::move(file));
    }
    void dropped(std::string what, std::string note, std::uint32_t line = 0, std::string file = {}) {
        add(RESTAGE_DROPPED, std::move(what), std::move(note), line, std::move(file));
    }
    void flush();

  private:
    struct Line {
        RestageFate fate;
        std::string what, note, file;
        std::uint32_t line;
        std::size_t count;
    };
    const RestageSceneWriter1& out_;
    std::string file_;
    std::deque<Line> lines_;
    std::map<std::string, Line*> folded_;
};

std::string quote(const std::string& text); // "text", for messages

// Lists a further file that the import read (docs/plugins.md). Not for pictures that the host reads and meshes'
// source_file, which the scene names.
void tell_file_read(const RestageSceneWriter1& out, const std::string& path);

} // namespace restage::importing
