// SPDX-License-Identifier: Apache-2.0
// Everything before WorldBegin: options, camera, film, pixel filter, sampler, integrator.
// https://pbrt.org/fileformat-v4, https://pbrt.org/fileformat-v3.
#include "exporter.hpp"

#include <cmath>

namespace restage::pbrt_out {

namespace {

// The kept line of a directive ("Integrator", with v3's "SurfaceIntegrator"), if there is one.
std::optional<KeptLine> find_line(const Kept& kept, std::string_view word, std::string_view other = "") {
    for (const std::string& line : kept.lines)
        if (const KeptLine l = split_directive(line);
            (l.word == word || (!other.empty() && l.word == other)) && !l.name.empty())
            return l;
    return std::nullopt;
}

void add_kept_params(Params& params, const Kept& kept, std::string_view word) { // `Film "float whitebalance" [ 5000 ]`
    for (const std::string& line : kept.lines)
        if (const KeptLine l = split_directive(line); l.word == word && l.name.empty()) params.add_raw(l.rest);
}

} // namespace

void Exporter::head() {
    RestageSettings settings{};
    in_.settings(in_.ctx, &settings);
    const Kept kept_settings = kept(*settings.origin, "settings");
    comment(kept_settings.foreign);
    for (const std::string& line : kept_settings.lines) {
        const std::string word = split_directive(line).word;
        if (word != "Film" && word != "PixelFilter" && word != "Integrator" && word != "SurfaceIntegrator" &&
            word != "Sampler")
            text_ += line + "\n"; // Option, Accelerator, TransformTimes; Include and Import of missing files
        if (word == "Include" || word == "Import") tell_missing("settings", split_directive(line).name);
    }
    if (const RestageHandle active = in_.active_camera(in_.ctx)) camera(active, true);
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_CAMERA); ++h)
        if (h != in_.active_camera(in_.ctx)) camera(h, false);
    film(kept_settings, shutter_time());
    filter(kept_settings);
    sampler_and_integrator(kept_settings);
    text_ += "\n";
}

double Exporter::shutter_time() const {
    RestageCamera camera{};
    const RestageHandle active = in_.active_camera(in_.ctx);
    if (v3() || !active || !in_.camera(in_.ctx, active, &camera) ||
        !std::string_view(camera.origin->format).starts_with("pbrt-"))
        return 1;
    Params params;
    for (const std::string& line : lines(camera.origin->verbatim))
        params.add_raw(line[0] == '"' ? line : split_directive(line).rest);
    const auto number_of = [&](const char* name, double otherwise) {
        if (!params.has(name)) return otherwise;
        const std::string text = params.value(name);
        std::string_view rest = text;
        return read_number(rest).value_or(0);
    };
    const double open = number_of("shutteropen", 0), close = number_of("shutterclose", 1);
    return close > open ? close - open : 1;
}

// pbrt has one camera, the active one. The others are for Restage only.
void Exporter::camera(RestageHandle handle, bool active) {
    RestageCamera camera{};
    if (!in_.camera(in_.ctx, handle, &camera)) return;
    const std::string what = std::string("camera \"") + camera.name + "\"";
    const Kept k = kept(*camera.origin, what);
    const std::size_t start = text_.size();
    const char* indent = active ? "" : "    ";
    const auto to_camera = inverse(camera.camera_to_world);
    if (!to_camera) throw ExportError("", what + " has a transform that cannot be inverted");
    const RestageHandle around = active ? in_.camera_medium(in_.ctx) : 0;
    if (around) {
        const std::string name = medium(around);
        text_ += "MediumInterface \"\" " + quote(name) + "\n";
    }
    if (!active) text_ += "AttributeBegin\n    Identity\n";
    mark(indent, "name", {camera.name});
    comment(k.foreign, indent);
    transform(to_camera->data(), indent);
    Params params;
    std::string type = "perspective";
    const bool all_around = camera.projection == RESTAGE_SPHERICAL || camera.projection == RESTAGE_SPHERICAL_EQUAL_AREA;
    if (camera.projection == RESTAGE_PERSPECTIVE) {
        params.add_float("fov", camera.fov);
    } else if (!all_around) {
        type = "orthographic";
    } else if (v3()) {
        type = "environment";
        if (active && camera.projection == RESTAGE_SPHERICAL_EQUAL_AREA)
            approximated(what, "pbrt-v3 has no spherical camera of equal areas; it becomes an equirectangular one");
    } else {
        type = "spherical";
        params.add_string("mapping",
                          camera.projection == RESTAGE_SPHERICAL_EQUAL_AREA ? "equalarea" : "equirectangular");
    }
    if (camera.lens_radius > 0) {
        params.add_float("lensradius", camera.lens_radius);
        params.add_float("focaldistance", camera.focal_distance);
    } else if (camera.focal_distance != (all_around && !v3() ? 1e30f : 1e6f)) {
        params.add_float("focaldistance", camera.focal_distance);
    }
    if (camera.frame_aspect > 0) params.add_float("frameaspectratio", camera.frame_aspect);
    const float* w = camera.screen_window;
    if (w[0] != 0 || w[1] != 0 || w[2] != 0 || w[3] != 0)
        params.add("float", "screenwindow",
                   number(w[0]) + " " + number(w[1]) + " " + number(w[2]) + " " + number(w[3]));
    for (const std::string& line : k.lines) {
        const KeptLine l = split_directive(line);
        if (l.word == "Camera" && !l.name.empty()) { // another kind of camera: only its place is known
            type = l.name;
            params = Params().add_raw(l.rest);
        } else {
            params.add_raw(line);
        }
    }
    text_ += std::string(indent) + "Camera " + quote(type) + " " + finished(params, what) + "\n";
    if (around) text_ += "MediumInterface \"\" \"\"\n"; // else every shape would inherit the camera's
    if (active) return;
    text_ += "AttributeEnd\n";
    only_for_us(start);
}

