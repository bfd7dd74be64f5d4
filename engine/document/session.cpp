// SPDX-License-Identifier: Apache-2.0
#include "document/session.hpp"

#include "base/file.hpp"
#include "document/looks.hpp"
#include "document/project.hpp"
#include "io/material_tables.hpp"
#include "scene/bounds.hpp"
#include "scene/links.hpp"
#include "scene/validate.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

namespace restage::document {

using namespace scene;

Result<> Session::open(const std::string& path, const ReadOptions& options) {
    RESTAGE_TRY(Document document, read_document(path, registry_, options));
    adopt(std::move(document));
    return {};
}

void Session::take(Scene&& scene) {
    // Version comparisons must not confuse slots of the new scene with the old: mark all as changed.
    const Version now = std::max(scene.clock, scene_.clock) + 1;
    scene_ = std::move(scene);
    scene_.clock = now;
    each_table(scene_, [&](auto& table) { table.set_versions(now); });
    each_single([&](const auto& single) { (scene_.*single.one).version = now; });
    history_ = scene::History(history_.budget());
}

void Session::adopt(Scene scene, io::Report report, std::string path) {
    take(std::move(scene));
    report_ = std::move(report);
    path_ = std::move(path);
    base_ = {};
    sources_ = {};
    unknown_.clear();
}

void Session::adopt(Document document) {
    Scene scene = document.base.scene;
    apply(scene, document.changes);
    take(std::move(scene));
    if (document.unsaved) history_.mark_unsaved();
    report_ = std::move(document.report);
    path_ = std::move(document.path);
    base_ = std::move(document.base);
    sources_ = std::move(document.sources);
    unknown_ = std::move(document.unknown);
    history_.begin_beside(std::move(document.looks));
}

void Session::adopt_recovered(Document document) {
    Edit changes = std::exchange(document.changes, {});
    const auto saved = document.note.find("path");
    document.path = saved != document.note.end() ? saved->second : "";
    const bool from_base = document.path == document.base.file; // never saved
    adopt(std::move(document));
    // Empty slots are not a change that a history would keep, but later ids need them.
    ++scene_.clock;
    for (const AnyChange& change : changes.changes)
        std::visit(
            [&]<class C>(const C& c) {
                if constexpr (requires { c.id; })
                    if (!c.before)
                        table<std::remove_cvref_t<decltype(*c.before)>>(scene_).set(c.id, std::nullopt, scene_.clock);
            },
            change);
    changes.label = "Recovered changes";
    history_.push(scene_, std::move(changes));
    if (!from_base) history_.mark_unsaved();
}

Result<bool> Session::edit(Result<Edit> edit, std::string_view gesture) {
    if (!edit) return tl::unexpected<Error>(std::move(edit.error()));
    RESTAGE_CHECK(check_edit(*edit));
    RESTAGE_CHECK(check_links(scene_, *edit));
    return history_.push(scene_, std::move(*edit), gesture);
}

const Looks& Session::looks() const {
    static const Looks none;
    const auto* looks = static_cast<const Looks*>(history_.beside().get());
    return looks ? *looks : none;
}

Result<> Session::change_looks(Looks looks, std::string label, Edit edit) {
    RESTAGE_CHECK(check_edit(edit));
    edit.label = std::move(label);
    history_.push_beside(scene_, std::move(edit), std::make_shared<const Looks>(std::move(looks)));
    return {};
}

Result<std::vector<Id<Instance>>> Session::duplicate(Instances ids, const glm::dmat4& move) {
    RESTAGE_TRY(Duplicate made, duplicate_instances(scene_, ids, move));
    RESTAGE_CHECK(edit(std::move(made.edit)));
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
    return edit(param_edit(id, param, std::move(value)), gesture);
}

Result<Edit> Session::param_edit(Id<Material> id, std::string_view param, Value value) const {
    return io::param_edit(scene_, registry_, id, param, std::move(value));
}

Result<Id<Material>> Session::add_material(std::string name, std::string type) {
    if (!registry_.find_material(type)) return fail("there is no material type \"" + type + "\"");
    const Id<Material> id = scene_.materials.next();
    const std::string label = "Add " + name;
    RESTAGE_CHECK(edit(scene::insert(scene_, Material{.name = std::move(name), .type = std::move(type)}, label)));
    return id;
}

namespace {

constexpr double flat = 0.35; // depth of what hangs on a wall, relative to its width or its height

// Moves what has these bounds to where it stands or hangs. The back of a flat thing is the side on which its file has
// the origin.
glm::dmat4 placement(const Bounds& bounds, const Session::Stand& stand) {
    const glm::dvec3 up = stand.up, center = bounds.center(), size = bounds.size();
    const double height = std::abs(glm::dot(size, up)), slope = glm::dot(stand.normal, up);
    const bool wall = stand.normal != glm::dvec3(0) && std::abs(slope) < 0.5;
    if (wall) {
        glm::dvec3 front(0); // along the axis of least extent, horizontal
        double depth = 1e300, width = 0;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 e(0);
            e[axis] = 1;
            if (std::abs(glm::dot(e, up)) > 0.5) continue;
            width = std::max(width, size[axis]);
            if (size[axis] >= depth) continue;
            depth = size[axis];
            front = center[axis] < 0 ? -e : e;
        }
        if (depth <= flat * std::max(width, height)) {
            const glm::dvec3 to = glm::normalize(stand.normal - up * slope);
            const double angle = std::atan2(glm::dot(glm::cross(front, to), up), glm::dot(front, to));
            return glm::translate(glm::rotate(glm::translate(glm::dmat4(1), stand.at), angle, up),
                                  0.5 * depth * front - center);
        }
    }
    return glm::translate(glm::dmat4(1), stand.at - (center + up * (slope < -0.5 ? 0.5 : -0.5) * height));
}

} // namespace

