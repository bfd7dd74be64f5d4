// SPDX-License-Identifier: Apache-2.0
// Lights without a surface. pbrt-v4: `rgb` is relative to the illuminant of its colour space, so it is the value in the
// picture; a spectrum is made to have luminance 1 (lights.cpp, 1 / SpectrumToPhotometric) before scale, power and
// illuminance multiply it. pbrt-v3: value times `scale`, which may be a colour.
#include "builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace restage::pbrt {

double Builder::light_scale(const Directive& d, Rgb& color) {
    if (!d.params.has("scale")) return 1;
    if (!import_.v3() && d.params.find("scale")->type == "float") return d.params.number("scale", 1);
    color = color * import_.color(d.params, "scale", Role::light, {1, 1, 1});
    return 1;
}

// "=id r g b parameters": what `value` was before it became RGB. The numbers tell the exporter whether it is still
// valid.
std::string Builder::exact_light(const Directive& d, const char* id, const char* name, const float (&value)[3],
                                 double scale) {
    const auto reduced = [&](const char* of) {
        if (!d.params.has(of)) return false;
        const Param& param = *d.params.find(of);
        const bool is_rgb = param.type == "rgb" || param.type == "color";
        return param.type != "float" && (!is_rgb || param.color_space != ColorSpace::srgb);
    };
    if (!reduced(name) && !reduced("scale")) return "";
    std::string spectrum;
    if (const auto given = reduced("scale") ? std::nullopt : import_.given_spectrum(d.params, name))
        spectrum = spectrum_line(id, {double(value[0]), double(value[1]), double(value[2])}, *given);
    std::string line = std::string("=") + id;
    for (const float x : value)
        line += " " + shortest(static_cast<double>(x));
    if (d.params.has(name)) line += " " + to_text(*d.params.find(name));
    if (d.params.has("scale") && d.params.find("scale")->type != "float")
        line += " " + to_text(*d.params.find("scale"));
    else if (scale != 1 && import_.v3()) // a spectrum there
        line += " \"rgb scale\" [ " + shortest(scale) + " " + shortest(scale) + " " + shortest(scale) + " ]";
    else if (scale != 1)
        line += " \"float scale\" [ " + shortest(scale) + " ]";
    return line + "\n" + spectrum;
}

void Builder::light(const Directive& d) {
    const std::string what = "LightSource " + quote(d.name);
    if (d.name == "infinite" || d.name == "exinfinite") {
        infinite_light(d);
        return;
    }
    RestageLight out{};
    Matrix to_world = ctm(d);
    const bool is_distant = d.name == "distant";
    Rgb value = import_.color(d.params, is_distant ? "L" : "I", Role::light, {1, 1, 1});
    double scale = light_scale(d, value);
    const double power = d.params.number("power", -1);
    const auto from = d.params.triple("from", {0, 0, 0}), to = d.params.triple("to", {0, 0, 1});
    const Vec3 origin{from[0], from[1], from[2]}, direction = Vec3{to[0], to[1], to[2]} - origin;
    const bool aims = d.name == "spot" || is_distant, is_placed = aims || d.name == "point";
    if (aims && !(length(direction) > 0)) { // no direction: pbrt continues with NaN
        d.params.mark_all_used();
        import_.lost(d.at, what, "\"from\" and \"to\" are the same point; it emits nothing, its place is kept");
        placeholder(d, d.name + " light", what + " " + to_text(d.params, " "));
        return;
    }
    if (d.name == "spot" || d.name == "projection") {
        out.kind = RESTAGE_LIGHT_SPOT;
        if (is_placed) to_world = to_world * translation(origin);
        if (aims) to_world = to_world * frame_along(direction);
        double cone = d.params.number("coneangle", 30), delta = d.params.number("conedeltaangle", 5);
        if (d.name == "projection") {
            cone = d.params.number("fov", d.params.has("fov") ? 45 : import_.v3() ? 45 : 90) / 2;
            delta = 0;
            d.params.mark_all_used();
            import_.approximated(d.at, what, "a spot light is used instead; the picture it throws is not rendered");
        }
        out.cone_angle = static_cast<float>(cone);
        out.cone_delta = static_cast<float>(delta);
        out.falloff = import_.v3() ? RESTAGE_FALLOFF_QUARTIC : RESTAGE_FALLOFF_SMOOTH;
        if (power > 0) { // pbrt-v4 SpotLight::Create: the smooth edge counts half
            const double end = std::cos(cone * std::numbers::pi / 180),
                         start = std::cos((cone - delta) * std::numbers::pi / 180);
            scale *= power / (2 * std::numbers::pi * ((1 - start) + (start - end) / 2));
        }
    } else if (is_distant) {
        out.kind = RESTAGE_LIGHT_DISTANT;
        to_world = to_world * frame_along(direction);
        const double illuminance = d.params.number("illuminance", -1);
        if (illuminance > 0) scale *= illuminance;
    } else if (d.name == "point" || d.name == "goniometric") {
        out.kind = RESTAGE_LIGHT_POINT;
        if (is_placed) to_world = to_world * translation(origin);
        if (power > 0) scale *= power / (4 * std::numbers::pi);
        if (d.name == "goniometric") {
            d.params.mark_all_used();
            import_.approximated(d.at, what, "a point light is used instead; its distribution is not rendered");
        }
    } else {
        d.params.mark_all_used();
        import_.lost(d.at, what, "there is no such light in pbrt; its place is kept");
        placeholder(d, d.name + " light", what + " " + to_text(d.params, " "));
        return;
    }
    value = value * scale;
    out.value[0] = static_cast<float>(value.r);
    out.value[1] = static_cast<float>(value.g);
    out.value[2] = static_cast<float>(value.b);
    std::memcpy(out.light_to_world, to_world.m.data(), sizeof out.light_to_world);
    // For the exporter, and so that a missing one can be relinked. v3 uses the raw values, v4 decodes 8-bit ones.
    if (const std::string file = d.params.string(import_.v3() ? "mapname" : "filename", "");
        !file.empty() && (d.name == "goniometric" || d.name == "projection"))
        image(d, file, import_.v3() ? RESTAGE_LINEAR : RESTAGE_SRGB, 1, true);
    std::string verbatim = import_.keep_unused(d.params, what);
    if (d.name == "goniometric" ||
        d.name == "projection") { // `whole`: the whole light, valid while the colour is unchanged
        std::string numbers;
        for (const float x : out.value)
            numbers += " " + shortest(static_cast<double>(x));
        verbatim = "=whole" + numbers + " LightSource " + quote(d.name) + " " + to_text(d.params, " ") + "\n";
    } else {
        verbatim += exact_light(d, "value", is_distant ? "L" : "I", out.value, scale);
    }
    const std::string name = take_name({std::string(next_.label), state_.label, d.name + " light"});
    out.name = name.c_str();
    out.origin = import_.origin(verbatim);
    if (d.ours) out.flags |= RESTAGE_LIGHT_HIDDEN; // invisible in pbrt
    import_.out.light(import_.out.ctx, &out);
}

