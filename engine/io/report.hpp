// SPDX-License-Identifier: Apache-2.0
// What an import or export did to each item in a file: kept, approximated or dropped, with its place and reason.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::io {

enum class Fate : std::uint8_t { kept, approximated, dropped };

struct ReportEntry {
    Fate fate = Fate::kept;
    std::string file;       // "" if not about a place in a file
    std::uint32_t line = 0; // 0 = the whole file
    std::string what, note; // 'material "oak"', 'bump map dropped'
    bool operator==(const ReportEntry&) const = default;
};

struct Report {
    std::vector<ReportEntry> entries;

    void add(Fate fate, std::string what, std::string note, std::string file = {}, std::uint32_t line = 0) {
        entries.push_back({fate, std::move(file), line, std::move(what), std::move(note)});
    }
    std::size_t count(Fate fate) const {
        std::size_t n = 0;
        for (const ReportEntry& entry : entries)
            n += entry.fate == fate;
        return n;
    }
};

inline const char* to_string(Fate fate) {
    return fate == Fate::kept ? "kept" : fate == Fate::approximated ? "approximated" : "dropped";
}
// "scene.pbrt:12: dropped: light "sun": not known"
std::string to_string(const ReportEntry&);

// [worker] done is 0..1; false = stop.
using Progress = std::function<bool(float done, std::string_view what)>;

} // namespace restage::io
