// SPDX-License-Identifier: Apache-2.0
#include "base/file.hpp"
#include "base/json.hpp"
#include "document/clipboard.hpp"
#include "document/preset.hpp"
#include "document/project_fields.hpp"
#include "document/project_json.hpp"
#include "io/image_file.hpp"
#include "model/texture.hpp"
#include "plugin/texture_source.hpp"
#include "scene/edits.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>

namespace restage::document {

using namespace scene;
namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t most_bytes = 4 << 20; // of the JSON

template <class T>
Id<T> add(Scene& s, T item) {
    const Id<T> id = table<T>(s).next();
    apply(s, insert(s, std::move(item), ""));
    return id;
}

class Reader {
  public:
    Reader(const fs::path& file, const plugin::Registry& registry) : file_(file), registry_(registry) {}

    Result<Preset> run() {
        RESTAGE_TRY(text_, read_file(file_, most_bytes));
        auto parsed = parse_json<json>(text_);
        if (!parsed) return fail(file_.string() + ":" + parsed.error().message);
        const json& j = *parsed;
        if (!j.is_object() || !j.contains("restage") || j["restage"] != "material")
            return wrong({"restage"}, R"(not a material preset: it does not say "restage": "material")");
        preset_.file = file_;
        preset_.hash = hash64(text_);
        RESTAGE_CHECK(
            known(j, {}, {"restage", "name", "category", "type", "params", "source", "textures", "materials"}));
        RESTAGE_TRY(preset_.name, words(j, {}, "name"));
        RESTAGE_TRY(preset_.category, words(j, {}, "category"));
        if (j.contains("source")) {
            RESTAGE_TRY(preset_.source, words(j, {}, "source"));
        }
        if (preset_.name.empty()) return wrong({"name"}, "\"name\" is empty");
        for (const char* part : {"textures", "materials"})
            if (j.contains(part) && !j[part].is_object())
                return wrong({part}, fmt::format("\"{}\" must be an object of things by name", part));
        all_ = &j;
        RESTAGE_TRY(preset_.material, material(j, {}, preset_.name, true));
        add_carrier(preset_.parts, preset_.material);
        return std::move(preset_);
    }

  private:
    using Place = std::vector<std::string>; // keys from the outside in

    // Where the last key is: each is looked for after the one before.
    std::size_t line_of(const Place& place) const {
        std::size_t at = 0;
        for (const std::string& key : place) {
            const std::string quoted = json(key).dump();
            for (std::size_t found = text_.find(quoted, at); found != text_.npos;
                 found = text_.find(quoted, found + 1)) {
                const std::size_t next = text_.find_first_not_of(" \t\r\n", found + quoted.size());
                if (next != text_.npos && text_[next] == ':') {
                    at = found;
                    break;
                }
            }
        }
        return 1 + std::size_t(std::count(text_.begin(), text_.begin() + std::ptrdiff_t(at), '\n'));
    }
    tl::unexpected<Error> wrong(const Place& place, const std::string& what) const {
        return fail(fmt::format("{}:{}: {}", file_.string(), line_of(place), what));
    }
    static Place in(Place place, std::string key) {
        place.push_back(std::move(key));
        return place;
    }

    Result<> known(const json& j, const Place& place, std::initializer_list<std::string_view> keys) const {
        for (const auto& [key, value] : j.items())
            if (std::find(keys.begin(), keys.end(), key) == keys.end() && !key.starts_with("x-"))
                return wrong(in(place, key), "\"" + key + "\" is not known here");
        return {};
    }
    Result<std::string> words(const json& j, const Place& place, const char* key) const {
        const auto found = j.find(key);
        if (found == j.end()) return wrong(place, fmt::format("\"{}\" is missing", key));
        if (!found->is_string()) return wrong(in(place, key), fmt::format("\"{}\" must be text", key));
        return found->get<std::string>();
    }
    // A file that the preset names.
    Result<std::string> beside(const std::string& name, const Place& place) {
        const fs::path path = (fs::absolute(file_).parent_path() / name).lexically_normal();
        std::error_code code;
        const auto size = fs::file_size(path, code);
        if (code) return wrong(place, path.string() + ": " + code.message());
        const auto time = fs::last_write_time(path, code).time_since_epoch().count();
        preset_.hash = hash64(fmt::format("{} {} {}", name, size, time), preset_.hash);
        return path.string();
    }

