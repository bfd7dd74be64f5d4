// SPDX-License-Identifier: Apache-2.0
// Camera, film, pixel filter, sampler and integrator: the part before WorldBegin.
#include "builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::pbrt {

void Builder::camera(const Directive& d) {
    const std::string what = "Camera " + quote(d.name);
    RestageCamera out{};
    const auto to_world = inverse(ctm(d));
    if (!to_world)
        throw ImportError{d.at, what + ": its transformation cannot be inverted; check LookAt and Scale before it"};
    std::memcpy(out.camera_to_world, to_world->m.data(), sizeof out.camera_to_world);
    double fov = d.params.number("fov", 90);
    const double half = d.params.number("halffov", -1); // v3, for exporters that write half of it
    if (half > 0) fov = 2 * half;
    if (d.name == "perspective") {
        if (!(fov > 0 && fov < 180))
            throw ImportError{d.at, what + ": fov is " + shortest(fov) + "; it must be in (0, 180) degrees"};
    } else if (d.name == "orthographic") {
        out.projection = RESTAGE_ORTHOGRAPHIC;
        fov = 45; // not used
    } else if (import_.v3() ? d.name == "environment" : d.name == "spherical") {
        const std::string mapping = import_.v3() ? "equirectangular" : d.params.string("mapping", "equalarea");
        if (mapping != "equalarea" && mapping != "equirectangular")
            throw ImportError{d.at, what + ": its mapping is " + quote(mapping) +
                                        "; it must be \"equalarea\" or \"equirectangular\""};
        out.projection = mapping == "equalarea" ? RESTAGE_SPHERICAL_EQUAL_AREA : RESTAGE_SPHERICAL;
        fov = 90; // not used
    } else if (d.name == "realistic") {
        fov = 45;
        const bool known = realistic_camera(d, out);
        import_.approximated(d.at, what,
                             known ? "a thin lens of the same focal length and aperture is used instead"
                                   : "a pinhole camera with fov 45 is used instead; its lenses are not simulated");
    } else {
        import_.approximated(d.at, what, "there is no such camera in pbrt; a perspective one is used instead");
        if (!(fov > 0 && fov < 180)) fov = 90;
    }
    if (!(out.fov > 0)) { // not given by a lens file
        out.fov = static_cast<float>(fov);
        out.lens_radius = static_cast<float>(d.params.number("lensradius", 0));
        out.focal_distance = static_cast<float>(d.params.number("focaldistance", 1e6));
    }
    out.frame_aspect = static_cast<float>(d.params.number("frameaspectratio", 0));
    if (!(out.lens_radius >= 0) || !(out.focal_distance > 0) || !(out.frame_aspect >= 0))
        throw ImportError{
            d.at, what + ": lensradius must not be negative, focaldistance and frameaspectratio must be positive"};
    if (const std::vector<double>* window = d.params.numbers("screenwindow"); window && window->size() != 4) {
        import_.warned(d.at, what, "screenwindow needs four numbers x0 x1 y0 y1; it is left out, as pbrt does");
    } else if (window) {
        if ((*window)[0] == (*window)[1] || (*window)[2] == (*window)[3])
            throw ImportError{d.at, what + ": screenwindow is empty; x0 and x1, and y0 and y1, must differ"};
        for (std::size_t axis = 0; axis < 2; ++axis) { // upside down: the same window of a mirrored camera
            const double low = (*window)[2 * axis], high = (*window)[2 * axis + 1], sign = low < high ? 1 : -1;
            out.screen_window[2 * axis] = static_cast<float>(sign * low);
            out.screen_window[2 * axis + 1] = static_cast<float>(sign * high);
            for (std::size_t row = 0; row < 4 && sign < 0; ++row)
                out.camera_to_world[4 * axis + row] *= -1;
        }
    }
    for (const char* name : {"shutteropen", "shutterclose"})
        d.params.find(name); // the film uses them
    std::string verbatim;
    const bool known = d.name == "perspective" || out.projection != RESTAGE_PERSPECTIVE;
    if (!known) {
        verbatim = "Camera " + quote(d.name) + " " + to_text(d.params, " ") + "\n";
        d.params.mark_all_used();
    }
    for (const char* name : {"shutteropen", "shutterclose"})
        if (d.params.has(name)) (verbatim += to_text(*d.params.find(name))) += '\n';
    verbatim += import_.keep_unused(d.params, what);
    const std::string name = take_name({"camera"});
    out.name = name.c_str();
    out.origin = import_.origin(verbatim);
    import_.out.camera(import_.out.ctx, &out);
}

