// SPDX-License-Identifier: Apache-2.0
// Textures and arguments that may be textures. Images are passed by name to the host, which reads them.
#include "builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>

namespace restage::pbrt {

namespace {

std::string lower_extension(const std::string& file) {
    std::string out = std::filesystem::path(file).extension().string();
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

// The table of the host's plugin for this type of texture; null if there is none.
const RestageParam* texture_table(const RestageSceneWriter1& out, const std::string& type, std::uint32_t& count) {
    count = 0;
    if (out.size < offsetof(RestageSceneWriter1, texture_table) + sizeof out.texture_table || !out.texture_table)
        return nullptr;
    return out.texture_table(out.ctx, type.c_str(), &count);
}

} // namespace

RestageHandle Builder::find_texture(const Directive& d, const char* name, bool is_float) {
    const std::string texture = d.params.texture(name);
    if (texture.empty()) return 0;
    const auto& own = is_float ? state_.names->float_textures : state_.names->color_textures;
    if (const auto found = own.find(texture); found != own.end()) {
        if (found->second == 0)
            import_.lost(d.at, "texture " + quote(texture) + " of \"" + name + "\"",
                         "it could not be created; the default is used instead");
        return found->second;
    }
    if (const auto later = later_textures_.find({texture, is_float}); later != later_textures_.end()) {
        const Directive& made = *later->second;
        later_textures_.erase(later);
        constexpr int deepest_textures = 100;
        if (texture_depth_ >= deepest_textures)
            throw ImportError{d.at, "textures name each other more than 100 deep; flatten them"};
        ++texture_depth_;
        this->texture(made);
        --texture_depth_;
        made_textures_.insert({texture, is_float});
        return find_texture(d, name, is_float);
    }
    const auto& other = is_float ? state_.names->color_textures : state_.names->float_textures;
    const bool wrong_kind = other.count(texture) > 0;
    import_.lost(d.at, "texture " + quote(texture) + " of \"" + name + "\"",
                 wrong_kind
                     ? (is_float ? "it is a spectrum texture where a float one is needed; the default is used instead"
                                 : "it is a float texture where a spectrum one is needed; the default is used instead")
                     : "no texture has that name; the default is used instead");
    return 0;
}

Argument Builder::float_argument(const Directive& d, const char* name, double otherwise) {
    Argument out;
    out.texture = find_texture(d, name, true);
    double value = otherwise;
    if (out.texture == 0 && d.params.has(name) && d.params.find(name)->type != "texture") {
        const Param& param = *d.params.find(name);
        const bool is_color =
            param.type == "spectrum" || param.type == "rgb" || param.type == "color" || param.type == "blackbody";
        if (is_color && !import_.v3()) // pbrt-v3 looks for a float
            value = luminance(
                import_.color(d.params, name, Role::unbounded).value_or(Rgb{otherwise, otherwise, otherwise}));
        else
            value = d.params.number(name, otherwise);
    }
    out.value = {value, value, value};
    return out;
}

Argument Builder::color_argument(const Directive& d, const char* name, Role role, Rgb otherwise) {
    Argument out;
    out.texture = find_texture(d, name, false);
    out.value = out.texture ? otherwise : import_.color(d.params, name, role, otherwise);
    return out;
}

void Builder::put_float(Values& values, const char* id, const Directive& d, const char* name, double otherwise) {
    const Argument argument = float_argument(d, name, otherwise);
    if (files_are_missing_ && !argument.texture) keep_exact(id, d, name);
    if (argument.texture)
        values.texture(id, RESTAGE_FLOAT, argument.texture);
    else
        values.number(id, argument.value.r);
}

void Builder::put_color(Values& values, const char* id, const Directive& d, const char* name, Role role,
                        Rgb otherwise) {
    const Argument argument = color_argument(d, name, role, otherwise);
    keep_exact(id, d, name);
    if (argument.texture)
        values.texture(id, RESTAGE_COLOR, argument.texture);
    else
        values.color(id, argument.value);
    if (!argument.texture) keep_spectrum(id, argument.value, import_.given_spectrum(d.params, name));
}

void Builder::keep_spectrum(const char* id, Rgb value, const std::optional<Spectrum>& spectrum) {
    if (spectrum) exact_ += spectrum_line(id, value, *spectrum);
}

// A spectrum, a temperature or a colour of another space is written back unchanged, unless its value is edited.
void Builder::keep_exact(const char* id, const Directive& d, const char* name) {
    if (!d.params.has(name)) return;
    const Param& param = *d.params.find(name);
    if (param.type == "texture" && files_are_missing_ && param.strings.size() == 1) { // a missing file may define it
        for (const auto* map : {&state_.names->float_textures, &state_.names->color_textures})
            if (map->count(param.strings[0])) return;
        exact_ += std::string("=") + id + " " + to_text(param) + "\n";
        return;
    }
    const bool is_rgb = (param.type == "rgb" || param.type == "color") && param.color_space == ColorSpace::srgb;
    if (is_rgb || param.type == "texture" || param.type == "float") return;
    exact_ += std::string("=") + id + " " + to_text(param) + "\n";
}

RestageHandle Builder::image(const Directive& d, const std::string& file, RestageEncoding encoding, float gamma,
                             bool keep_missing) {
    const std::string path = import_.resolve(file, d.at).string();
    std::error_code code;
    std::string as_written; // of missing files
    if (!std::filesystem::is_regular_file(path, code)) {
        const bool there = std::filesystem::exists(path, code);
        import_.lost(d.at, "image " + quote(file),
                     (there ? "it is not a regular file: " : "there is no such file: ") + path);
        if (!keep_missing) return 0;
        as_written = "\"string filename\" [ " + quote(file) + " ]\n";
    }
    RestageHandle& handle = images_[path + '\n' + std::to_string(encoding) + '\n' + std::to_string(gamma)];
    if (handle) return handle;
    const std::string name = std::filesystem::path(path).stem().string();
    RestageImage image{.name = name.c_str(),
                       .origin = import_.origin(as_written),
                       .path = path.c_str(),
                       .encoding = static_cast<std::uint32_t>(encoding),
                       .gamma = gamma};
    handle = import_.out.image(import_.out.ctx, &image);
    if (!as_written.empty()) { // pbrt-v3 replaces it by a texel of 0.5, and decodes that (imagemap.cpp, GetTexture)
        constexpr double decoded = 0.21404114; // of sRGB
        missing_texels_[handle] = encoding == RESTAGE_SRGB    ? decoded
                                  : encoding == RESTAGE_GAMMA ? std::pow(0.5, static_cast<double>(gamma))
                                                              : 0.5;
    }
    return handle;
}

RestageHandle Builder::image_texture(const Directive& d, const char* what) {
    const std::string file = d.params.string("filename", "");
    if (file.empty()) {
        import_.lost(d.at, std::string(what) + " " + quote(d.name), "it names no file");
        return 0;
    }
    // How 8-bit texels are encoded; float files are always linear. pbrt-v3 imagemap.cpp: "gamma" is sRGB,
    // default true for TGA and PNG. pbrt-v4 textures.cpp: PNG obeys "encoding" (default sRGB), while all that stb
    // reads (TGA, JPEG, BMP) is sRGB always (image.cpp). Scalar and colour textures are alike in both.
    RestageEncoding encoding = RESTAGE_SRGB;
    float gamma = 2.2f;
    const std::string extension = lower_extension(file);
    const std::string asked = d.params.string("encoding", "sRGB");
    const Param* power = d.params.has("gamma") ? d.params.find("gamma", "float") : nullptr;
    if (power && power->numbers.size() == 1 && power->numbers[0] > 0) { // pbrt-v2: texels to this power
        gamma = static_cast<float>(power->numbers[0]);
        encoding = gamma == 1 ? RESTAGE_LINEAR : RESTAGE_GAMMA;
        import_.warned(power->at, "\"float gamma\" of " + std::string(what) + " " + quote(d.name),
                       "of pbrt-v2; texels are taken to this power, which pbrt-v3 leaves out");
    } else if (import_.v3() || d.params.has("gamma")) {
        encoding =
            d.params.boolean("gamma", extension == ".tga" || extension == ".png") ? RESTAGE_SRGB : RESTAGE_LINEAR;
    } else if (extension == ".png") {
        if (asked == "linear") {
            encoding = RESTAGE_LINEAR;
        } else if (asked.starts_with("gamma ")) {
            encoding = RESTAGE_GAMMA;
            gamma = static_cast<float>(parse_double(asked.substr(6)).value_or(2.2));
        } else if (asked != "sRGB") {
            import_.warned(d.at, std::string(what) + " " + quote(d.name),
                           "encoding " + quote(asked) + " is unknown; sRGB is taken");
        }
    }
    return image(d, file, encoding, gamma, true);
}

// Shapes of pbrt's texture classes in the host's terms; those without one keep their text and shade as an average.
void Builder::texture(const Directive& d) {
    const bool is_float = d.second == "float";
    if (!is_float && d.second != "spectrum" && d.second != "color")
        throw ImportError{d.at, "Texture " + quote(d.name) + " has the value type " + quote(d.second) +
                                    "; write \"float\" or \"spectrum\""};
    const RestageHandle handle = simple_texture(d, is_float);
    if (is_float && d.third == "constant" && d.params.has("value") && d.params.number("value", 1) <= 0)
        zero_textures_.insert(handle);
    Names& names = writable_names();
    RestageHandle& named = (is_float ? names.float_textures : names.color_textures)[d.name];
    if (named) import_.warned(d.at, "Texture " + quote(d.name), "is defined again; from here on this one counts");
    named = handle;
}

RestageHandle Builder::simple_texture(const Directive& d, bool is_float) {
    const Rgb zero{0, 0, 0}, one{1, 1, 1}, half{0.5, 0.5, 0.5};
    const std::string what = "Texture " + quote(d.name);
    Values values;
    std::string kept; // not supported by the renderer
    bool placed = false; // depends on the transform it is defined in
    std::uint32_t count = 0;
    const bool cubes = d.third == "checkerboard" && d.params.integer("dimension", 2) == 3; // a separate type here
    const std::string own_type = cubes ? "checkerboard3d" : d.third;
    const RestageParam* const table = texture_table(import_.out, own_type, count);
    const bool type_is_rendered =
        cubes ? table != nullptr : d.third == "checkerboard" || d.third == "imagemap" || table != nullptr;
    RestageTexture out{.type = cubes && !table ? d.third.c_str() : own_type.c_str(), .is_float = is_float ? 1u : 0u};
    const auto argument = [&](const char* name, Rgb otherwise) {
        return is_float ? float_argument(d, name, otherwise.r) : color_argument(d, name, Role::albedo, otherwise);
    };
    const auto put = [&](const char* id, const char* name, Rgb otherwise) {
        const Argument a = argument(name, otherwise);
        if (a.texture)
            values.texture(id, RESTAGE_COLOR, a.texture);
        else
            values.color(id, a.value);
    };
    const auto put_mapping = [&] {
        for (const char* id : {"uscale", "vscale"})
            values.number(id, d.params.number(id, 1));
        for (const char* id : {"udelta", "vdelta"})
            values.number(id, d.params.number(id, 0));
        const std::string mapping = d.params.string("mapping", "uv");
        const char* others[] = {"spherical", "cylindrical", "planar"};
        const auto other = std::find(std::begin(others), std::end(others), mapping);
        if (other == std::end(others)) {
            if (mapping != "uv") import_.warned(d.at, what, "mapping " + quote(mapping) + " is unknown; uv is taken");
            return;
        }
        if (type_is_rendered) import_.approximated(d.at, what, "mapping " + quote(mapping) + " is done by uv instead");
        values.choice("mapping", *other); // written back
        for (const char* id : {"v1", "v2"})
            if (d.params.has(id)) {
                const auto v = d.params.triple(id, {0, 0, 0});
                values.color(id, {v[0], v[1], v[2]});
            }
        placed = true;
    };
    // An unrendered class: its own values, for exporters, and an average to show.
    const auto put_average = [&](Rgb average, const char* note) {
        values.color("average", average);
        if (!type_is_rendered) import_.approximated(d.at, what + " (" + d.third + ")", note);
    };
    const auto put_in_space = [&](bool has_octaves) { // placed by the texture's transform
        placed = true;
        if (const auto to_texture = table ? inverse(ctm(d)) : std::nullopt; to_texture && !(*to_texture == Matrix{})) {
            const char* const ids[3][4] = {{"x_from_x", "x_from_y", "x_from_z", "origin_x"},
                                           {"y_from_x", "y_from_y", "y_from_z", "origin_y"},
                                           {"z_from_x", "z_from_y", "z_from_z", "origin_z"}};
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column)
                    values.number(ids[row][column], to_texture->at(row, column));
        }
        if (!has_octaves) return;
        values.integer("octaves", d.params.integer("octaves", 8));
        values.number("roughness", d.params.number("roughness", 0.5));
    };
    const std::string& type = d.third;
    if (type == "constant") {
        put("value", "value", one);
    } else if (type == "scale") { // v3: tex1 and tex2; v4: tex and scale, the scale a scalar
        const bool old = !d.params.has("tex") && !d.params.has("scale");
        put("tex", old ? "tex1" : "tex", one);
        if (old) {
            put("scale", "tex2", one);
        } else {
            const Argument a = float_argument(d, "scale", 1);
            if (a.texture)
                values.texture("scale", RESTAGE_COLOR, a.texture);
            else
                values.color("scale", a.value);
        }
    } else if (type == "mix") {
        put("tex1", "tex1", zero);
        put("tex2", "tex2", one);
        put_float(values, "amount", d, "amount", 0.5);
    } else if (type == "checkerboard" && !cubes) {
        if (const int n = d.params.integer("dimension", 2); n != 2)
            import_.warned(d.at, what,
                           "a checkerboard's dimension must be 2 or 3, not " + std::to_string(n) + "; 2 is taken");
        put("tex1", "tex1", one);
        put("tex2", "tex2", zero);
        put_mapping();
    } else if (type == "imagemap") {
        out.image = image_texture(d, "Texture");
        if (out.image == 0) return 0;
        values.number("scale", d.params.number("scale", 1));
        values.boolean("invert", d.params.boolean("invert", false));
        if (const auto grey = missing_texels_.find(out.image); import_.v3() && grey != missing_texels_.end()) {
            const double shown = grey->second * d.params.number("scale", 1);
            values.color("average", {shown, shown, shown});
        }
        const std::string wrap = d.params.string("wrap", "repeat");
        const char* modes[] = {"repeat", "black", "clamp"};
        const auto mode = std::find(std::begin(modes), std::end(modes), wrap);
        if (mode == std::end(modes)) import_.warned(d.at, what, "wrap " + quote(wrap) + " is done as repeat");
        values.choice("wrap", mode == std::end(modes) ? "repeat" : *mode);
        put_mapping();
        for (const char* quiet : {"filter", "maxanisotropy", "trilinear"}) // affects sampling only
            if (d.params.has(quiet)) (kept += to_text(*d.params.find(quiet))) += '\n';
    } else if (type == "checkerboard" || type == "dots" || type == "bilerp" || type == "directionmix") {
        const char *corners[] = {"v00", "v01", "v10", "v11"}, *sides[] = {"inside", "outside"},
                   *pair[] = {"tex1", "tex2"};
        const std::span<const char* const> ids = type == "bilerp" ? std::span<const char* const>(corners)
                                                 : type == "dots" ? std::span<const char* const>(sides)
                                                                  : std::span<const char* const>(pair);
        Rgb average;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            const bool first_is_one = type == "dots" || type == "checkerboard";
            const Rgb otherwise = (i % 2 == 0) == first_is_one ? one : zero;
            put(ids[i], ids[i], otherwise);
            const Argument part = argument(ids[i], otherwise);
            average = average + part.value * (1.0 / static_cast<double>(ids.size()));
        }
        put_average(average, "shades as the average of its colours");
        if (cubes) {
            if (!table) values.integer("dimension", 3);
            put_in_space(false);
        } else if (type == "directionmix") {
            const auto v = d.params.triple("dir", {0, 1, 0});
            values.color("dir", {v[0], v[1], v[2]});
            placed = true;
        } else {
            put_mapping();
        }
    } else if (type == "marble") { // the mean of its nine colours (pbrt-v3 marble.cpp)
        put_average({0.52, 0.52, 0.56}, "shades as its average colour");
        put_in_space(true);
        values.number("scale", d.params.number("scale", 1));
        values.number("variation", d.params.number("variation", 0.2));
    } else if (type == "uv") {
        put_average({0.5, 0.5, 0}, "shades as its average colour");
        put_mapping();
    } else if (type == "fbm" || type == "wrinkled" || type == "windy") {
        put_average(half, "shades as a grey of 0.5");
        put_in_space(type != "windy");
    } else if (table) { // of a plugin that pbrt does not know: by its table
        for (std::uint32_t i = 0; i < count; ++i) {
            const RestageParam& line = RESTAGE_AT(RestageParam, table, i);
            if (!d.params.has(line.id)) continue;
            if (line.type == RESTAGE_FLOAT)
                put_float(values, line.id, d, line.id, line.def[0]);
            else if (line.type == RESTAGE_COLOR)
                put(line.id, line.id, {line.def[0], line.def[1], line.def[2]});
            else if (line.type == RESTAGE_INT)
                values.integer(line.id, std::clamp(d.params.integer(line.id, 0), line.int_min, line.int_max));
            else if (line.type == RESTAGE_BOOL)
                values.boolean(line.id, d.params.boolean(line.id, false));
            else if (line.type == RESTAGE_ENUM)
                values.choice(line.id, d.params.string(line.id, "").c_str());
        }
        if (d.params.has("filename")) out.image = image_texture(d, "Texture");
    } else {
        const bool known = type == "ptex";
        put_average(half, known ? "shades as a grey of 0.5" : "no such texture class in pbrt; shades as a grey of 0.5");
        if (!known) import_.lost(d.at, what, "there is no texture class " + quote(type) + " in pbrt");
        d.params.mark_all_used();
        kept = to_text(d.params, "\n");
        if (!kept.empty()) kept += '\n';
        missing_files_of(d, what);
    }
    if (placed && !(ctm(d) == Matrix{})) { // of neither version
        kept += "Transform [";
        for (const double m : state_.ctm[0].m)
            kept += " " + shortest(m);
        kept += " ]\n";
    }
    kept += import_.keep_unused(d.params, what);
    out.name = d.name.c_str();
    out.origin = import_.origin(kept);
    out.values = values.data();
    out.value_count = values.size();
    const RestageHandle made = import_.out.texture(import_.out.ctx, &out);
    if (type == "constant")
        if (const Argument value = argument("value", one); !value.texture) constants_[made] = value.value;
    return made;
}

std::optional<Rgb> Builder::constant_of(RestageHandle texture) const {
    const auto found = constants_.find(texture);
    return found == constants_.end() ? std::nullopt : std::optional(found->second);
}

RestageHandle Builder::scaled_texture(RestageHandle texture, double scale, bool is_float) {
    RestageHandle& handle = scaled_textures_[{texture, scale}];
    if (handle) return handle;
    Values values;
    values.texture("tex", RESTAGE_COLOR, texture);
    values.color("scale", {scale, scale, scale});
    RestageTexture out{.name = "",
                       .origin = import_.origin(),
                       .type = "scale",
                       .is_float = is_float ? 1u : 0u,
                       .values = values.data(),
                       .value_count = values.size()};
    handle = import_.out.texture(import_.out.ctx, &out);
    return handle;
}

} // namespace restage::pbrt