// The host has one environment: constant lights are summed; the first image wins over all others.
void Builder::infinite_light(const Directive& d) {
    const std::string what = "LightSource \"infinite\"";
    Rgb value = import_.color(d.params, "L", Role::light, {1, 1, 1});
    double scale = light_scale(d, value);
    for (const char* name : {"samples", "nsamples"})
        d.params.find(name); // affects sampling only
    const std::string file = d.params.string(d.params.has("filename") ? "filename" : "mapname", "");
    std::string kept; // of pbrt-only parameters
    if (const Param* portal = d.params.find("portal")) {
        import_.approximated(d.at, what, "the light is not limited to its portal; written back as it is");
        kept += to_text(*portal) + "\n";
    }
    const double illuminance = d.params.number("illuminance", -1);
    RestageHandle pixels = 0;
    if (!file.empty()) {
        // v3 does not decode environment images (infinite.cpp: ReadImage); v4 decodes 8-bit ones as sRGB.
        pixels = image(d, file, import_.v3() ? RESTAGE_LINEAR : RESTAGE_SRGB, 1, true);
        if (illuminance > 0)
            import_.approximated(d.at, what,
                                 "\"illuminance\" of a picture is not applied; the picture's own values are used");
        if (illuminance > 0) kept += to_text(*d.params.find("illuminance")) + "\n";
    } else if (illuminance > 0) {
        scale *= illuminance / std::numbers::pi;
    }
    kept += import_.keep_unused(d.params, what);
    value = value * scale;
    std::error_code code;
    const bool is_missing = pixels != 0 && !std::filesystem::is_regular_file(import_.resolve(file, d.at), code);
    const std::string line = what + " " + to_text(d.params, " ");
    PendingEnvironment& pending = environment_;
    if (pending.set && (is_missing || (pending.has_image && !pending.is_missing))) {
        import_.dropped(d.at, what, "there is one environment only, and one comes before; its place is kept");
        placeholder(d, "environment", line);
        return;
    }
    if (pending.set && pixels == 0 && !pending.has_image) { // both constant
        pending.value.scale[0] += static_cast<float>(value.r);
        pending.value.scale[1] += static_cast<float>(value.g);
        pending.value.scale[2] += static_cast<float>(value.b);
        pending.lines.emplace_back(line, std::array<Matrix, 2>{state_.ctm[0], state_.ctm[1]});
        import_.approximated(d.at, what, "added to the environment before it");
        return;
    }
    if (pending.set)
        displace_environment(pending.is_missing ? "there is one environment only, and one whose picture exists follows"
                                                : "there is one environment only, and one with a picture follows");
    pending.lines.clear();
    pending.lines.emplace_back(line, std::array<Matrix, 2>{state_.ctm[0], state_.ctm[1]});
    pending.from = &d;
    pending.is_missing = is_missing;
    pending.set = true;
    pending.has_image = pixels != 0;
    pending.at = d.at;
    pending.name = take_name({std::filesystem::path(file).stem().string(), "environment"});
    pending.value = {};
    pending.value.image = pixels;
    pending.value.mapping = import_.v3() || d.params.has("mapname") ? RESTAGE_EQUIRECT : RESTAGE_OCTAHEDRAL;
    pending.value.scale[0] = static_cast<float>(value.r);
    pending.value.scale[1] = static_cast<float>(value.g);
    pending.value.scale[2] = static_cast<float>(value.b);
    pending.verbatim = kept + exact_light(d, "scale", "L", pending.value.scale, scale);
    const Matrix to_world = ctm(d);
    std::memcpy(pending.value.light_to_world, to_world.m.data(), sizeof pending.value.light_to_world);
}

// The lights merged into the environment so far keep their places.
void Builder::displace_environment(const std::string& why) {
    import_.dropped(environment_.at, "LightSource \"infinite\"", why + "; its place is kept");
    for (const auto& [line, ctm] : environment_.lines) {
        const std::array<Matrix, 2> now{state_.ctm[0], state_.ctm[1]};
        std::copy(ctm.begin(), ctm.end(), state_.ctm);
        placeholder(*environment_.from, "environment", line);
        std::copy(now.begin(), now.end(), state_.ctm);
    }
}

void Builder::flush_environment() {
    if (!environment_.set) return;
    environment_.value.name = environment_.name.c_str();
    environment_.value.origin = import_.origin(environment_.verbatim);
    import_.out.environment(import_.out.ctx, &environment_.value);
}

} // namespace restage::pbrt
