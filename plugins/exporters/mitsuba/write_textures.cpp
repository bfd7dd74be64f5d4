// SPDX-License-Identifier: Apache-2.0
// Textures as bitmaps. Arithmetic with constants is done on the texels, in a new picture.
#include "exporter.hpp"

#include "common/text.hpp"

#include <algorithm>
#include <cmath>

namespace restage::mitsuba_out {

namespace fs = std::filesystem;

namespace {

std::string what_of(const RestageTexture& t) { return std::string("texture \"") + t.name + "\""; }

} // namespace

std::optional<Exporter::Flat> Exporter::flat_value(const Values& v, const char* id, float otherwise, int depth) {
    if (v.ref(id)) return flat(v.ref(id), depth + 1);
    return Flat{0, {1, 1, 1}, v.color(id, {otherwise, otherwise, otherwise})};
}

std::optional<Exporter::Flat> Exporter::flat(RestageHandle handle, int depth) {
    RestageTexture t{};
    if (depth > 16 || !in_.texture(in_.ctx, handle, &t)) return std::nullopt;
    const Values v(t.values, t.value_count);
    const std::string type = t.type;
    if (type == "constant") return flat_value(v, "value", 1, depth);
    if (type == "imagemap" && t.image) {
        const bool inverts = v.boolean("invert", false); // after the scale, as in pbrt-v4
        const float mul = (inverts ? -1.f : 1.f) * v.number("scale", 1), add = inverts ? 1.f : 0.f;
        return Flat{handle, {mul, mul, mul}, {add, add, add}};
    }
    const bool scaled = type == "scale";
    if (!scaled && type != "mix") return std::nullopt;
    const auto one = flat_value(v, scaled ? "tex" : "tex1", scaled ? 1.f : 0.f, depth),
               two = flat_value(v, scaled ? "scale" : "tex2", 1, depth), amount = flat_value(v, "amount", 0.5f, depth);
    if (!one || !two || !amount || (one->texture && two->texture) || amount->texture) return std::nullopt;
    const Flat &picture = two->texture ? *two : *one, &constant = two->texture ? *one : *two;
    Flat out{picture.texture, picture.mul, picture.add};
    for (std::size_t c = 0; c < 3; ++c) {
        const float share = two->texture ? amount->add[0] : 1 - amount->add[0];
        out.mul[c] *= scaled ? constant.add[c] : share;
        out.add[c] = scaled ? picture.add[c] * constant.add[c] : share * picture.add[c] + (1 - share) * constant.add[c];
    }
    return out;
}

// Ours: st = uv * scale + delta, and t = 0 is the bottom row of a picture; Mitsuba's is the top one.
void Exporter::put_mapping(Xml& xml, const Values& v, double scale, bool of_picture, const std::string& what) {
    if (v.number("uvset", 0) == 1)
        approximated(what,
                     "it uses the second texture coordinates of its meshes; Mitsuba's have one set, which is used");
    if (v.choice("mapping", "uv") != "uv")
        approximated(what, "its mapping \"" + v.choice("mapping", "uv") + "\" is unknown to Mitsuba; uv are used");
    const auto number_of = [&](const char* id, float otherwise) {
        return scale * static_cast<double>(v.number(id, otherwise));
    };
    Matrix m{};
    m[0] = number_of("uscale", 1);
    m[4] = number_of("ushear", 0);
    m[12] = number_of("udelta", 0);
    m[1] = number_of("vshear", 0);
    m[5] = number_of("vscale", 1);
    m[13] = number_of("vdelta", 0);
    m[10] = m[15] = 1;
    if (of_picture) {
        m[1] = 0 - m[1];
        m[5] = 0 - m[5];
        m[13] = 1 - m[13];
    }
    if (!is_identity(m.data())) xml.matrix("to_uv", m);
}

// Mitsuba takes 8-bit files as sRGB, or raw; a scalar of a coloured picture is its luminance there, its red here. What
// it would read otherwise is written as linear floats.
std::string Exporter::bitmap_file(const Flat& f, bool scalar, Function of_texel, bool& raw) {
    RestageTexture t{};
    in_.texture(in_.ctx, f.texture, &t);
    RestageImage image{};
    if (!in_.image(in_.ctx, t.image, &image)) return "";
    std::error_code code;
    const bool exists = *image.path && fs::exists(image.path, code);
    const bool same = f.mul == Color{1, 1, 1} && f.add == Color{0, 0, 0} && !of_texel;
    raw = image.encoding == RESTAGE_LINEAR;
    const bool reads_alike = image.encoding != RESTAGE_GAMMA && !(scalar && image.channels > 1);
    if (same && exists && (reads_alike || !image.pixels) &&
        std::string_view(image.path).find('$') == std::string_view::npos)
        return places_.of(image.path); // a '$' would begin a parameter
    if (!image.pixels) {
        dropped(std::string("image \"") + image.name + "\"", "its pixels cannot be read; the texture is grey instead");
        return "";
    }
    raw = scalar;
    const std::uint32_t channels = scalar || image.channels == 1 ? 1 : 3;
    const bool coloured =
        channels == 1 && !scalar &&
        !(f.mul[0] == f.mul[1] && f.mul[1] == f.mul[2] && f.add[0] == f.add[1] && f.add[1] == f.add[2]);
    const std::uint32_t made = coloured ? 3 : channels;
    std::vector<float> pixels(std::size_t{image.width} * image.height * made);
    for (std::size_t p = 0; p < std::size_t{image.width} * image.height; ++p)
        for (std::size_t c = 0; c < made; ++c) {
            const float texel = image.pixels[p * image.channels + (image.channels >= 3 ? c : 0)];
            const float x = f.mul[c] * texel + f.add[c];
            pixels[p * made + c] = of_texel ? of_texel(x) : x;
        }
    RestageImage own = image;
    own.channels = made;
    own.pixels = pixels.data();
    return places_.of_pixels(own);
}

std::string Exporter::bitmap(const Flat& f, bool scalar, Function of_texel) {
    std::string key = std::to_string(f.texture) + (scalar ? " scalar " : " ") +
                      std::to_string(reinterpret_cast<std::uintptr_t>(of_texel)); // only for equality
    for (const Color* c : {&f.mul, &f.add})
        for (const float x : *c)
            key += " " + number(x);
    if (const auto it = texture_ids_.find(key); it != texture_ids_.end()) return it->second;
    RestageTexture t{};
    in_.texture(in_.ctx, f.texture, &t);
    report_kept(*t.origin, what_of(t));
    const Values v(t.values, t.value_count);
    bool raw = false;
    const std::string file = bitmap_file(f, scalar, of_texel, raw);
    if (file.empty()) return texture_ids_[key] = "";
    const std::string id = unique_id("texture", t.name);
    textures_.open("texture", "bitmap", id);
    textures_.put("filename", std::string_view(file));
    if (raw) textures_.flag("raw", true);
    const std::string wrap = v.choice("wrap", "repeat");
    if (wrap != "repeat") textures_.put("wrap_mode", std::string_view("clamp"));
    if (wrap != "repeat" && wrap != "clamp")
        approximated(what_of(t), "it is " + wrap + " outside of the picture; Mitsuba repeats its border there");
    put_mapping(textures_, v, 1, true, what_of(t));
    textures_.close();
    return texture_ids_[key] = id;
}

// Of two constants. Mitsuba's squares have sides of half a unit of uv.
std::string Exporter::checkerboard(RestageHandle handle, const RestageTexture& t) {
    const Values v(t.values, t.value_count);
    const auto one = flat_value(v, "tex1", 1, 0), two = flat_value(v, "tex2", 0, 0);
    if (std::string_view(t.type) != "checkerboard" || !one || !two || one->texture || two->texture) return "";
    std::string& id = texture_ids_["board " + std::to_string(handle)];
    if (!id.empty()) return id;
    id = unique_id("texture", t.name);
    textures_.open("texture", "checkerboard", id);
    textures_.rgb("color0", one->add);
    textures_.rgb("color1", two->add);
    put_mapping(textures_, v, 0.5, false, what_of(t));
    textures_.close();
    return id;
}

void Exporter::put_texture(Xml& xml, const char* name, RestageHandle handle, bool scalar, Function of_texel) {
    RestageTexture t{};
    in_.texture(in_.ctx, handle, &t);
    const auto put = [&](Color c) {
        if (of_texel) std::transform(c.begin(), c.end(), c.begin(), of_texel);
        if (scalar)
            xml.put(name, c[0]);
        else
            xml.rgb(name, c);
    };
    const auto one = flat(handle);
    if (one && !one->texture) return put(one->add);
    const std::string id = one ? bitmap(*one, scalar, of_texel) : !of_texel ? checkerboard(handle, t) : "";
    if (!id.empty()) return xml.ref(id, name);
    if (!one) approximated(what_of(t) + " (" + t.type + ")", "Mitsuba has no such texture; its average is written");
    put(average(in_, handle));
}

void Exporter::put_number(Xml& xml, const char* name, const Values& v, const char* id, float otherwise) {
    if (v.ref(id))
        put_texture(xml, name, v.ref(id), true);
    else
        xml.put(name, v.number(id, otherwise));
}

void Exporter::put_color(Xml& xml, const char* name, const Values& v, const char* id, Color otherwise) {
    if (v.ref(id)) return put_texture(xml, name, v.ref(id), false);
    Color c = v.color(id, otherwise);
    for (float& x : c)
        x = std::clamp(x, 0.f, 1.f); // as it is rendered; Mitsuba refuses more
    xml.rgb(name, c);
}

} // namespace restage::mitsuba_out
