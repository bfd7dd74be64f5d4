// SPDX-License-Identifier: Apache-2.0
// Materials: the common part of both versions. Each becomes a named material; components of a mix precede it.
#include "exporter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace restage::pbrt_out {

void Exporter::put_float(Params& params, const Values& values, const char* id, const char* name, float otherwise) {
    put_argument(params, values, id, name, true, otherwise);
}

// pbrt-v4 stops at reflectances above 1, v3 clamps them: so does this.
void Exporter::put_color(Params& params, const Values& values, const char* id, const char* name,
                         std::array<float, 3> otherwise, bool albedo) {
    if (values.ref(id)) {
        put_argument(params, values, id, name, false, 0);
        return;
    }
    auto c = values.color(id, otherwise);
    for (float& x : c)
        x = std::clamp(x, 0.f, albedo ? 1.f : 1e30f);
    params.add_rgb(name, c);
}

// Both versions map roughness to the microfacets' alpha, each in its own way. A roughness for the other version is
// written as alpha itself, which both take with remaproughness false. Smooth dielectrics (0) stay smooth.
void Exporter::put_roughness(Params& params, const Values& values, const std::string& what, const char* u_id,
                             const char* v_id, const char* u_name, const char* v_name, bool zero_is_smooth,
                             float otherwise) {
    const std::string remap = values.choice("remap", v3() ? "v3" : "v4"), own = v3() ? "v3" : "v4";
    const bool convert = remap != "none" && remap != own;
    const bool smooth = zero_is_smooth && !values.ref(u_id) && values.number(u_id, otherwise) == 0 &&
                        (!v_id || (!values.ref(v_id) && values.number(v_id, otherwise) == 0)); // in both directions
    const auto put = [&](const char* id, const char* name) {
        if (!convert || values.ref(id)) {
            put_float(params, values, id, name, otherwise);
            if (convert)
                approximated(what, std::string("its textured roughness is mapped as ") + remap + " does; " + format() +
                                       " maps it in its own way");
            return;
        }
        const double roughness = values.number(id, otherwise);
        const double alpha = smooth ? 0 : alpha_of_roughness(roughness, remap);
        params.add_float(name, static_cast<float>(alpha));
    };
    put(u_id, u_name);
    if (v_id) put(v_id, v_name);
    const bool textured = values.ref(u_id) || (v_id && values.ref(v_id));
    if ((remap == "none" || (convert && !textured)) && !params.has("remaproughness"))
        flag(params, "remaproughness", false);
}

void Exporter::put_common(Params& params, const Values& values, const std::string& what) {
    if (const RestageHandle bump = values.ref("bump")) {
        RestageTexture t{};
        if (in_.texture(in_.ctx, bump, &t) && t.is_float)
            params.add("texture", v3() ? "bumpmap" : "displacement", quote(texture(bump)));
        else
            dropped(what, "its bump map is not a scalar texture");
    }
    if (const RestageHandle normal_map = values.ref("normalmap")) {
        RestageTexture t{};
        const bool image = in_.texture(in_.ctx, normal_map, &t) && t.image && std::string_view(t.type) == "imagemap";
        if (v3())
            dropped(what, "pbrt-v3 has no normal maps");
        else if (!image)
            dropped(what, "pbrt-v4 reads normal maps from image files only");
        else
            params.add_string("normalmap", image_file(t.image));
    }
}

// All of its values under the ids of its plugin's table, for our importer, if that plugin is loaded.
void Exporter::put_for_plugin(const std::string& name, const RestageMaterialDesc& m) {
    const Values values(m.values, m.value_count);
    Params params;
    params.add_string("plugin", m.type);
    std::vector<const RestageValue*> sorted;
    for (std::uint32_t i = 0; i < m.value_count; ++i)
        sorted.push_back(&RESTAGE_AT(RestageValue, m.values, i));
    std::sort(sorted.begin(), sorted.end(),
              [](const auto* a, const auto* b) { return std::string_view(a->id) < b->id; });
    for (const RestageValue* v : sorted) {
        if (v->type == RESTAGE_FLOAT) put_float(params, values, v->id, v->id, 0);
        if (v->type == RESTAGE_COLOR) put_color(params, values, v->id, v->id, {0, 0, 0}, false);
        if (v->type == RESTAGE_INT) params.add_int(v->id, v->i);
        if (v->type == RESTAGE_BOOL) flag(params, v->id, v->i != 0);
        if ((v->type == RESTAGE_ENUM || v->type == RESTAGE_TABLE) && v->text && *v->text)
            params.add_string(v->id, v->text);
    }
    const std::string what = std::string("material \"") + m.name + "\"";
    put_common(params, values, what);
    const std::string text = "MakeNamedMaterial " + quote(name) + " " + finished(params, what) + "\n";
    const std::size_t start = text_.size();
    text_ += text;
    only_for_us(start);
}

std::string Exporter::material(RestageHandle handle) {
    if (const auto it = materials_.find(handle); it != materials_.end()) return it->second;
    RestageMaterialDesc m{};
    if (!in_.material(in_.ctx, handle, &m)) return "";
    materials_[handle] = ""; // breaks cycles
    const std::string what = std::string("material \"") + m.name + "\"";
    const Kept k = kept(*m.origin, what);
    const Values values(m.values, m.value_count);
    if (const std::string name = extern_name("material", k); !name.empty()) return materials_[handle] = name;
    Params params;
    const bool outside = std::exchange(lossy_, false);
    bool stands_in = false; // pbrt has only an approximation
    if (!k.whole.empty()) { // a pbrt material that is only approximated here, and was not edited
        for (const std::string& line : k.whole)
            params.add_raw(line);
    } else {
        Params own;
        const std::string type = v3() ? material_v3(own, m, values, what) : material_v4(own, m, values, what);
        stands_in = lossy_ && type != "mix" && type != "interface" && type != "none";
        params.add_string("type", type);
        for (const auto& [id, line] : k.for_values) { // an unedited value from before it became RGB
            Params original;
            original.add_raw(line);
            if (!original.stands_alone()) {
                approximated(what, "its \"" + id + "\" was given in another colour space; its colour is written");
                continue;
            }
            own.remove_all_of(original);
            params.add_raw(line);
        }
        if (type != "interface" && type != "none") put_common(own, values, what);
        params.add_raw(own.text());
    }
    for (const std::string& line : k.lines)
        params.add_raw(line);
    comment(k.foreign);
    const std::string name = unique_name("material", m.name);
    if (stands_in) put_for_plugin(name, m);
    lossy_ = lossy_ || outside;
    text_ += "MakeNamedMaterial " + quote(name) + " " + finished(params, what) + "\n";
    return materials_[handle] = name;
}

} // namespace restage::pbrt_out
