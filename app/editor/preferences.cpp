// SPDX-License-Identifier: Apache-2.0
#include "preferences.hpp"

#include "base/file.hpp"
#include "base/json.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace restage::editor {

namespace {

std::filesystem::path file_in(const std::filesystem::path& config_dir) { return config_dir / "preferences.json"; }

std::array<std::pair<const char*, bool*>, 4> snap_targets(SnapTo& to) {
    return {{{"grid", &to.grid}, {"vertex", &to.vertex}, {"surface", &to.surface}, {"wall", &to.wall}}};
}

} // namespace

Preferences read_preferences(const std::filesystem::path& config_dir) {
    Preferences preferences;
    if (config_dir.empty()) return preferences;
    const auto text = read_file(file_in(config_dir));
    const auto j = text ? parse_json<nlohmann::json>(*text).value_or(nlohmann::json()) : nlohmann::json();
    if (!j.is_object()) return preferences;
    if (const auto seen = j.find("hint_seen"); seen != j.end() && seen->is_boolean()) preferences.hint_seen = *seen;
    if (const auto whole = j.find("whole_things"); whole != j.end() && whole->is_boolean())
        preferences.whole_things = *whole;
    if (const auto collide = j.find("collide"); collide != j.end() && collide->is_boolean())
        preferences.collide = *collide;
    if (const auto keys = j.find("keys"); keys != j.end() && *keys == "blender") preferences.keys = KeyPreset::blender;
    if (const auto theme = j.find("theme"); theme != j.end() && *theme == "light") preferences.theme = Theme::light;
    const auto step = [&](const char* key, float& value, float most) {
        if (const auto found = j.find(key); found != j.end() && found->is_number())
            if (const double given = *found; given > 0 && given <= double(most)) value = float(given);
    };
    step("snap_move", preferences.snap_move, 1e6f);
    step("snap_angle", preferences.snap_angle, 180);
    step("snap_scale", preferences.snap_scale, 100);
    if (const auto to = j.find("snap_to"); to != j.end() && to->is_array())
        for (const auto& [name, on] : snap_targets(preferences.snap_to))
            *on = std::ranges::find(*to, name) != to->end();
    if (const auto most = j.find("history_mib"); most != j.end() && most->is_number_integer())
        preferences.history_mib = std::clamp(most->get<int>(), 16, 65536);
    if (const auto name = j.find("denoiser"); name != j.end() && name->is_string()) preferences.denoiser = *name;
    return preferences;
}

void write_preferences(const std::filesystem::path& config_dir, const Preferences& preferences) {
    if (config_dir.empty()) return;
    std::vector<std::string> to;
    SnapTo snap_to = preferences.snap_to;
    for (const auto& [name, on] : snap_targets(snap_to))
        if (*on) to.emplace_back(name);
    const nlohmann::json j{{"hint_seen", preferences.hint_seen},
                           {"whole_things", preferences.whole_things},
                           {"collide", preferences.collide},
                           {"keys", preferences.keys == KeyPreset::blender ? "blender" : "standard"},
                           {"theme", preferences.theme == Theme::light ? "light" : "dark"},
                           {"snap_move", preferences.snap_move},
                           {"snap_angle", preferences.snap_angle},
                           {"snap_scale", preferences.snap_scale},
                           {"snap_to", to},
                           {"history_mib", preferences.history_mib},
                           {"denoiser", preferences.denoiser}};
    // Failing to save preferences is not worth a message.
    (void)write_file_atomic(file_in(config_dir), j.dump(1) + "\n");
}

} // namespace restage::editor
