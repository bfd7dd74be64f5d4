// SPDX-License-Identifier: Apache-2.0
// Participating media. Homogeneous ones go to the host, which renders their absorption; others are reported.
#include "builder.hpp"

namespace restage::pbrt {

namespace {

struct Preset { // reduced scattering and absorption [1/mm]: Jensen et al. 2001, "A Practical Model for Subsurface Light
                // Transport", Fig. 5
    const char* name;
    Rgb scattering, absorption;
};

constexpr Preset presets[] = {
    {"Apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}}, {"Chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"Chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}}, {"Cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"Ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},   {"Marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"Potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}}, {"Skimmilk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"Skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},     {"Skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"Spectralon", {11.6, 20.4, 14.9}, {0.00, 0.00, 0.00}}, {"Wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}},
};

} // namespace

void Builder::medium(const Directive& d) {
    const std::string what = "medium " + quote(d.name);
    const std::string type = d.params.string("type", "homogeneous");
    if (type != "homogeneous") {
        d.params.mark_all_used();
        media_[d.name] = 0;
        import_.dropped(d.at, what + " (" + type + ")", "only homogeneous media are rendered; vacuum stands for it");
        return;
    }
    // pbrt's default is whole milk; the numbers are per millimetre and taken as they are (the scene's unit).
    Rgb absorption = presets[11].absorption, scattering = presets[11].scattering;
    const std::string preset = d.params.string("preset", "");
    if (!preset.empty()) {
        bool found = false;
        for (const Preset& entry : presets)
            if (preset == entry.name) {
                absorption = entry.absorption;
                scattering = entry.scattering;
                found = true;
            }
        if (!found)
            import_.approximated(d.at, what,
                                 "preset " + quote(preset) + " is not known here; whole milk stands for it");
    }
    // v4: given alone, the other is what the preset or the default says; v3 alike.
    absorption = import_.color(d.params, "sigma_a", Role::unbounded, absorption);
    scattering = import_.color(d.params, "sigma_s", Role::unbounded, scattering);
    const double scale = d.params.number("scale", 1);
    absorption = absorption * scale;
    scattering = scattering * scale;
    if (scattering.r > 0 || scattering.g > 0 || scattering.b > 0)
        import_.approximated(d.at, what, "its scattering is not rendered, only its absorption");
    if (d.params.find("Le")) import_.dropped(d.at, what, "its emission is not rendered");
    d.params.find("Lescale");
    RestageMedium out{};
    const double a[3] = {absorption.r, absorption.g, absorption.b}, s[3] = {scattering.r, scattering.g, scattering.b};
    for (int i = 0; i < 3; ++i) {
        out.sigma_a[i] = static_cast<float>(a[i]);
        out.sigma_s[i] = static_cast<float>(s[i]);
    }
    out.g = static_cast<float>(d.params.number("g", 0));
    std::string verbatim;
    for (const char* name : {"preset", "Le", "Lescale"})
        if (d.params.has(name)) (verbatim += to_text(*d.params.find(name))) += '\n';
    verbatim += import_.keep_unused(d.params, what);
    out.text = import_.text(d.name.c_str(), verbatim.c_str());
    media_[d.name] = import_.out.medium(import_.out.ctx, &out);
}

RestageHandle Builder::medium_named(const std::string& name, const Directive& directive) {
    if (name.empty()) return 0;
    if (const auto found = media_.find(name); found != media_.end()) return found->second;
    import_.dropped(directive.at, "medium " + quote(name) + " of " + directive.word,
                    "no medium has that name; vacuum stands for it");
    return 0;
}

} // namespace restage::pbrt
