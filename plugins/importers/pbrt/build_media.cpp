// SPDX-License-Identifier: Apache-2.0
// Participating media. Homogeneous ones go to the host, which renders their absorption; others are reported.
#include "builder.hpp"
#include "medium_data.hpp"

namespace restage::pbrt {

// Missing files that a verbatim line names.
void Builder::missing_files_of(const Directive& d, const std::string& what) {
    for (const Param& param : d.params.params) {
        const bool is_file = param.name.ends_with("filename") || param.name == "bsdffile";
        if (param.type != "string" || !is_file || param.strings.size() != 1) continue;
        const std::string path = import_.resolve(param.strings[0], param.at).string();
        std::error_code code;
        if (!std::filesystem::is_regular_file(path, code))
            import_.lost(param.at, what + ": file " + quote(param.strings[0]), "there is no such file: " + path);
    }
}

void Builder::medium(const Directive& d) {
    const std::string what = "medium " + quote(d.name);
    const std::string type = d.params.string("type", "homogeneous");
    if (type != "homogeneous") { // rendered as clear, and written back verbatim
        std::string whole;
        for (const Param& param : d.params.params)
            whole += "=* " + to_text(param) + "\n";
        const RestageMedium clear{.name = d.name.c_str(), .origin = import_.origin(whole)};
        media_[d.name] = import_.out.medium(import_.out.ctx, &clear);
        import_.dropped(d.at, what + " (" + type + ")",
                        "only homogeneous media are rendered; it is clear, and written back as it is");
        missing_files_of(d, what);
        return;
    }
    // pbrt's default is whole milk; the numbers are per millimetre and used unscaled (in the scene's unit).
    Rgb absorption = medium_preset(default_medium)->absorption, scattering = medium_preset(default_medium)->scattering;
    const std::string preset = d.params.string("preset", "");
    if (!preset.empty()) {
        const MediumPreset* found = medium_preset(preset);
        if (found) {
            absorption = found->absorption;
            scattering = found->scattering;
        }
        if (!found) import_.warned(d.at, what, "preset " + quote(preset) + " is unknown; whole milk is used instead");
    }
    // v4: given alone, the other comes from the preset or the default; so too in v3.
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
    if (auto given = import_.given_spectrum(d.params, "sigma_a")) {
        for (double& x : *given)
            x *= scale;
        verbatim += spectrum_line("sigma_a", absorption, *given);
    }
    out.name = d.name.c_str();
    out.origin = import_.origin(verbatim);
    media_[d.name] = import_.out.medium(import_.out.ctx, &out);
}

RestageHandle Builder::medium_named(const std::string& name, const Directive& directive) {
    if (name.empty()) return 0;
    if (const auto found = media_.find(name); found != media_.end()) return found->second;
    if (const auto later = later_media_.find(name); later != later_media_.end()) {
        const Directive& made = *later->second;
        later_media_.erase(later);
        made_media_.insert(name);
        medium(made);
        return media_[name];
    }
    import_.lost(directive.at, "medium " + quote(name) + " of " + directive.word,
                 "no medium has that name; vacuum is used instead");
    if (!files_are_missing_) return 0;
    const std::string verbatim = "=* extern " + quote(name) + "\n"; // a missing file may define it
    const RestageMedium clear{.name = name.c_str(), .origin = import_.origin(verbatim)};
    return media_[name] = import_.out.medium(import_.out.ctx, &clear);
}

} // namespace restage::pbrt
