// SPDX-License-Identifier: Apache-2.0
#include "base/file.hpp"
#include "document/clipboard.hpp"
#include "document/preset.hpp"
#include "document/project_fields.hpp"
#include "document/project_json.hpp"
#include "io/image_file.hpp"
#include "scene/edits.hpp"
#include "scene/same_material.hpp"

#include <fmt/format.h>
#include <cctype>
#include <map>
#include <set>

namespace restage::document {

using namespace scene;
namespace fs = std::filesystem;

namespace {

class Writer {
  public:
    Writer(const Preset& preset, const fs::path& file) : preset_(preset), parts_(preset.parts), file_(file) {}

    Result<> run() {
        const Material* material = parts_.materials.find(preset_.material);
        if (!material) return fail("the preset has no material");
        json j;
        j["restage"] = "material";
        j["name"] = preset_.name;
        j["category"] = preset_.category;
        j["type"] = material->type;
        j["params"] = params(material->params);
        if (!preset_.source.empty()) j["source"] = preset_.source;
        if (!textures_.empty()) j["textures"] = std::move(textures_);
        if (!materials_.empty()) j["materials"] = std::move(materials_);
        if (!error_.empty()) return fail(error_);
        return write_file_atomic(file_, pretty(j));
    }

  private:
    // "oak.json", "/pictures/planks.png" -> "oak-planks.png"; numbered if another file has taken that.
    std::string name_beside(const fs::path& of) {
        const std::string prefix = file_.stem().string() + "-", extension = of.extension().string();
        const std::string own = of.stem().string(), stem = own.starts_with(prefix) ? own : prefix + own;
        std::string name = stem + extension;
        for (int i = 2; !taken_.insert(name).second; ++i)
            name = fmt::format("{}-{}{}", stem, i, extension);
        return name;
    }
    std::string copied(const std::string& path) {
        if (const auto done = copies_.find(path); done != copies_.end()) return done->second;
        const std::string name = name_beside(path);
        const fs::path to = file_.parent_path() / name;
        std::error_code code;
        if (!fs::equivalent(path, to, code)) { // saved over itself
            code.clear();
            fs::copy_file(path, to, fs::copy_options::overwrite_existing, code);
            if (code && error_.empty()) error_ = path + ": cannot be copied: " + code.message();
        }
        return copies_[path] = name;
    }

    json image(const Image& i) {
        json j;
        if (!i.path.empty()) {
            j["file"] = copied(i.path);
        } else if (i.data) {
            const std::string name = name_beside((i.name.empty() ? "image" : i.name) + ".exr");
            if (auto done = io::write_image((file_.parent_path() / name).string(), *i.data); !done && error_.empty())
                error_ = done.error().message;
            j["file"] = name;
            j["encoding"] = Names<Encoding>::list[0];
            return j;
        } else if (error_.empty()) {
            error_ = "image \"" + i.name + "\" has no pixels";
        }
        j["encoding"] = Names<Encoding>::list[int(i.encoding) - Names<Encoding>::first];
        if (i.encoding == Encoding::gamma) j["gamma"] = number_json(i.gamma);
        return j;
    }

    std::string unique(const json& among, std::string name) {
        if (name.empty()) name = "unnamed";
        std::string free = name;
        for (int i = 2; among.contains(free); ++i)
            free = fmt::format("{} {}", name, i);
        return free;
    }
    std::string texture(Id<Texture> id) {
        if (const auto done = texture_names_.find(id.value); done != texture_names_.end()) return done->second;
        const Texture& t = parts_.textures[id];
        const std::string name = texture_names_[id.value] = unique(textures_, t.name);
        textures_[name] = json::object(); // the name is taken
        json j;
        j["type"] = t.type;
        if (t.is_float) j["float"] = true;
        if (const Image* i = parts_.images.find(t.image)) j["image"] = image(*i);
        j["params"] = params(t.params);
        textures_[name] = std::move(j);
        return name;
    }
    std::string component(Id<Material> id) {
        if (const auto done = material_names_.find(id.value); done != material_names_.end()) return done->second;
        const Material& m = parts_.materials[id];
        const std::string name = material_names_[id.value] = unique(materials_, m.name);
        materials_[name] = json::object();
        json j;
        j["type"] = m.type;
        j["params"] = params(m.params);
        materials_[name] = std::move(j);
        return name;
    }

    json params(const ParamSet& set) {
        json j = json::object();
        for (const auto& [id, v] : set.entries())
            if (json one = value(v); !one.is_null()) j[id] = std::move(one);
        return j;
    }
    json value(const Value& v) {
        if (parts_.textures.find(v.texture)) return {{"texture", texture(v.texture)}};
        if (parts_.materials.find(v.material)) return {{"material", component(v.material)}};
        switch (v.type) {
            case ParamType::number:
                return number_json(v.v[0]);
            case ParamType::color:
                return json::array({number_json(v.v[0]), number_json(v.v[1]), number_json(v.v[2])});
            case ParamType::integer:
                return v.i;
            case ParamType::boolean:
                return v.i != 0;
            case ParamType::choice:
            case ParamType::text:
                return v.text;
            case ParamType::table:
                return v.text.empty() ? json() : json(copied(v.text));
            default: // an empty slot
                return nullptr;
        }
    }

    const Preset& preset_;
    const Scene& parts_;
    const fs::path file_;
    json textures_ = json::object(), materials_ = json::object();
    std::map<std::uint32_t, std::string> texture_names_, material_names_;
    std::map<std::string, std::string> copies_; // path -> name beside the preset
    std::set<std::string> taken_;
    std::string error_; // the first one
};

} // namespace

Result<Preset> preset_of(const Scene& scene, Id<Material> id) {
    const Material* material = scene.materials.find(id);
    if (!material) return fail("the material no longer exists");
    Preset preset{.name = material->name, .category = {}, .source = {}, .file = {}, .parts = {}, .material = id};
    RESTAGE_TRY(preset.parts, part_of(scene, {.instances = {}, .light = {}, .material = id}));
    return preset;
}

Result<> write_preset(const Preset& preset, const fs::path& file) { return Writer(preset, file).run(); }

std::string preset_file_name(std::string_view name) {
    std::string out;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x80 || std::isalnum(byte))
            out += byte < 0x80 ? char(std::tolower(byte)) : c;
        else if (!out.empty() && out.back() != '-')
            out += '-';
    }
    while (!out.empty() && out.back() == '-')
        out.pop_back();
    return (out.empty() ? "material" : out) + ".json";
}

Result<Edit> give_preset(const Scene& into, const Preset& preset, std::span<const Id<Instance>> to) {
    const std::string label = "Material " + preset.name;
    if (const Id<Material> same = find_same_material(into, preset.parts, preset.material)) {
        RESTAGE_TRY(Edit edit, set_material(into, to, same));
        edit.label = label;
        return edit;
    }
    RESTAGE_TRY(Edit edit, paste_material(into, {.scene = preset.parts, .material = true}, to));
    edit.label = label;
    return edit;
}

} // namespace restage::document
