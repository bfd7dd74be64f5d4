// SPDX-License-Identifier: Apache-2.0
// What a file leaves to choose: one of its scenes, and a variant of its materials (KHR_materials_variants). Both are
// import options; what there is to choose from is a line of the report.
#include "importer.hpp"

#include <charconv>

namespace restage::gltf {

// The index in `names` that the option asks for, by name or by number from 1.
std::optional<int> Importer::asked(const char* option, const std::vector<std::string>& names) const {
    const std::string wanted(choice_option(out_, option));
    if (wanted.empty()) return std::nullopt;
    std::string known;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == wanted) return static_cast<int>(i);
        known += (i ? ", " : "") + std::to_string(i + 1) + (names[i].empty() ? "" : " " + quote(names[i]));
    }
    std::size_t number = 0;
    const auto [end, code] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
    if (code == std::errc() && end == wanted.data() + wanted.size() && number >= 1 && number <= names.size())
        return static_cast<int>(number - 1);
    throw ImportError{"there is no " + std::string(option) + " " + quote(wanted) + "; " +
                      (known.empty() ? "the file names none" : "there are " + known)};
}

// choices "scene": their names, or numbers if they have none (docs/plugins.md).
void Importer::tell_choices(const char* option, const std::vector<std::string>& names, std::size_t least) {
    if (names.size() < least) return;
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i)
        list += (i ? " | " : "") + (names[i].empty() ? std::to_string(i + 1) : names[i]);
    report_.kept("choices " + quote(option), list);
}

void Importer::choose_variant() {
    std::vector<std::string> names;
    if (const auto found = model_.extensions.find("KHR_materials_variants");
        found != model_.extensions.end() && found->second.IsObject() && found->second.Has("variants"))
        if (const tinygltf::Value& list = found->second.Get("variants"); list.IsArray())
            for (std::size_t i = 0; i < list.ArrayLen(); ++i) {
                const tinygltf::Value& one = list.Get(i);
                const bool named = one.IsObject() && one.Has("name") && one.Get("name").IsString();
                names.push_back(named ? one.Get("name").Get<std::string>() : std::string());
            }
    tell_choices("variant", names, 1);
    variant_ = asked("variant", names);
}

// The material that a primitive has in the chosen variant: its own, if the variant says nothing about it.
int Importer::material_of(const tinygltf::Primitive& p) const {
    const auto found = p.extensions.find("KHR_materials_variants");
    if (!variant_ || found == p.extensions.end() || !found->second.IsObject() || !found->second.Has("mappings"))
        return p.material;
    const tinygltf::Value& mappings = found->second.Get("mappings");
    for (std::size_t i = 0; mappings.IsArray() && i < mappings.ArrayLen(); ++i) {
        const tinygltf::Value& mapping = mappings.Get(i);
        if (!mapping.IsObject() || !mapping.Has("variants") || !mapping.Get("variants").IsArray()) continue;
        const tinygltf::Value& variants = mapping.Get("variants");
        for (std::size_t k = 0; k < variants.ArrayLen(); ++k)
            if (variants.Get(k).IsInt() && variants.Get(k).Get<int>() == *variant_) {
                const int material = static_cast<int>(number_of(mapping, "material", -1));
                at(model_.materials, material, "material", "a variant");
                return material;
            }
    }
    return p.material;
}

} // namespace restage::gltf
