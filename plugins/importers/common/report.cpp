// SPDX-License-Identifier: Apache-2.0
#include "common/report.hpp"

namespace restage::importing {

void Report::add(RestageFate fate, std::string what, std::string note, std::uint32_t line, std::string file) {
    // The folding key: everything in `what` but quoted names.
    std::string key = std::to_string(fate) + '\n' + note + '\n';
    bool quoted = false;
    for (const char c : what) {
        if (c == '"') quoted = !quoted;
        if (!quoted) key += c;
    }
    if (Line*& known = folded_[key]; known) {
        ++known->count;
    } else {
        lines_.push_back({fate, std::move(what), std::move(note), file.empty() ? file_ : std::move(file), line, 1});
        known = &lines_.back();
    }
}

void Report::flush() {
    for (const Line& line : lines_) {
        std::string note = line.note;
        if (line.count > 1)
            note += (note.empty() ? "(" : " (") + std::to_string(line.count) + " times; this is the first)";
        out_.report(out_.ctx, line.fate, line.file.c_str(), line.line, line.what.c_str(), note.c_str());
    }
    lines_.clear();
    folded_.clear();
}

std::string quote(const std::string& text) { return '"' + text + '"'; }

void tell_file_read(const RestageSceneWriter1& out, const std::string& path) {
    out.report(out.ctx, RESTAGE_KEPT, path.c_str(), 0, "file", "read");
}

} // namespace restage::importing
