// SPDX-License-Identifier: Apache-2.0
// Textures and the image files they read.
#include "exporter.hpp"

#include <cmath>
#include <sstream>

namespace restage::pbrt_out {

namespace fs = std::filesystem;

namespace {

std::string extension_of(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    for (char& c : extension)
        c = static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    return extension;
}

bool is_float_file(const std::string& extension) {
    return extension == ".exr" || extension == ".pfm" || extension == ".hdr";
}

// Types whose coordinates are a point in space.
bool in_space(const std::string& type) {
    return type == "fbm" || type == "wrinkled" || type == "windy" || type == "marble" || type == "checkerboard3d";
}

// Of "Transform [ ... ]"; none of "".
std::optional<std::array<double, 16>> transform_of(const std::string& line) {
    std::istringstream words(line.substr(std::min(line.size(), line.find('[') + 1)));
    std::array<double, 16> m{};
    for (double& x : m)
        if (!(words >> x)) return std::nullopt;
    return m;
}

} // namespace

std::string Exporter::image_file(RestageHandle handle) {
    if (const auto it = images_.find(handle); it != images_.end()) return it->second;
    RestageImage image{};
    if (!in_.image(in_.ctx, handle, &image)) return "";
    std::string& file = images_[handle];
    std::error_code code;
    if (*image.path && fs::exists(image.path, code)) return file = places_.of(image.path);
    if (image.pixels) return file = places_.of_pixels(image);
    dropped(std::string("image \"") + image.name + "\"",
            std::string("its file is missing; its name is written unchanged: ") + image.path);
    Params as_written; // the importer's stand-in for a missing file
    for (const std::string& line : lines(image.origin->verbatim))
        as_written.add_raw(line);
    as_written.map_strings([&](const std::string& name) { return file = name; });
    if (file.empty()) file = image.path;
    told_missing_.insert(file);
    return file;
}

// `"rgb tex" [..]`, `"float tex" ..` or `"texture tex" "name"`.
void Exporter::put_argument(Params& params, const Values& values, const char* id, const char* name, bool is_float,
                            float otherwise) {
    if (const RestageHandle handle = values.ref(id)) {
        if (const std::string texture_name = texture(handle, is_float); !texture_name.empty()) {
            params.add("texture", name, quote(texture_name));
            return;
        }
        const auto mean = average(handle);
        if (is_float)
            params.add_float(name, mean[0]);
        else
            params.add_rgb(name, mean);
        return;
    }
    if (is_float)
        params.add_float(name, values.color(id, {otherwise, otherwise, otherwise})[0]);
    else
        params.add_rgb(name, values.color(id, {otherwise, otherwise, otherwise}));
}

void Exporter::put_image_texture(Params& params, const RestageTexture& t, const Values& values,
                                 const std::string& what) {
    params.add_string("filename", image_file(t.image));
    RestageImage image{};
    in_.image(in_.ctx, t.image, &image);
    const std::string extension = *image.path ? extension_of(image.path) : ".pfm";
    const bool png = extension == ".png", linear = image.encoding == RESTAGE_LINEAR;
    if (is_float_file(extension)) {
        // always linear
    } else if (v3()) {
        if (image.encoding == RESTAGE_GAMMA) approximated(what, "pbrt-v3 has no gamma but sRGB, which is written");
        if (linear == (png || extension == ".tga")) flag(params, "gamma", !linear);
    } else if (png && image.encoding != RESTAGE_SRGB) {
        params.add_string("encoding", linear ? "linear" : "gamma " + number(image.gamma));
    } else if (!png && image.encoding != RESTAGE_SRGB) {
        approximated(what, "pbrt-v4 reads " + extension + " files always as sRGB; this one is read as linear here");
    }
    if (const float scale = values.number("scale", 1); scale != 1) params.add_float("scale", scale);
    if (values.boolean("invert", false)) {
        if (v3())
            approximated(what, "pbrt-v3 cannot invert a picture; it is written without inversion");
        else
            flag(params, "invert", true);
    }
    if (const std::string wrap = values.choice("wrap", "repeat"); wrap != "repeat") params.add_string("wrap", wrap);
}

// v3: tex1 * tex2, both of the texture's kind. v4: tex * scale, the scale a scalar.
void Exporter::put_scale_texture(Params& params, const RestageTexture& t, const Values& values,
                                 const std::string& what) {
    const bool is_float = t.is_float != 0;
    if (v3()) {
        put_argument(params, values, "tex", "tex1", is_float, 1);
        put_argument(params, values, "scale", "tex2", is_float, 1);
        return;
    }
    const auto scalar = [&](const char* id) { // constant grey, or a float texture
        RestageTexture other{};
        if (const RestageHandle h = values.ref(id)) return in_.texture(in_.ctx, h, &other) && other.is_float;
        const auto c = values.color(id, {1, 1, 1});
        return c[0] == c[1] && c[1] == c[2];
    };
    if (!is_float && !values.ref("tex") && !values.ref("scale")) {
        const auto a = values.color("tex", {1, 1, 1}), b = values.color("scale", {1, 1, 1});
        params.add_rgb("tex", {a[0] * b[0], a[1] * b[1], a[2] * b[2]}).add_float("scale", 1.f);
        return;
    }
    const char *tex = "tex", *scale = "scale";
    if (!scalar(scale) && scalar(tex)) std::swap(tex, scale); // a product: the order does not matter
    if (!scalar(scale))
        approximated(what, "pbrt-v4 multiplies a texture by a scalar only; the mean of the second factor is written");
    put_argument(params, values, tex, "tex", is_float, 1);
    if (values.ref(scale) && scalar(scale)) {
        put_argument(params, values, scale, "scale", true, 1);
    } else {
        const auto c = values.ref(scale) ? average(values.ref(scale)) : values.color(scale, {1, 1, 1});
        params.add_float("scale",
                         c[0] == c[1] && c[1] == c[2] ? c[0] : 0.212639f * c[0] + 0.715169f * c[1] + 0.072192f * c[2]);
    }
}

std::string Exporter::placing(const Values& values, const std::string& imported, const std::string& what) {
    static constexpr const char* ids[3][4] = {{"x_from_x", "x_from_y", "x_from_z", "origin_x"},
                                              {"y_from_x", "y_from_y", "y_from_z", "origin_y"},
                                              {"z_from_x", "z_from_y", "z_from_z", "origin_z"}};
    std::array<double, 16> to_texture{};
    to_texture[15] = 1;
    bool any = false;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            any = any || values.find(ids[row][column]);
            to_texture[4 * column + row] =
                static_cast<double>(values.number(ids[row][column], row == column ? 1.f : 0.f));
        }
    if (!any) return imported;
    if (const auto before = transform_of(imported))
        if (const auto same = inverse(before->data())) {
            bool equal = true;
            for (std::size_t k = 0; k < 16; ++k)
                equal = equal && std::abs((*same)[k] - to_texture[k]) <= 1e-6 * std::max(1.0, std::abs(to_texture[k]));
            if (equal) return imported;
        }
    const auto to_scene = inverse(to_texture.data());
    if (!to_scene) {
        approximated(what,
                     "its coordinates lie in a plane or on a line, which pbrt's transforms cannot express; the "
                     "scene's are written");
        return "";
    }
    std::string line = "Transform [";
    for (const double m : *to_scene)
        line += " " + number(m);
    return line + " ]\n";
}

