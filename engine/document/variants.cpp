// SPDX-License-Identifier: Apache-2.0
#include "document/variants.hpp"

#include "document/looks.hpp"
#include "io/choices.hpp"
#include "scene/merge.hpp"
#include "scene/same_material.hpp"

#include <set>
#include <utility>

namespace restage::document {

using namespace scene;

namespace {

constexpr const char* variant_option = "variant"; // of the importer

using Given = std::vector<std::pair<Id<Instance>, Id<Material>>>; // of the document

// The materials that the variant gives to objects of the document. Those that the document lacks are added to the edit,
// and to `now`.
Given materials_of(const Variant& variant, const Scene& base, Scene& now, Edit& edit) {
    Scene differing = variant.scene;
    Edit same;
    std::vector<Id<Instance>> objects; // of the document, in the order of those that are left
    variant.scene.instances.each([&](Id<Instance> id, const Instance& i) {
        const Instance* original = base.instances.find(id);
        const bool other = original && original->name == i.name && now.instances.find(id) &&
                           !identical_material(base, original->material, variant.scene, i.material);
        if (other)
            objects.push_back(id);
        else
            same.changes.push_back(Change<Instance>{id, i, std::nullopt});
    });
    variant.scene.lights.each(
        [&](Id<Light> id, const Light& l) { same.changes.push_back(Change<Light>{id, l, std::nullopt}); });
    apply(differing, same);
    const Merged merged = merge(now, differing, "");
    Edit materials;
    Given given;
    std::size_t at = 0;
    for (const AnyChange& change : merged.edit.changes) {
        if (const auto* i = std::get_if<Change<Instance>>(&change))
            given.emplace_back(objects.at(at++), i->after->material);
        else if (!std::holds_alternative<Change<Mesh>>(change) && !std::holds_alternative<Change<Group>>(change))
            materials.changes.push_back(change);
    }
    apply(now, materials);
    edit.changes.insert(edit.changes.end(), materials.changes.begin(), materials.changes.end());
    return given;
}

} // namespace

std::vector<std::string> variants_of(const Session& session) {
    for (io::Choices& one : io::choices_of(session.report()))
        if (one.option == variant_option) return std::move(one.values);
    return {};
}

Result<std::vector<Variant>> read_variants(const Base& base, std::span<const std::string> names,
                                           const plugin::Registry& registry, const ReadOptions& options) {
    std::vector<Variant> variants;
    for (const std::string& name : names) {
        ReadOptions reading = options;
        reading.expose = false;
        reading.import_options = base.options;
        reading.import_options->set(variant_option, Value{.type = model::ParamType::text, .text = name});
        RESTAGE_TRY(io::ImportedScene read, read_scene(base.file, registry, reading, base.format));
        variants.push_back({name, std::move(read.scene)});
    }
    return variants;
}

Result<std::vector<std::string>> looks_from_variants(Session& session, std::span<const Variant> variants) {
    if (variants.empty()) return fail(session.base().file + ": the file has no variants");
    Looks looks = session.looks();
    std::set<std::string> taken;
    for (const Look& look : looks.list)
        taken.insert(look.name);
    Scene now = session.scene();
    Edit edit;
    std::vector<std::string> names;
    std::vector<Given> given;
    for (const Variant& variant : variants) {
        given.push_back(materials_of(variant, session.base().scene, now, edit));
        names.push_back(scene::free_name(variant.name, taken));
    }
    for (std::size_t i = 0; i < given.size(); ++i) {
        Scene state = now;
        ++state.clock;
        for (const auto& [id, material] : given[i]) {
            Instance dressed = state.instances[id];
            dressed.material = material;
            state.instances.set(id, std::move(dressed), state.clock);
        }
        looks.list.push_back({names[i], look_state(state)});
    }
    RESTAGE_CHECK(session.change_looks(std::move(looks), "Looks from variants", std::move(edit)));
    return names;
}

} // namespace restage::document
