// SPDX-License-Identifier: Apache-2.0
#include "io/choices.hpp"

#include <string_view>

namespace restage::io {

std::vector<Choices> choices_of(const Report& report) {
    constexpr std::string_view head = "choices \"", between = " | ";
    std::vector<Choices> found;
    for (const ReportEntry& entry : report.entries) {
        if (entry.fate != Fate::kept || !entry.what.starts_with(head) || !entry.what.ends_with('"')) continue;
        Choices choices{.option = entry.what.substr(head.size(), entry.what.size() - head.size() - 1), .values = {}};
        for (std::size_t at = 0; at != std::string::npos;) {
            const std::size_t end = entry.note.find(between, at);
            choices.values.push_back(entry.note.substr(at, end == std::string::npos ? end : end - at));
            at = end == std::string::npos ? end : end + between.size();
        }
        found.push_back(std::move(choices));
    }
    return found;
}

} // namespace restage::io
