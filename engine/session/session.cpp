// SPDX-License-Identifier: Apache-2.0
#include "session/session.hpp"

#include <algorithm>

namespace restage::session {

using namespace scene;

Result<> Session::open(const std::string& path, const io::ImportOptions& options) {
    RESTAGE_TRY(io::ImportedScene imported, io::import_scene(path, registry_, options));
    adopt(std::move(imported.scene), std::move(imported.report), path);
    return {};
}

namespace {

template <class T>
void touch(Table<T>& slots, Version version) {
    for (std::uint32_t i = 1; i <= slots.size(); ++i) {
        const T* item = slots.find({i});
        slots.set({i}, item ? std::optional<T>(*item) : std::nullopt, version);
    }
}

} // namespace

void Session::adopt(Scene scene, io::Report report, std::string path) {
    // Whoever compares versions must not take a slot of the new scene for one of the old: all of them are changed now.
    const Version now = std::max(scene.clock, scene_.clock) + 1;
    scene_ = std::move(scene);
    scene_.clock = now;
    touch(scene_.meshes, now);
    touch(scene_.images, now);
    touch(scene_.textures, now);
    touch(scene_.materials, now);
    touch(scene_.media, now);
    touch(scene_.groups, now);
    touch(scene_.instances, now);
    touch(scene_.lights, now);
    touch(scene_.cameras, now);
    scene_.environment.version = scene_.active_camera.version = scene_.film.version = scene_.settings.version = now;
    history_ = {};
    report_ = std::move(report);
    path_ = std::move(path);
}

bool Session::edit(Edit edit, std::string_view gesture) { return history_.push(scene_, std::move(edit), gesture); }

Result<bool> Session::edit(Result<Edit> edit, std::string_view gesture) {
    if (!edit) return tl::unexpected<Error>(std::move(edit.error()));
    return history_.push(scene_, std::move(*edit), gesture);
}

Result<std::vector<Id<Instance>>> Session::duplicate(Instances ids, const glm::dmat4& move) {
    RESTAGE_TRY(Duplicate made, duplicate_instances(scene_, ids, move));
    edit(std::move(made.edit));
    return std::move(made.copies);
}

Result<bool> Session::remove(Instances ids) { return edit(remove_instances(scene_, ids)); }

Result<bool> Session::move(Instances ids, const glm::dmat4& by, std::string_view gesture) {
    return edit(move_instances(scene_, ids, by), gesture);
}

Result<bool> Session::set_material(Instances ids, Id<Material> material) {
    return edit(scene::set_material(scene_, ids, material));
}

Result<bool> Session::set_param(Id<Material> id, std::string_view param, Value value, std::string_view gesture) {
    const Material* material = scene_.materials.find(id);
    const auto* plugin = material ? registry_.find_material(material->type) : nullptr;
    const bool common = param == "bump" || param == "normalmap";
    if (plugin && !common) {
        const std::string who = "material \"" + material->name + "\": parameter \"" + std::string(param) + "\"";
        const auto* begin = plugin->table->params;
        const auto* end = begin + plugin->table->param_count;
        const auto* line = std::find_if(begin, end, [&](const RestageParam& p) { return p.id == param; });
        if (line == end) return fail(who + " is not one of a " + material->type);
        if (static_cast<RestageType>(line->type) != value.type) return fail(who + " has another type");
        if (value.texture && !(line->flags & RESTAGE_PARAM_TEXTURABLE) && line->type != RESTAGE_TEXTURE)
            return fail(who + " takes no texture");
        if (line->type == RESTAGE_ENUM && !choice_index(line->choices, value.text))
            return fail(who + " cannot be \"" + value.text + "\"; " + line->choices + " are possible");
        const int components = line->type == RESTAGE_COLOR                                ? 3
                               : line->type == RESTAGE_FLOAT || line->type == RESTAGE_INT ? 1
                                                                                          : 0;
        for (int i = 0; i < components && !value.texture; ++i)
            if (!(value.v[static_cast<std::size_t>(i)] >= line->min &&
                  value.v[static_cast<std::size_t>(i)] <= line->max))
                return fail(who + ": " + std::to_string(value.v[static_cast<std::size_t>(i)]) +
                            " is out of its range, " + std::to_string(line->min) + " to " + std::to_string(line->max));
    }
    return edit(scene::set_param(scene_, id, param, std::move(value)), gesture);
}

Result<Id<Material>> Session::add_material(std::string name, std::string type) {
    if (!registry_.find_material(type)) return fail("there is no material type \"" + type + "\"");
    const Id<Material> id = scene_.materials.next();
    const std::string label = "Add " + name;
    edit(insert(scene_, Material{.name = std::move(name), .type = std::move(type)}, label));
    return id;
}

Result<Merged> Session::insert_file(const std::string& path, const io::ImportOptions& options) {
    RESTAGE_TRY(io::ImportedObjects objects, io::import_into(scene_, path, registry_, options));
    edit(objects.merged.edit);
    for (io::ReportEntry& entry : objects.report.entries)
        report_.entries.push_back(std::move(entry));
    return std::move(objects.merged);
}

Result<io::Report> Session::export_to(const std::string& path, const io::ExportOptions& options) const {
    return io::export_scene(scene_, path, registry_, options);
}

Result<io::Report> Session::save_as(const std::string& path, const io::ExportOptions& options) {
    RESTAGE_TRY(io::Report report, export_to(path, options));
    path_ = path;
    history_.mark_clean();
    return report;
}

} // namespace restage::session