void Builder::film_and_settings() {
    const Directive none{};
    const Directive& film = film_ ? *film_ : none;
    const ParamList& p = film.params;
    RestageFilm out{};
    const int width = p.integer("xresolution", 1280), height = p.integer("yresolution", 720); // both versions
    constexpr int largest = 65536;
    if (width < 1 || height < 1 || width > largest || height > largest || double(width) * height > double(1u << 29))
        throw ImportError{film.at, "Film: a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                                       " pixels; each side must be in 1.." + std::to_string(largest) +
                                       " and the whole below 2^29"};
    out.width = static_cast<std::uint32_t>(width);
    out.height = static_cast<std::uint32_t>(height);
    out.crop[1] = out.crop[3] = 1;
    const std::vector<double>* crop = p.numbers("cropwindow");
    if (crop && crop->size() != 4 && import_.v3()) { // film.cpp
        import_.warned(film.at, "Film", "cropwindow needs four numbers x0 x1 y0 y1; it is left out, as pbrt does");
        crop = nullptr;
    }
    if (crop) {
        if (crop->size() != 4) throw ImportError{film.at, "Film: cropwindow needs four numbers x0 x1 y0 y1"};
        for (std::size_t i = 0; i < 4; ++i)
            out.crop[i] = static_cast<float>(std::clamp((*crop)[i], 0.0, 1.0));
        if (out.crop[0] > out.crop[1]) std::swap(out.crop[0], out.crop[1]);
        if (out.crop[2] > out.crop[3]) std::swap(out.crop[2], out.crop[3]);
    } else if (const std::vector<double>* bounds = p.numbers("pixelbounds")) { // v4: x0 x1 y0 y1
        if (bounds->size() != 4) throw ImportError{film.at, "Film: pixelbounds needs four numbers x0 x1 y0 y1"};
        for (std::size_t i = 0; i < 4; ++i)
            out.crop[i] = static_cast<float>(std::clamp((*bounds)[i] / (i < 2 ? width : height), 0.0, 1.0));
    }
    if (!(out.crop[0] < out.crop[1] && out.crop[2] < out.crop[3]))
        throw ImportError{film.at, "Film: the crop window is empty; x0 < x1 and y0 < y1 must hold"};
    const std::string filename = p.string("filename", "");
    out.filename = filename.c_str();
    double exposure = 1;
    if (import_.v3()) {
        exposure = p.number("scale", 1);
    } else { // PixelSensor::Create: imaging ratio = exposure time * ISO / 100
        const double iso = p.number("iso", 100);
        double time = 1;
        if (camera_) time = camera_->params.number("shutterclose", 1) - camera_->params.number("shutteropen", 0);
        exposure = iso / 100 * time;
        const std::string sensor = p.string("sensor", "cie1931");
        if (sensor != "cie1931")
            import_.approximated(film.at, "Film sensor " + quote(sensor), "the CIE 1931 observer is used instead");
        if (p.number("whitebalance", 0) != 0)
            import_.approximated(film.at, "Film whitebalance", "colours are not balanced");
    }
    out.exposure = static_cast<float>(exposure);
    if (!(exposure >= 0) || !std::isfinite(out.exposure))
        throw ImportError{film.at, "Film: its exposure is " + shortest(exposure) + "; it must not be negative"};

    static const std::map<std::string, std::array<double, 2>> filters = {// default radius in v3 and v4
                                                                         {"box", {0.5, 0.5}},
                                                                         {"gaussian", {2, 1.5}},
                                                                         {"mitchell", {2, 2}},
                                                                         {"sinc", {4, 4}},
                                                                         {"triangle", {2, 2}}};
    Directive default_filter{};
    default_filter.name = import_.v3() ? "box" : "gaussian";
    const Directive& filter = filter_ ? *filter_ : default_filter;
    auto known = filters.find(filter.name);
    if (known == filters.end()) {
        import_.approximated(filter.at, "PixelFilter " + quote(filter.name),
                             "there is no such filter in pbrt; a box is used instead");
        known = filters.find("box");
    }
    out.filter = known->first.c_str();
    const char* names[2][2] = {{"xradius", "xwidth"}, {"yradius", "ywidth"}}; // v4, v3: both are the radius
    for (std::size_t i = 0; i < 2; ++i) {
        const double otherwise = known->second[import_.v3() ? 0 : 1];
        const double radius =
            filter.params.number(filter.params.has(names[i][0]) ? names[i][0] : names[i][1], otherwise);
        if (!(radius > 0 && radius < 1000))
            throw ImportError{filter.at,
                              "PixelFilter: its radius is " + shortest(radius) + " pixels; it must be positive"};
        out.filter_radius[i] = static_cast<float>(radius);
    }
    if (known->first == "gaussian") { // v3's alpha: exp(-alpha x^2)
        const double alpha = filter.params.number("alpha", 2);
        out.filter_params[0] =
            static_cast<float>(filter.params.number("sigma", alpha > 0 ? 1 / std::sqrt(2 * alpha) : 0.5));
        if (!(out.filter_params[0] > 0))
            throw ImportError{filter.at, "PixelFilter \"gaussian\": sigma must be positive"};
    } else if (known->first == "mitchell") {
        out.filter_params[0] = static_cast<float>(filter.params.number("B", 1.0 / 3));
        out.filter_params[1] = static_cast<float>(filter.params.number("C", 1.0 / 3));
    } else if (known->first == "sinc") {
        out.filter_params[0] = static_cast<float>(filter.params.number("tau", 3));
    }
    std::string kept = option_lines_;
    if (p.has("maxcomponentvalue") || p.has("maxsampleluminance"))
        import_.approximated(film.at, "Film",
                             "its limit on bright samples is not applied: it is biased; written back as it is");
    for (const char* name : {"maxcomponentvalue", "maxsampleluminance"})
        p.find(name);
    for (const char* name :
         {"maxcomponentvalue", "maxsampleluminance", "sensor", "whitebalance", "diagonal", "savefp16"})
        if (p.has(name)) kept += "Film " + to_text(*p.find(name)) + "\n";
    const bool film_in_pbrt =
        film.name == "image" || (!import_.v3() && (film.name == "gbuffer" || film.name == "spectral"));
    if (film_ && film.name != "rgb" && !film_in_pbrt) {
        import_.warned(film.at, "Film " + quote(film.name),
                       "there is no such film in pbrt; an RGB film is used instead");
    } else if (film_ && film.name != "rgb" && film.name != "image") {
        kept += "Film " + quote(film.name) + "\n";
        import_.approximated(film.at, "Film " + quote(film.name), "an RGB film is used instead");
    }
    for (const Directive* part : {&film, &filter}) {
        import_.keep_unused(part->params, part->word);
        part->params.each_unused([&](const Param& param) { kept += part->word + " " + to_text(param) + "\n"; });
    }
    import_.out.film(import_.out.ctx, &out);

    RestageSettings settings{};
    settings.max_depth = 5; // pbrt's default
    if (integrator_) {
        settings.max_depth =
            static_cast<std::uint32_t>(std::clamp(integrator_->params.integer("maxdepth", 5), 0, 1 << 20));
        const bool in_pbrt = pbrt_has(Verb::integrator, integrator_->name, import_.v3());
        if (in_pbrt)
            kept += "Integrator " + quote(integrator_->name) + " " + to_text(integrator_->params, " ") + "\n";
        else
            import_.warned(integrator_->at, integrator_->word + " " + quote(integrator_->name),
                           std::string(import_.format()) +
                               " has none of that name; the picture is path-traced, and path "
                               "is written");
        if (in_pbrt && integrator_->name != "path" && integrator_->name != "volpath")
            import_.approximated(integrator_->at, "Integrator " + quote(integrator_->name),
                                 "the picture is path-traced; written back as it is");
    }
    if (sampler_) {
        const ParamList& s = sampler_->params;
        const bool stratified = sampler_->name == "stratified";
        const int samples =
            stratified
                ? s.integer("xsamples", 4) * std::max(1, s.integer("ysamples", 4))
                : s.integer("pixelsamples", sampler_->name == "random" || sampler_->name == "independent" ? 4 : 16);
        settings.samples = static_cast<std::uint32_t>(std::clamp(samples, 0, 1 << 24));
        if (pbrt_has(Verb::sampler, sampler_->name, import_.v3()))
            kept += sampler_->word + " " + quote(sampler_->name) + " " + to_text(s, " ") + "\n";
        else
            import_.warned(sampler_->at, "Sampler " + quote(sampler_->name),
                           std::string(import_.format()) + " has none of that name; another is written");
    }
    for (const Directive* part : {integrator_, sampler_})
        if (part) import_.keep_unused(part->params, part->word, true); // all of it is written back
    settings.origin = import_.origin(kept);
    import_.out.settings(import_.out.ctx, &settings);
    if (!camera_exterior_.empty() && camera_)
        if (const RestageHandle around = medium_named(camera_exterior_, *camera_))
            import_.out.camera_medium(import_.out.ctx, around);
    if (!camera_) {
        import_.approximated(film.at, "Camera", "the file has none; pbrt's default looks along +z from the origin");
        RestageCamera camera{};
        for (int i = 0; i < 4; ++i)
            camera.camera_to_world[5 * i] = 1;
        camera.fov = 90;
        camera.focal_distance = 1e6f;
        camera.name = "camera";
        camera.origin = import_.origin();
        import_.out.camera(import_.out.ctx, &camera);
    }
}

} // namespace restage::pbrt