// uscale and so on; or the kinds of mapping that are not rendered here.
void Exporter::put_mapping(Params& params, const Values& values, const std::string& what) {
    const float ushear = values.number("ushear", 0), vshear = values.number("vshear", 0);
    const auto put = [&](const char* id, float value, float otherwise) {
        if (value != otherwise) params.add_float(id, value);
    };
    // As many repetitions as along the rotated directions.
    const auto scale = [&](const char* id, float shear) {
        const float value = values.number(id, 1);
        return shear == 0 ? value : std::copysign(std::hypot(value, shear), value);
    };
    put("uscale", scale("uscale", ushear), 1);
    put("vscale", scale("vscale", vshear), 1);
    put("udelta", values.number("udelta", 0), 0);
    put("vdelta", values.number("vdelta", 0), 0);
    if (ushear != 0 || vshear != 0)
        approximated(
            what, "it is rotated on the surface, but pbrt's mapping only scales and shifts; the rotation is dropped");
    if (values.number("uvset", 0) == 1)
        approximated(what,
                     "it uses the second texture coordinates of its meshes, but pbrt's have only one set, which is "
                     "used instead");
    const std::string mapping = values.choice("mapping", "uv");
    if (mapping == "uv") return;
    params.add_string("mapping", mapping);
    for (const char* id : {"v1", "v2"})
        if (values.find(id)) {
            const auto v = values.color(id, {0, 0, 0});
            params.add(v3() ? "vector" : "vector3", id, number(v[0]) + " " + number(v[1]) + " " + number(v[2]));
        }
}