    Result<Id<Material>> material(const json& j, const Place& place, const std::string& name, bool outermost = false) {
        if (!j.is_object()) return wrong(place, "a material must be an object");
        if (!outermost) RESTAGE_CHECK(known(j, place, {"type", "params"}));
        RESTAGE_TRY(const std::string type, words(j, place, "type"));
        const auto plugin = registry_.find_material(type);
        if (!plugin) return wrong(in(place, "type"), "no plugin provides the material type \"" + type + "\"");
        std::vector<model::Param> lines = plugin->table->params;
        if (plugin->table->has_code())
            lines.insert(lines.end(), model::surface_params().begin(), model::surface_params().end());
        RESTAGE_TRY(ParamSet params, values(j, place, lines, type));
        return add(preset_.parts, Material{.name = name, .type = type, .params = std::move(params), .origin = {}});
    }

    Result<Id<Texture>> texture(const std::string& name, const Place& user) {
        if (const auto made = textures_.find(name); made != textures_.end()) return made->second;
        RESTAGE_TRY(const json* const found, named("textures", name, user));
        const json& j = *found;
        const Place place{"textures", name};
        RESTAGE_CHECK(known(j, place, {"type", "float", "image", "params"}));
        RESTAGE_TRY(const std::string type, words(j, place, "type"));
        const auto plugin = registry_.find_texture(type);
        if (!plugin) return wrong(in(place, "type"), "no plugin provides the texture type \"" + type + "\"");
        Texture made{.name = name, .type = type, .is_float = false, .image = {}, .params = {}, .origin = {}};
        if (const auto f = j.find("float"); f != j.end()) {
            if (!f->is_boolean()) return wrong(in(place, "float"), "\"float\" must be true or false");
            made.is_float = f->get<bool>();
        }
        if (j.contains("image")) {
            RESTAGE_TRY(made.image, image(j["image"], in(place, "image"), name));
        }
        std::vector<model::Param> lines = plugin->table->params;
        if (plugin->table->mapped)
            lines.insert(lines.end(), model::mapping_params().begin(), model::mapping_params().end());
        RESTAGE_TRY(made.params, values(j, place, lines, type));
        open_.erase("textures " + name);
        return textures_[name] = add(preset_.parts, std::move(made));
    }

    // An entry of "textures" or "materials"; refused while it is being read.
    Result<const json*> named(const char* part, const std::string& name, const Place& user) {
        const auto list = all_->find(part);
        if (list == all_->end() || !list->contains(name))
            return wrong(user, fmt::format("there is no \"{}\" in \"{}\"", name, part));
        if (!open_.insert(std::string(part) + " " + name).second)
            return wrong({part, name}, "\"" + name + "\" refers to itself");
        if (!(*list)[name].is_object()) return wrong({part, name}, "\"" + name + "\" must be an object");
        return &(*list)[name];
    }

    Result<Id<Image>> image(const json& j, const Place& place, const std::string& name) {
        if (!j.is_object()) return wrong(place, "\"image\" must be an object with a \"file\"");
        RESTAGE_CHECK(known(j, place, {"file", "encoding", "gamma"}));
        Image made;
        made.name = name;
        RESTAGE_TRY(const std::string file, words(j, place, "file"));
        RESTAGE_TRY(made.path, beside(file, in(place, "file")));
        if (const auto encoding = j.find("encoding"); encoding != j.end()) {
            const auto& names = Names<Encoding>::list;
            const auto at =
                std::find_if(std::begin(names), std::end(names), [&](const char* n) { return *encoding == n; });
            if (at == std::end(names)) return wrong(in(place, "encoding"), "the encoding is unknown");
            made.encoding = static_cast<Encoding>(int(at - std::begin(names)) + Names<Encoding>::first);
        }
        if (const auto gamma = j.find("gamma"); gamma != j.end() && !read_number(*gamma, made.gamma))
            return wrong(in(place, "gamma"), "\"gamma\" must be a number");
        return add(preset_.parts, std::move(made));
    }

    Result<ParamSet> values(const json& j, const Place& place, model::ParamTable lines, const std::string& type) {
        ParamSet set;
        const auto params = j.find("params");
        if (params == j.end()) return set;
        const Place inner = in(place, "params");
        if (!params->is_object()) return wrong(inner, "\"params\" must be an object of values by name");
        for (const auto& [id, value] : params->items()) {
            const model::Param* line = model::find_param(lines, id);
            if (!line) return wrong(in(inner, id), fmt::format("a {} has no parameter \"{}\"", type, id));
            RESTAGE_TRY(Value read, this->value(value, *line, in(inner, id)));
            set.set(id, std::move(read));
        }
        return set;
    }

