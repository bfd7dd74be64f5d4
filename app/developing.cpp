// SPDX-License-Identifier: Apache-2.0
#include "developing.hpp"

#include "scene/color_temperature.hpp"
#include "scene/development.hpp"

#include <charconv>
#include <utility>

namespace restage::app {

scene::Development DevelopmentOptions::over(scene::Development d) const {
    d.tone = scene::find_tone(tone).value_or(d.tone);
    d.temperature = temperature.value_or(d.temperature);
    d.tint = tint.value_or(d.tint);
    d.vignette = vignette.value_or(d.vignette);
    d.bloom = bloom.value_or(d.bloom);
    return d;
}

void add_development_options(CLI::App& command, DevelopmentOptions& o, const std::string& otherwise) {
    command.add_option("--tone", o.tone, "Tone curve of a .png or .jpg (default: " + otherwise + ")")
        ->check(CLI::IsMember(std::vector<std::string>(scene::tone_names.begin(), scene::tone_names.end())));
    command
        .add_option("--white-balance", o.temperature,
                    "Show light of this colour temperature as white in a .png or .jpg [K]; 6504 = no change")
        ->check(CLI::Range(float(scene::least_kelvin), float(scene::most_kelvin)));
    command.add_option("--tint", o.tint, "Tint of that light: above 0 greenish, below pinkish")
        ->check(CLI::Range(-scene::most_tint, scene::most_tint));
    command.add_option("--vignette", o.vignette, "Darken the corners of a .png or .jpg: 1 leaves a quarter there")
        ->check(CLI::Range(0.f, 1.f));
    command.add_option("--bloom", o.bloom, "Scatter this fraction of the light of a .png or .jpg, as lenses do")
        ->check(CLI::Range(0.f, 1.f));
}

void add_background_option(CLI::App& command, DevelopmentOptions& o) {
    command
        .add_option("--background", o.background,
                    "Show this instead of the sky, which still emits light: black, transparent (alpha in .png and "
                    ".exr) or, in a .png or .jpg, a colour R,G,B, each 0 to 1, linear")
        ->type_name("black|transparent|R,G,B");
}

Result<void> apply_background(const DevelopmentOptions& o, scene::Scene& scene) {
    if (o.background.empty()) return {};
    scene::Film film = scene.film.value;
    scene::Development& d = film.development;
    if (o.background == "black" || o.background == "transparent") {
        d.backdrop = o.background == "black" ? scene::Backdrop::black : scene::Backdrop::transparent;
    } else {
        d.backdrop = scene::Backdrop::color;
        const char *at = o.background.data(), *end = at + o.background.size();
        for (int i = 0; i < 3; ++i) {
            if (i > 0) at = at != end && *at == ',' ? at + 1 : end;
            const auto [stop, code] = std::from_chars(at, end, d.backdrop_color[i]);
            const float value = d.backdrop_color[i];
            if (code != std::errc() || !(value >= 0 && value <= 1) || (i == 2 && stop != end))
                return fail("--background: \"" + o.background +
                            "\" is neither black, nor transparent, nor a colour like 0.2,0.4,1");
            at = stop;
        }
    }
    scene.film = {film, ++scene.clock};
    if (auto sky = scene.environment.value) {
        sky->hidden_from_camera = true;
        scene.environment = {std::move(sky), ++scene.clock};
    }
    return {};
}

} // namespace restage::app