// Classes that both versions have, but that are not rendered here. False: another class.
bool Exporter::put_procedural(Params& params, const RestageTexture& t, const Values& values, const std::string& what,
                              std::string& type) {
    const bool is_float = t.is_float != 0;
    const auto put_all = [&](std::initializer_list<const char*> ids, bool first_is_one) {
        bool one = first_is_one;
        for (const char* id : ids) {
            put_argument(params, values, id, id, is_float, one ? 1.f : 0.f);
            one = !one;
        }
    };
    if (type == "checkerboard" || type == "checkerboard3d") {
        type = "checkerboard";
        params.add_int("dimension", 3);
        put_all({"tex1", "tex2"}, true);
    } else if (type == "dots") {
        put_all({"inside", "outside"}, true);
        put_mapping(params, values, what);
    } else if (type == "bilerp") {
        put_all({"v00", "v01", "v10", "v11"}, false);
        put_mapping(params, values, what);
    } else if (type == "directionmix" && !v3()) {
        put_all({"tex1", "tex2"}, false);
        const auto v = values.color("dir", {0, 1, 0});
        params.add("vector3", "dir", number(v[0]) + " " + number(v[1]) + " " + number(v[2]));
    } else if (type == "fbm" || type == "wrinkled" || type == "windy" || type == "marble") {
        if (type == "marble" && is_float) return false; // of colours only, in both
        if (type != "windy") {
            params.add_int("octaves", static_cast<long long>(values.number("octaves", 8)));
            params.add_float("roughness", values.number("roughness", 0.5f));
        }
        if (type == "marble")
            params.add_float("scale", values.number("scale", 1))
                .add_float("variation", values.number("variation", 0.2f));
    } else if (type == "uv" && !is_float) {
        put_mapping(params, values, what);
        if (v3()) return true;
        type = "bilerp"; // identical for uv in [0,1]
        params.add_rgb("v00", {0, 0, 0}).add_rgb("v01", {0, 1, 0}).add_rgb("v10", {1, 0, 0}).add_rgb("v11", {1, 1, 0});
        approximated(what, "pbrt-v4 has no texture \"uv\"; a bilerp is written, which is identical for uv in [0,1]");
    } else {
        return false;
    }
    return true;
}