void Exporter::film(const Kept& k, double time) {
    RestageFilm film{};
    in_.film(in_.ctx, &film);
    Params params;
    params.add_int("xresolution", film.width).add_int("yresolution", film.height);
    params.add_string("filename", *film.filename ? film.filename : "restage.exr");
    const float* c = film.crop;
    if (c[0] != 0 || c[1] != 1 || c[2] != 0 || c[3] != 1)
        params.add("float", "cropwindow", number(c[0]) + " " + number(c[1]) + " " + number(c[2]) + " " + number(c[3]));
    if (v3() && film.exposure != 1) params.add_float("scale", film.exposure);
    if (!v3() && (film.exposure != 1 || time != 1)) // imaging ratio = exposure time * ISO / 100
        params.add_float("iso", static_cast<double>(film.exposure) * 100 / time);
    add_kept_params(params, k, "Film");
    std::string type = v3() ? "image" : "rgb";
    if (const auto line = find_line(k, "Film")) type = line->name;
    params.retype(v3());
    text_ += "Film " + quote(type) + " " + params.text() + "\n";
}

void Exporter::filter(const Kept& k) {
    RestageFilm film{};
    in_.film(in_.ctx, &film);
    const std::string name = film.filter;
    Params params;
    params.add_float(v3() ? "xwidth" : "xradius", film.filter_radius[0]);
    params.add_float(v3() ? "ywidth" : "yradius", film.filter_radius[1]);
    const float a = film.filter_params[0];
    if (name == "gaussian" && v3()) // exp(-alpha x^2) = exp(-x^2 / (2 sigma^2))
        params.add_float("alpha", 1 / (2 * static_cast<double>(a) * static_cast<double>(a)));
    else if (name == "gaussian")
        params.add_float("sigma", a);
    else if (name == "mitchell")
        params.add_float("B", a).add_float("C", film.filter_params[1]);
    else if (name == "sinc")
        params.add_float("tau", a);
    add_kept_params(params, k, "PixelFilter");
    text_ += "PixelFilter " + quote(name) + " " + params.text() + "\n";
}

void Exporter::sampler_and_integrator(const Kept& k) {
    RestageSettings settings{};
    in_.settings(in_.ctx, &settings);
    Params sampler, integrator;
    KeptLine s{"Sampler", v3() ? "sobol" : "zsobol", ""}, i{"Integrator", v3() ? "path" : "volpath", ""};
    if (const auto line = find_line(k, "Sampler")) s = *line;
    if (const auto line = find_line(k, "Integrator", "SurfaceIntegrator")) i = *line;
    sampler.add_raw(s.rest);
    const std::uint32_t samples = settings.samples ? settings.samples : 16;
    if (s.name == "stratified") {
        const auto kept_number = [&](const char* name) {
            return sampler.has(name) ? std::strtoul(sampler.value(name).c_str(), nullptr, 10) : 4ul;
        };
        if (kept_number("xsamples") * kept_number("ysamples") != samples) { // edited: as close to a square as possible
            auto x = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(samples)));
            while (samples % x != 0)
                --x;
            sampler.remove("xsamples");
            sampler.remove("ysamples");
            sampler.add_int("xsamples", x).add_int("ysamples", samples / x);
        }
    } else {
        sampler.remove("pixelsamples");
        sampler.add_int("pixelsamples", samples);
    }
    integrator.add_raw(i.rest);
    integrator.remove("maxdepth");
    integrator.add_int("maxdepth", settings.max_depth);
    for (Params* part : {&sampler, &integrator})
        part->retype(v3());
    text_ += "Sampler " + quote(s.name) + " " + sampler.text() + "\n";
    text_ += "Integrator " + quote(i.name) + " " + integrator.text() + "\n";
}

} // namespace restage::pbrt_out
