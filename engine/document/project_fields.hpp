// SPDX-License-Identifier: Apache-2.0
// The fields of every item in a scene, each named once: one list writes and reads project files. A visitor is
// called as v(name, field); v.path(name, file path), v.mesh(m) and v.image(i) for indirectly stored fields.
#pragma once

#include "scene/development.hpp"
#include "scene/tables.hpp"
#include "scene/techniques.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace restage::document {

using json = nlohmann::ordered_json;

// Projects from before 0.2 have values among the verbatim lines, one "=id text" each.
void take_value_lines(scene::Origin&);

template <class V>
void fields(V& v, scene::Mesh& m) {
    v("name", m.name);
    v.path("source_file", m.source_file);
    v("primitive", m.primitive);
    v("origin", m.origin);
    v.mesh(m);
}
template <class V>
void fields(V& v, scene::Image& i) {
    v("name", i.name);
    v.path("path", i.path);
    v("encoding", i.encoding);
    v("gamma", i.gamma);
    v("origin", i.origin);
    v.image(i);
}
template <class V>
void fields(V& v, scene::Texture& t) {
    v("name", t.name);
    v("type", t.type);
    v("is_float", t.is_float);
    v("image", t.image);
    v("params", t.params);
    v("origin", t.origin);
}
template <class V>
void fields(V& v, scene::Material& m) {
    v("name", m.name);
    v("type", m.type);
    v("params", m.params);
    v("origin", m.origin);
}
template <class V>
void fields(V& v, scene::Medium& m) {
    v("name", m.name);
    v("sigma_a", m.sigma_a);
    v("sigma_s", m.sigma_s);
    v("g", m.g);
    v("origin", m.origin);
}
template <class V>
void fields(V& v, scene::Group& g) {
    v("name", g.name);
    v("parent", g.parent);
    v("origin", g.origin);
}
template <class V>
void fields(V& v, scene::Emission& e) {
    v("radiance", e.radiance);
    v("two_sided", e.two_sided);
    v("unseen", e.unseen);
}
template <class V>
void fields(V& v, scene::MediumInterface& m) {
    v("interior", m.interior);
    v("exterior", m.exterior);
}
template <class V>
void fields(V& v, scene::Instance& i) {
    v("name", i.name);
    v("mesh", i.mesh);
    v("material", i.material);
    v("group", i.group);
    v("object_to_world", i.object_to_world);
    v("emission", i.emission);
    v("media", i.media);
    v("alpha_texture", i.alpha_texture);
    v("alpha", i.alpha);
    v("reverse_orientation", i.reverse_orientation);
    v("hidden", i.hidden);
    v("alpha_mask", i.alpha_mask);
    v("catcher", i.catcher);
    v("origin", i.origin);
}
template <class V>
void fields(V& v, scene::Light& l) {
    v("name", l.name);
    v("kind", l.kind);
    v("value", l.value);
    v("light_to_world", l.light_to_world);
    v("cone_angle", l.cone_angle);
    v("cone_delta", l.cone_delta);
    v("origin", l.origin);
    v("falloff", l.falloff);
    v("hidden", l.hidden);
}
template <class V>
void fields(V& v, scene::Environment& e) {
    v("name", e.name);
    v("image", e.image);
    v("mapping", e.mapping);
    v("scale", e.scale);
    v("light_to_world", e.light_to_world);
    v("hidden_from_camera", e.hidden_from_camera);
    v("origin", e.origin);
    v("sky", e.sky);
    v("sky_params", e.sky_params);
}
template <class V>
void fields(V& v, scene::Camera& c) {
    v("name", c.name);
    v("camera_to_world", c.camera_to_world);
    v("fov", c.fov);
    v("screen_window", c.screen_window);
    v("lens_radius", c.lens_radius);
    v("focal_distance", c.focal_distance);
    v("frame_aspect", c.frame_aspect);
    v("projection", c.projection);
    v("origin", c.origin);
    v("fit_aspect", c.fit_aspect);
}
template <class V>
void fields(V& v, scene::Filter& f) {
    v("kind", f.kind);
    v("radius", f.radius);
    v("params", f.params);
}
template <class V>
void fields(V& v, scene::Development& d) {
    v("tone", d.tone);
    v("temperature", d.temperature);
    v("tint", d.tint);
    v("vignette", d.vignette);
    v("bloom", d.bloom);
    v("backdrop", d.backdrop);
    v("backdrop_color", d.backdrop_color);
}
template <class V>
void fields(V& v, scene::Film& f) {
    v("width", f.width);
    v("height", f.height);
    v("crop", f.crop);
    v("filter", f.filter);
    v("exposure", f.exposure);
    v("development", f.development);
    v("filename", f.filename);
}
template <class V>
void fields(V& v, scene::Settings& s) {
    v("max_depth", s.max_depth);
    v("samples", s.samples);
    v("russian_roulette", s.russian_roulette);
    v("spectral", s.spectral);
    v("adaptive", s.adaptive);
    v("guiding", s.guiding);
    v("caustics", s.caustics);
    v("clamp_direct", s.clamp_direct);
    v("clamp_indirect", s.clamp_indirect);
    v("ray_epsilon", s.ray_epsilon);
    v("camera_medium", s.camera_medium);
    v("origin", s.origin);
}
template <class V>
void fields(V& v, scene::Origin& o) {
    v("verbatim", o.verbatim);
    v("format", o.format);
    v("values", o.values);
    take_value_lines(o);
}

// Names of choices, in the order of their values.
template <class E>
struct Names;
template <>
struct Names<scene::Encoding> {
    static constexpr const char* list[] = {"linear", "srgb", "gamma"};
    static constexpr int first = static_cast<int>(scene::Encoding::linear);
};
template <>
struct Names<scene::LightKind> {
    static constexpr auto list = [] {
        std::array<const char*, std::size(scene::light_kinds)> ids{};
        for (std::size_t i = 0; i < ids.size(); ++i)
            ids[i] = scene::light_kinds[i].id;
        return ids;
    }();
    static constexpr int first = 0;
};
template <>
struct Names<scene::Falloff> {
    static constexpr const char* list[] = {"smooth", "quartic"};
    static constexpr int first = static_cast<int>(scene::Falloff::smooth);
};
template <>
struct Names<scene::Mapping> {
    static constexpr const char* list[] = {"equirect", "octahedral"};
    static constexpr int first = static_cast<int>(scene::Mapping::equirect);
};
template <>
struct Names<scene::Projection> {
    static constexpr const char* list[] = {"perspective", "orthographic", "spherical", "spherical_equal_area"};
    static constexpr int first = static_cast<int>(scene::Projection::perspective);
};
template <>
struct Names<scene::FilterKind> {
    static constexpr const char* list[] = {"box", "triangle", "gaussian", "mitchell", "sinc"};
    static constexpr int first = int(scene::FilterKind::box);
};
template <>
struct Names<scene::ToneCurve> {
    static constexpr auto list = scene::tone_names;
    static constexpr int first = int(scene::ToneCurve::srgb);
};
template <>
struct Names<scene::Backdrop> {
    static constexpr auto list = scene::backdrop_names;
    static constexpr int first = int(scene::Backdrop::black);
};
template <>
struct Names<scene::Technique> {
    static constexpr auto list = scene::technique_names;
    static constexpr int first = int(scene::Technique::automatic);
};

} // namespace restage::document