std::string Exporter::texture(RestageHandle handle, std::optional<bool> as_float) {
    RestageTexture t{};
    if (!in_.texture(in_.ctx, handle, &t)) return "";
    const bool is_float = as_float.value_or(t.is_float != 0), other_kind = is_float != (t.is_float != 0);
    t.is_float = is_float ? 1 : 0;
    std::string& known = textures_.try_emplace({handle, is_float}).first->second;
    if (!known.empty() || !writing_.insert({handle, is_float}).second) return known; // breaks cycles
    const std::string what = std::string("texture \"") + t.name + "\"", type = t.type;
    std::string place, rest; // its transform has the same meaning in both versions
    for (const std::string& line : lines(t.origin->verbatim))
        (line.starts_with("Transform [") ? place : rest) += line + "\n";
    const Kept k = kept({.value_count = t.origin->value_count,
                         .format = t.origin->format,
                         .verbatim = rest.c_str(),
                         .values = t.origin->values},
                        what);
    const Values values(t.values, t.value_count);
    if (in_space(type)) place = placing(values, place, what);
    Params params;
    std::string written = type;
    if (type == "constant") {
        put_argument(params, values, "value", "value", is_float, 1);
    } else if (type == "imagemap" && !t.image) {
        written = "constant";
        approximated(what, "it has no image; its grey is written");
        put_argument(params, values, "average", "value", is_float, 0.5f);
    } else if (type == "imagemap") {
        if (other_kind && is_float) // is_float: the first channel here
            approximated(what,
                         "it is a colour where one number is needed; pbrt uses the mean of red, green and blue "
                         "instead of the red");
        put_image_texture(params, t, values, what);
        put_mapping(params, values, what);
    } else if (type == "scale") {
        put_scale_texture(params, t, values, what);
    } else if (type == "mix") {
        put_argument(params, values, "tex1", "tex1", is_float, 0);
        put_argument(params, values, "tex2", "tex2", is_float, 1);
        put_argument(params, values, "amount", "amount", true, 0.5f);
    } else if (type == "checkerboard" && !values.find("average")) {
        put_argument(params, values, "tex1", "tex1", is_float, 1);
        put_argument(params, values, "tex2", "tex2", is_float, 0);
        put_mapping(params, values, what);
    } else if (!put_procedural(params, t, values, what, written) && k.lines.empty()) {
        if (std::string_view(t.origin->format) != format()) {
            written = "constant"; // of the other version or a plugin's: its average is the best available
            approximated(what + " (" + type + ")",
                         std::string(format()) + " has no such texture; its average is written");
            const auto mean = average(handle);
            if (is_float)
                params.add_float("value", mean[0]);
            else
                params.add_rgb("value", mean);
        } else { // of a plugin: written unchanged
            for (std::uint32_t i = 0; i < t.value_count; ++i) {
                const RestageValue& v = RESTAGE_AT(RestageValue, t.values, i);
                if (v.type == RESTAGE_FLOAT) put_argument(params, values, v.id, v.id, true, 0);
                if (v.type == RESTAGE_COLOR && std::string_view(v.id) != "average")
                    put_argument(params, values, v.id, v.id, is_float, 0);
                if (v.type == RESTAGE_INT) params.add_int(v.id, v.i);
                if (v.type == RESTAGE_BOOL) flag(params, v.id, v.i != 0);
                if (v.type == RESTAGE_ENUM && v.text && *v.text) params.add_string(v.id, v.text);
            }
        }
    }
    for (const std::string& line : k.lines)
        params.add_raw(line);
    comment(k.foreign);
    const std::string name = unique_name("texture", t.name);
    const char* block = v3() ? "Transform" : "Attribute"; // v3 scopes names to attribute blocks
    if (!place.empty()) text_ += std::string(block) + "Begin\n" + place;
    const bool only_scalar = !v3() && !is_float && (written == "fbm" || written == "wrinkled" || written == "windy");
    const std::string scalar = only_scalar ? unique_name("texture", name + " scalar") : name;
    text_ += "Texture " + quote(scalar) + (is_float || only_scalar ? " \"float\" " : " \"spectrum\" ") +
             quote(written) + " " + finished(params, what) + "\n";
    if (only_scalar) // v4 has them as scalars only
        text_ += "Texture " + quote(name) + " \"spectrum\" \"scale\" \"rgb tex\" [ 1 1 1 ] \"texture scale\" [ " +
                 quote(scalar) + " ]\n";
    if (!place.empty()) text_ += std::string(block) + "End\n";
    return known = name;
}

} // namespace restage::pbrt_out
