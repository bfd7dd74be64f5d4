// SPDX-License-Identifier: Apache-2.0
#include "preferences.hpp"

#include "base/file.hpp"
#include "base/json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace restage::editor {

namespace {

std::filesystem::path file_in(const std::filesystem::path& config_dir) { return config_dir / "preferences.json"; }

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
    if (const auto keys = j.find("keys"); keys != j.end() && *keys == "blender") preferences.keys = KeyPreset::blender;
    if (const auto theme = j.find("theme"); theme != j.end() && *theme == "light") preferences.theme = Theme::light;
    const auto step = [&](const char* key, float& value, float most) {
        if (const auto found = j.find(key); found != j.end() && found->is_number())
            if (const double given = *found; given > 0 && given <= double(most)) value = float(given);
    };
    step("snap_move", preferences.snap_move, 1e6f);
    step("snap_angle", preferences.snap_angle, 180);
    step("snap_scale", preferences.snap_scale, 100);
    if (const auto most = j.find("history_mib"); most != j.end() && most->is_number_integer())
        preferences.history_mib = std::clamp(most->get<int>(), 16, 65536);
    if (const auto name = j.find("denoiser"); name != j.end() && name->is_string()) preferences.denoiser = *name;
    return preferences;
}

void write_preferences(const std::filesystem::path& config_dir, const Preferences& preferences) {
    if (config_dir.empty()) return;
    const nlohmann::json j{{"hint_seen", preferences.hint_seen},
                           {"whole_things", preferences.whole_things},
                           {"keys", preferences.keys == KeyPreset::blender ? "blender" : "standard"},
                           {"theme", preferences.theme == Theme::light ? "light" : "dark"},
                           {"snap_move", preferences.snap_move},
                           {"snap_angle", preferences.snap_angle},
                           {"snap_scale", preferences.snap_scale},
                           {"history_mib", preferences.history_mib},
                           {"denoiser", preferences.denoiser}};
    // Failing to save preferences is not worth a message.
    (void)write_file_atomic(file_in(config_dir), j.dump(1) + "\n");
}

} // namespace restage::editor
