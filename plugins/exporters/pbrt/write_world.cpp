// SPDX-License-Identifier: Apache-2.0
// Media, the environment and lights without a surface. Textures and materials are in other files.
#include "exporter.hpp"

namespace restage::pbrt_out {

std::string Exporter::medium(RestageHandle handle) {
    if (const auto it = media_.find(handle); it != media_.end()) return it->second;
    RestageMedium m{};
    if (!in_.medium(in_.ctx, handle, &m)) return "";
    const std::string what = std::string("medium \"") + m.name + "\"";
    const Kept k = kept(*m.origin, what);
    if (const std::string name = extern_name("medium", k); !name.empty()) return media_[handle] = name;
    Params params;
    for (const std::string& line : k.whole) // a kind that is not rendered
        params.add_raw(line);
    if (!k.whole.empty()) {
        const std::string name = media_[handle] = unique_name("medium", m.name);
        text_ += "MakeNamedMedium " + quote(name) + " " + finished(params, what) + "\n";
        return name;
    }
    params.add_string("type", "homogeneous");
    params.add_rgb("sigma_a", {m.sigma_a[0], m.sigma_a[1], m.sigma_a[2]});
    params.add_rgb("sigma_s", {m.sigma_s[0], m.sigma_s[1], m.sigma_s[2]});
    if (m.g != 0) params.add_float("g", m.g);
    for (const std::string& line : k.lines) {
        Params one;
        one.add_raw(line);
        if (!one.has("preset")) // its numbers are written; pbrt accepts only one of the two
            params.add_raw(line);
    }
    comment(k.foreign);
    const std::string name = media_[handle] = unique_name("medium", m.name);
    text_ += "MakeNamedMedium " + quote(name) + " " + params.text() + "\n";
    return name;
}

void Exporter::environment() {
    RestageEnvironment e{};
    if (!in_.environment(in_.ctx, &e)) return;
    const std::string what = std::string("environment \"") + e.name + "\"";
    const Kept k = kept(*e.origin, what);
    if (e.hidden_from_camera) approximated(what, "pbrt has no skies hidden from the camera: it is visible there");
    if (e.sky && *e.sky)
        approximated(what,
                     std::string("pbrt has no sky \"") + e.sky + "\": its picture is written, its values are not");
    std::array<float, 3> scale{e.scale[0], e.scale[1], e.scale[2]};
    Params params;
    std::string file;
    if (e.image && e.mapping == (v3() ? RESTAGE_EQUIRECT : RESTAGE_OCTAHEDRAL)) {
        file = image_file(e.image);
    } else if (e.image) {
        const bool grey = scale[0] == scale[1] && scale[1] == scale[2];
        file = environment_file(e, v3() || grey ? std::array<float, 3>{1, 1, 1} : scale);
        if (!v3() && !grey && !file.empty()) scale = {1, 1, 1};
        if (file.empty())
            dropped(what,
                    v3()
                        ? "pbrt-v3 reads equirectangular pictures, this one is octahedral; a constant is used instead"
                        : "pbrt-v4 reads octahedral pictures, this one is equirectangular; a constant is used instead");
    }
    if (file.empty()) {
        params.add_rgb("L", scale);
    } else {
        params.add_string(v3() ? "mapname" : "filename", file);
        const bool grey = scale[0] == scale[1] && scale[1] == scale[2];
        if (!grey && !v3()) {
            const float y = 0.212639f * scale[0] + 0.715169f * scale[1] + 0.072192f * scale[2];
            approximated(what,
                         "pbrt-v4 scales a picture by one number: the luminance of its coloured scale is written");
            scale = {y, y, y};
        }
        if (v3() && (!grey || scale[0] != 1))
            params.add_rgb("L", scale);
        else if (!v3() && scale[0] != 1)
            params.add_float("scale", scale[0]);
    }
    put_exact(params, k, "scale", e.scale, what);
    for (const std::string& line : k.lines)
        params.add_raw(line);
    text_ += "\nAttributeBegin\n";
    mark("    ", "name", {e.name});
    comment(k.foreign, "    ");
    transform(e.light_to_world, "    ");
    text_ += "    LightSource \"infinite\" " + finished(params, what) + "\nAttributeEnd\n";
}

void Exporter::lights() {
    for (RestageHandle h = 1; h <= in_.count(in_.ctx, RESTAGE_KIND_LIGHT); ++h)
        light(h);
}

void Exporter::light(RestageHandle handle) {
    RestageLight light{};
    if (!in_.light(in_.ctx, handle, &light)) return;
    const std::string what = std::string("light \"") + light.name + "\"";
    std::string type;
    Params params;
    const bool has_picture = picture_light(light, what, type, params);
    const Kept k = kept(*light.origin, what);
    if (!has_picture) {
        const std::array<float, 3> value{light.value[0], light.value[1], light.value[2]};
        const char* point_type = v3() ? "point" : "point3";
        params = {};
        switch (light.kind) {
            case RESTAGE_LIGHT_POINT:
                type = "point";
                params.add_rgb("I", value);
                break;
            case RESTAGE_LIGHT_SPOT:
                type = "spot";
                params.add_rgb("I", value)
                    .add_float("coneangle", light.cone_angle)
                    .add_float("conedeltaangle", light.cone_delta);
                params.add(point_type, "from", "0 0 0").add(point_type, "to", "0 0 1");
                if (light.cone_delta > 0 && (light.falloff == RESTAGE_FALLOFF_QUARTIC) != v3())
                    approximated(what, v3() ? "pbrt-v3's spots fade by the fourth power, this one smoothly: its edge "
                                              "becomes darker"
                                            : "pbrt-v4's spots fade smoothly, this one by the fourth power (pbrt-v3): "
                                              "its edge becomes brighter");
                break;
            case RESTAGE_LIGHT_DISTANT:
                type = "distant";
                params.add_rgb("L", value).add(point_type, "from", "0 0 0").add(point_type, "to", "0 0 1");
                break;
            default:
                return;
        }
        put_exact(params, k, "value", light.value, what);
    }
    for (const std::string& text : k.lines)
        params.add_raw(text);
    text_ += "\n";
    const std::size_t start = text_.size();
    text_ += "AttributeBegin\n";
    mark("    ", "name", {light.name});
    comment(k.foreign, "    ");
    transform(light.light_to_world, "    ");
    text_ += "    LightSource " + quote(type) + " " + finished(params, what) + "\nAttributeEnd\n";
    if (light.flags & RESTAGE_LIGHT_HIDDEN) only_for_us(start); // pbrt would light the scene with it
}

} // namespace restage::pbrt_out
