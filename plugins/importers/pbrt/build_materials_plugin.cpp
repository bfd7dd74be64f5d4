// SPDX-License-Identifier: Apache-2.0
// Materials unknown to pbrt but provided by a plugin of the host: Material "velvet" "float fuzz" 0.5. Parameters have
// the ids of the plugin's table; others are reported, as usual. So does `"string plugin" "velvet"`, which our exporter
// writes into a line `#restage MakeNamedMaterial` before the nearest material that pbrt has.
#include "builder.hpp"

#include <algorithm>

namespace restage::pbrt {

bool Builder::is_rgl(const Directive& d) const {
    const std::string path = import_.resolve(d.params.string("filename", ""), d.at).string();
    std::string reason;
    const auto bytes = FileBytes::open(path, reason);
    return bytes ? bytes->view().starts_with("tensor_file") : path.ends_with(".bsdf");
}

bool Builder::is_for_plugin(const Directive& d) const {
    const std::string type = d.params.string("plugin", "");
    std::uint32_t count = 0;
    return !type.empty() && import_.out.material_table(import_.out.ctx, type.c_str(), &count);
}

bool Builder::material_of_plugin(const Directive& d, const std::string& type, Values& values, std::string& plugin) {
    const bool ours = d.params.has("plugin");
    std::uint32_t count = 0;
    const RestageParam* lines = import_.out.material_table(import_.out.ctx, type.c_str(), &count);
    if (!lines || (type == "measured" && is_rgl(d))) return false;
    plugin = type;
    for (std::uint32_t i = 0; i < count; ++i) {
        const RestageParam* line = &RESTAGE_AT(RestageParam, lines, i);
        if (!d.params.has(line->id)) continue;
        switch (line->type) {
            case RESTAGE_FLOAT:
                put_float(values, line->id, d, line->id, line->def[0]);
                break;
            case RESTAGE_COLOR:
                put_color(values, line->id, d, line->id, line->max <= 1 ? Role::albedo : Role::unbounded,
                          {line->def[0], line->def[1], line->def[2]});
                break;
            case RESTAGE_INT:
                values.integer(line->id, std::clamp(d.params.integer(line->id, 0), line->int_min, line->int_max));
                break;
            case RESTAGE_BOOL:
                values.boolean(line->id, d.params.boolean(line->id, false));
                break;
            case RESTAGE_ENUM:
                if (const Param* word = d.params.find(line->id, "string"); word && !word->strings.empty()) {
                    const std::string all = "|" + std::string(line->choices) + "|";
                    if (all.find("|" + word->strings[0] + "|") != std::string::npos)
                        values.choice(line->id, word->strings[0].c_str());
                    else
                        import_.approximated(d.at, "material " + quote(type),
                                             quote(line->id) + " cannot be " + quote(word->strings[0]) + "; " +
                                                 line->choices + " are possible; the default is used instead");
                }
                break;
            case RESTAGE_TABLE: // the host reads it, and reports its errors
                if (const std::string file = d.params.string(line->id, ""); !file.empty())
                    values.table(line->id, import_.resolve(file, d.at).string());
                break;
            default:
                break;
        }
    }
    if (ours) return true;
    if (type == "hair") { // pbrt's own, which may specify its colour differently
        if (d.params.has("reflectance")) {
            put_color(values, "color", d, "reflectance", Role::albedo, {0.5, 0.5, 0.5});
        } else if (!d.params.has("color")) {
            values.color("color", hair_color(d));
            for (const char* name : {"sigma_a", "eumelanin", "pheomelanin"})
                if (const Param* said = d.params.find(name)) exact_ += "=color " + to_text(*said) + "\n";
        }
        return true;
    }
    // It is written back verbatim unless edited ("=*": replaces everything that would be written).
    exact_ = "=* \"string type\" [ " + quote(type) + " ]\n";
    for (const Param& param : d.params.params)
        if (param.name != "type") exact_ += "=* " + to_text(param) + "\n";
    return true;
}

} // namespace restage::pbrt