    Result<Value> value(const json& j, const model::Param& line, const Place& place) {
        Value v{.type = line.type};
        const auto needs = [&](const char* what) {
            return wrong(place, fmt::format("\"{}\" must be {}", line.id, what));
        };
        if (j.is_object()) {
            const bool texture_here = line.texturable || line.type == model::ParamType::texture;
            const bool material_here = line.type == model::ParamType::material;
            if (texture_here && j.size() == 1 && j.contains("texture") && j["texture"].is_string()) {
                RESTAGE_TRY(v.texture, texture(j["texture"].get<std::string>(), place));
                return v;
            }
            if (material_here && j.size() == 1 && j.contains("material") && j["material"].is_string()) {
                const auto name = j["material"].get<std::string>();
                RESTAGE_TRY(const json* const found, named("materials", name, place));
                RESTAGE_TRY(v.material, material(*found, {"materials", name}, preset_.name + ", " + name));
                open_.erase("materials " + name);
                return v;
            }
            return needs(texture_here    ? R"(a value or {"texture": name})"
                         : material_here ? R"({"material": name})"
                                         : "a value");
        }
        switch (line.type) {
            case model::ParamType::number:
                if (!j.is_number() || !read_number(j, v.v[0])) return needs("a number");
                break;
            case model::ParamType::color:
                for (std::size_t c = 0; c < 3; ++c) {
                    const json* part = j.is_number() ? &j : j.is_array() && j.size() == 3 ? &j[c] : nullptr;
                    if (!part || !part->is_number() || !read_number(*part, v.v[c]))
                        return needs("a colour: one number or three");
                }
                break;
            case model::ParamType::integer:
                if (!j.is_number_integer()) return needs("a whole number");
                v.i = int(std::clamp(j.get<std::int64_t>(), std::int64_t(-2147483647), std::int64_t(2147483647)));
                break;
            case model::ParamType::boolean:
                if (!j.is_boolean()) return needs("true or false");
                v.i = j.get<bool>();
                break;
            case model::ParamType::choice:
                if (!j.is_string() || !line.choice_index(j.get<std::string>()))
                    return needs(("one of " + model::choices_text(line)).c_str());
                v.text = j.get<std::string>();
                break;
            case model::ParamType::text:
                if (!j.is_string()) return needs("text");
                v.text = j.get<std::string>();
                break;
            case model::ParamType::table: {
                if (!j.is_string()) return needs("the name of a file");
                RESTAGE_TRY(v.text, beside(j.get<std::string>(), place));
                break;
            }
            case model::ParamType::material:
                return needs(R"({"material": name})");
            case model::ParamType::texture:
                return needs(R"({"texture": name})");
        }
        return in_range(v, line, place);
    }

    Result<Value> in_range(const Value& v, const model::Param& line, const Place& place) const {
        const bool whole = line.type == model::ParamType::integer;
        if (!line.ranged()) return v;
        const float lower = whole ? float(line.int_min) : line.min, upper = whole ? float(line.int_max) : line.max;
        for (int c = 0; c < line.components(); ++c) {
            const float x = whole ? float(v.i) : v.v[std::size_t(c)];
            if (!(x >= lower && x <= upper))
                return wrong(place,
                             fmt::format("\"{}\" is {:g}; it must be from {:g} to {:g}", line.id, x, lower, upper));
        }
        return v;
    }

    const fs::path file_;
    const plugin::Registry& registry_;
    std::string text_;
    Preset preset_;
    const json* all_ = nullptr;
    std::map<std::string, Id<Texture>> textures_; // read already
    std::set<std::string> open_; // being read
};

} // namespace

Result<Preset> read_preset(const fs::path& file, const plugin::Registry& registry) {
    return Reader(file, registry).run();
}

Result<> read_images(Preset& preset) {
    std::vector<std::pair<Id<Image>, Image>> missing;
    preset.parts.images.each([&](Id<Image> id, const Image& i) {
        if (!i.data && !i.path.empty()) missing.emplace_back(id, i);
    });
    for (auto& [id, image] : missing) {
        RESTAGE_TRY(PixelData pixels, io::read_image(image.path, image.encoding, image.gamma));
        image.data = std::make_shared<const PixelData>(std::move(pixels));
        preset.parts.images.set(id, image, ++preset.parts.clock);
    }
    return {};
}

PresetFolder presets_in(const fs::path& folder, const plugin::Registry& registry) {
    PresetFolder all;
    std::error_code error;
    std::vector<fs::path> files;
    for (auto it = fs::directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
         !error && it != fs::directory_iterator(); it.increment(error))
        if (it->path().extension() == ".json" && it->is_regular_file(error)) files.push_back(it->path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        if (auto read = read_preset(file, registry))
            all.presets.push_back(std::move(*read));
        else
            all.problems.push_back(read.error().message);
    }
    std::stable_sort(all.presets.begin(), all.presets.end(), [](const Preset& a, const Preset& b) {
        return std::tie(a.category, a.name) < std::tie(b.category, b.name);
    });
    return all;
}

} // namespace restage::document