Result<Merged> Session::insert_file(const std::string& path, const io::ImportOptions& options) {
    RESTAGE_TRY(const io::ImportedScene imported, io::import_scene(path, registry_, options));
    return insert(imported, path);
}

Result<Merged> Session::insert(const io::ImportedScene& imported, const std::string& file,
                               const std::optional<Stand>& stand) {
    const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
    Merged made = merge(scene_, imported.scene, path.stem().string());
    if (made.instances.empty()) return fail(file + ": contains no objects");
    if (stand) {
        std::map<std::uint32_t, std::shared_ptr<const MeshData>> meshes;
        for (const AnyChange& change : made.edit.changes)
            if (const auto* c = std::get_if<Change<Mesh>>(&change); c && c->after) meshes[c->id.value] = c->after->data;
        Bounds bounds;
        for (const AnyChange& change : made.edit.changes)
            if (const auto* c = std::get_if<Change<Instance>>(&change); c && c->after)
                if (const auto mesh = meshes.find(c->after->mesh.value); mesh != meshes.end() && mesh->second)
                    bounds.add(world_bounds(*mesh->second, c->after->object_to_world));
        const glm::dmat4 move = bounds.empty() ? glm::dmat4(1) : placement(bounds, *stand);
        for (AnyChange& change : made.edit.changes) {
            if (auto* i = std::get_if<Change<Instance>>(&change); i && i->after)
                i->after->object_to_world = move * i->after->object_to_world;
            if (auto* l = std::get_if<Change<Light>>(&change); l && l->after)
                l->after->light_to_world = move * l->after->light_to_world;
        }
    }
    // Warnings accepted by the importer are accepted here.
    RESTAGE_CHECK(check_edit(made.edit, Problem::Severity::error));
    sources_.note_all(imported.scene, path.string(), imported.importer, imported.options);
    history_.push(scene_, made.edit);
    for (const io::ReportEntry& entry : imported.report.entries) // the importer's placeholders stay behind as well
        if (entry.fate != io::Fate::kept || (entry.what != "camera" && entry.what != "environment"))
            report_.entries.push_back(entry);
    return made;
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

Result<> Session::save_project(const std::string& path) {
    const std::filesystem::path place = std::filesystem::absolute(path).lexically_normal();
    RESTAGE_CHECK(write_file_atomic(
        place,
        project_text({.base = base_, .scene = scene_, .sources = sources_, .unknown = unknown_, .looks = &looks()},
                     place.parent_path())));
    path_ = place.string();
    history_.mark_clean();
    return {};
}

std::string Session::recovery_text(const std::map<std::string, std::string>& note) const {
    return project_text(
        {.base = base_, .scene = scene_, .sources = sources_, .unknown = unknown_, .looks = &looks(), .note = &note},
        {});
}

} // namespace restage::document
