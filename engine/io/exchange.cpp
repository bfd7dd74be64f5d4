// SPDX-License-Identifier: Apache-2.0
#include "io/exchange.hpp"

#include <restage/scene_io.h>

#include <cstring>

namespace restage::io {

namespace {

constexpr std::pair<scene::FilterKind, const char*> filters[] = {{scene::FilterKind::box, "box"},
                                                                 {scene::FilterKind::triangle, "triangle"},
                                                                 {scene::FilterKind::gaussian, "gaussian"},
                                                                 {scene::FilterKind::mitchell, "mitchell"},
                                                                 {scene::FilterKind::sinc, "sinc"}};

} // namespace

void Exchange::tell(int fate, const char* what, const char* note, const char* file, std::uint32_t line) {
    const bool known = fate >= RESTAGE_KEPT && fate <= RESTAGE_DROPPED;
    report.add(known ? static_cast<Fate>(fate) : Fate::dropped, text(what), text(note), text(file), line);
}

void Exchange::raise(const char* file, std::uint32_t line, std::uint32_t column, const char* message) {
    if (!error_.empty()) return;
    std::string place = text(file);
    if (line) place += ":" + std::to_string(line) + (column ? ":" + std::to_string(column) : "");
    error_ = place + (place.empty() ? "" : ": ") + text(message);
}

bool Exchange::proceed(float done, const char* what) {
    if (cancelled_)
        ++unheard_;
    else if (progress_ && !progress_(done, text(what)))
        cancelled_ = true;
    return !cancelled_;
}

std::string Exchange::how_stopped() const {
    constexpr std::size_t patience = 100; // several threads may be calling
    return ": stopped on request" +
           (unheard_ <= patience ? "" : "; the plugin continued, with " + std::to_string(unheard_) + " more calls");
}

glm::dmat4 matrix(const double m[16]) {
    glm::dmat4 result;
    for (int i = 0; i < 16; ++i)
        result[i / 4][i % 4] = m[i];
    return result;
}

void copy(const glm::dmat4& from, double to[16]) { std::memcpy(to, &from[0][0], 16 * sizeof(double)); }
void copy(const glm::vec3& from, float to[3]) { std::memcpy(to, &from.x, 3 * sizeof(float)); }

scene::FilterKind filter_kind(const std::string& name) {
    for (const auto& [kind, its_name] : filters)
        if (name == its_name) return kind;
    return scene::FilterKind::box;
}

const char* filter_name(scene::FilterKind kind) {
    for (const auto& [its_kind, name] : filters)
        if (kind == its_kind) return name;
    return "box";
}

} // namespace restage::io
