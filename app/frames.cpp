// SPDX-License-Identifier: Apache-2.0
#include "frames.hpp"

#include <fmt/format.h>
#include <charconv>

namespace restage::app {

Result<std::vector<std::uint32_t>> parse_frames(const std::string& text) {
    constexpr std::size_t most = 1000000;
    std::vector<std::uint32_t> frames;
    const char *at = text.data(), *end = at + text.size();
    const auto number = [&](std::uint32_t& x) {
        const auto [to, code] = std::from_chars(at, end, x);
        at = to;
        return code == std::errc();
    };
    const auto is = [&](char c) {
        if (at == end || *at != c) return false;
        ++at;
        return true;
    };
    do {
        std::uint32_t first = 0, step = 1;
        bool good = number(first);
        std::uint32_t last = first;
        if (good && is('-')) good = number(last) && last >= first && (!is('x') || (number(step) && step > 0));
        if (!good || (at < end && *at != ','))
            return fail("--frames " + text + ": frames are numbers and ranges, for example 7, 1-24, 1-24x2 or 1-3,9");
        for (std::uint64_t f = first; f <= last; f += step) {
            if (frames.size() == most) return fail("--frames " + text + ": more than a million frames");
            frames.push_back(std::uint32_t(f));
        }
    } while (is(','));
    return frames;
}

std::string frame_path(const std::string& path, std::uint32_t frame) {
    const std::size_t last = path.rfind('#');
    if (last == std::string::npos) return path;
    std::size_t first = last;
    while (first > 0 && path[first - 1] == '#')
        --first;
    return path.substr(0, first) + fmt::format("{:0{}}", frame, last - first + 1) + path.substr(last + 1);
}

} // namespace restage::app
