// SPDX-License-Identifier: Apache-2.0
// Options of commands that write pictures of 8 bits: how they are developed.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

namespace restage::app {

struct DevelopmentOptions {
    std::string tone; // "" or one of scene::tone_names
    std::optional<float> temperature, tint, vignette, bloom;
    std::string background; // "", black, transparent, or a colour

    bool any() const { return !tone.empty() || temperature || tint || vignette || bloom; }
    scene::Development over(scene::Development) const; // what is given replaces the scene's
};

// --background: what is shown instead of the sky.
void add_background_option(CLI::App& command, DevelopmentOptions& options);
// Into the scene: its sky is then hidden from view.
Result<void> apply_background(const DevelopmentOptions& options, scene::Scene& scene);

// --tone, --white-balance, --tint, --vignette, --bloom. `otherwise`: what they default to, for the help.
void add_development_options(CLI::App& command, DevelopmentOptions& options, const std::string& otherwise);

} // namespace restage::app
