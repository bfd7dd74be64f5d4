// SPDX-License-Identifier: Apache-2.0
// PanelContext::drop and the placement of an inserted file at the mouse position.
#include "drop.hpp"

#include "collide_drag.hpp"
#include "document/linking.hpp"
#include "document/session.hpp"
#include "editor.hpp"
#include "files.hpp"
#include "io/image_file.hpp"
#include "library.hpp"
#include "opening.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "plugin/table_reader.hpp"
#include "project_texture.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "saving.hpp"
#include "scene/edits.hpp"
#include "scene/sky.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

std::string extension_of(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension.empty() ? extension : extension.substr(1);
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return word == w; });
}

constexpr std::initializer_list<const char*> picture_files = {"png",  "jpg", "jpeg", "tga", "bmp",
                                                              "webp", "hdr", "exr",  "pfm"};

const scene::Material* material_of(const DocumentContext& e, InstanceId id) {
    const scene::Instance* instance = e.scene().instances.find(id);
    return instance ? e.scene().materials.find(instance->material) : nullptr;
}

std::size_t users_of(const scene::Scene& s, scene::Id<scene::Material> id) {
    std::size_t count = 0;
    s.instances.each([&](InstanceId, const scene::Instance& i) { count += i.material == id; });
    return count;
}

// Object files are inserted into the open scene, and so are scene files that the Assets panel lists among the meshes.
bool is_inserted(const PanelContext& e, const fs::path& path) {
    if (e.scene().instances.live() == 0) return false;
    return is_one_of(extension_of(path), {"obj", "ply", "stl", "gltf", "glb"}) ||
           std::ranges::any_of(e.panel_state->assets.entries, [&](const Asset& asset) {
               return asset.kind == AssetKind::mesh && asset.path == path.string();
           });
}

bool becomes_sky(const std::string& extension, InstanceId on) {
    return !on || is_one_of(extension, {"hdr", "exr", "pfm"});
}

Result<scene::Edit> make_texture(const scene::Scene& s, const plugin::Registry& registry, scene::Id<scene::Material> id,
                                 const fs::path& path, const std::shared_ptr<const scene::PixelData>& pixels) {
    const scene::Material* material = s.materials.find(id);
    if (!material) return fail("There is no material for the image");
    const auto plugin = registry.find_material(material->type);
    if (!plugin)
        return fail("material \"" + material->name + "\": no plugin \"" + material->type +
                    "\" is loaded to say where an image goes");
    // The base colour comes first in every table.
    const auto& lines = plugin->table->params;
    const auto slot = std::ranges::find_if(
        lines, [](const model::Param& p) { return p.type == model::ParamType::color && p.texturable; });
    if (slot == lines.end())
        return fail(fmt::format("material \"{}\": a {} has no colour that an image could replace", material->name,
                                material->type));
    RESTAGE_TRY(scene::Edit edit, scene::set_image_texture(s, id, slot->id, model::ParamType::color, false,
                                                           scene::Image{.name = path.stem().string(),
                                                                        .path = path.string(),
                                                                        .encoding = scene::Encoding::srgb,
                                                                        .data = pixels}));
    edit.label = fmt::format("Texture {} on {}", path.stem().string(), material->name);
    return edit;
}

// A table file of the material there.
bool takes_table(const PanelContext& e, const std::string& extension, InstanceId on) {
    const scene::Material* material = material_of(e, on);
    const auto plugin = material ? e.registry().find_material(material->type) : std::nullopt;
    const auto reader = plugin ? plugin->source->table_reader() : nullptr;
    return reader && std::ranges::find(reader->extensions(), extension) != reader->extensions().end();
}

void drop_table(PanelContext& e, const fs::path& path, InstanceId on) {
    ask_scope(e, {on}, path.filename().string(), [path](SelectContext& editor, const MaterialScope& scope) {
        editor.edit([scope, file = path.string(), &registry = editor.registry()](const scene::Scene& s) {
            return edit_in_scope(
                s, scope, [&](const scene::Scene& now, scene::Id<scene::Material> id) -> Result<scene::Edit> {
                    const auto plugin = registry.find_material(now.materials[id].type);
                    if (!plugin) return fail("the material's plugin is no longer loaded");
                    const auto line =
                        std::ranges::find(plugin->table->params, model::ParamType::table, &model::Param::type);
                    return scene::set_param(now, id, line->id, scene::Value::table(file));
                });
        });
    });
}

// Reads it on a thread, then calls `with` on the main one.
void with_image(PanelUi& e, const fs::path& path,
                std::function<void(PanelContext&, std::shared_ptr<const scene::PixelData>)> with) {
    e.files().jobs.start({.title = "Reading " + path.filename().string()},
                         [path, with = std::move(with)](BackgroundJob&) -> std::function<void(PanelContext&)> {
                             auto pixels = io::read_image(path.string(), scene::Encoding::srgb);
                             if (!pixels)
                                 return [message = pixels.error().message](PanelContext& editor) {
                                     editor.notices.add(LogLevel::error, message);
                                 };
                             return [with, data = std::make_shared<const scene::PixelData>(std::move(*pixels))](
                                        PanelContext& editor) { with(editor, data); };
                         });
}

void drop_image(PanelContext& e, const fs::path& path, InstanceId on) {
    if (becomes_sky(extension_of(path), on))
        return with_image(e, path, [path](PanelContext& editor, std::shared_ptr<const scene::PixelData> data) {
            editor.edit([path, data = std::move(data), up = editor.up()](const scene::Scene& s) {
                return Result<scene::Edit>(scene::image_sky(s, path.string(), data, up));
            });
        });
    ask_scope(e, {on}, path.filename().string(), [path](SelectContext& editor, const MaterialScope& scope) {
        with_image(editor, path, [path, scope](PanelContext& ed, std::shared_ptr<const scene::PixelData> data) {
            ed.edit([path, scope, data = std::move(data), &ed](const scene::Scene& s) {
                return edit_in_scope(s, scope, [&](const scene::Scene& now, scene::Id<scene::Material> id) {
                    return project_where_needed(ed, now, make_texture(now, ed.registry(), id, path, data), id);
                });
            });
        });
    });
}

} // namespace

InstanceId target_at(const PanelContext& e, glm::dvec2 film) {
    if (film.x < 0 || film.y < 0 || film.x >= 1 || film.y >= 1 || e.scene().instances.live() == 0) return {};
    const query::ViewRay ray = query::view_ray(e.camera(), film, e.film_aspect());
    const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
    return hits.empty() ? InstanceId{} : hits[0].instance;
}

void PanelContext::drop(const std::vector<fs::path>& paths, ImVec2 screen) {
    const glm::dvec2 film = viewport.film_point(screen);
    const bool over = film.x >= 0 && film.y >= 0 && film.x < 1 && film.y < 1;
    const InstanceId on = target_at(*this, film);
    for (const fs::path& given : paths) {
        const fs::path path = fs::absolute(given).lexically_normal();
        const std::string extension = extension_of(path);
        if (extension == "json") {
            drop_preset(*this, path, on);
            continue;
        }
        if (is_one_of(extension, picture_files)) drop_image(*this, path, on);
        // Other scenes, and any file if no scene is open, are opened.
        else if (takes_table(*this, extension, on))
            drop_table(*this, path, on);
        else if (is_inserted(*this, path))
            insert(path, over ? std::optional(film) : std::nullopt);
        else {
            open(path);
            return; // only one of them
        }
    }
}

void drop_tip(PanelContext& e, const std::string& text, const std::string& onto, ImVec2 screen) {
    // Not beyond the window's right edge.
    const bool right = screen.x > ImGui::GetMainViewport()->GetCenter().x;
    ImGui::SetNextWindowPos({screen.x + (right ? -8.f : 16.f), screen.y + 12}, ImGuiCond_Always,
                            {right ? 1.f : 0.f, 0});
    if (ImGui::BeginTooltip()) {
        ImGui::TextUnformatted(text.c_str());
        e.mark("drop.preview");
        if (!onto.empty()) e.mark("drop.onto." + onto);
        ImGui::EndTooltip();
    }
}

void preview_drop(PanelContext& e, const fs::path& path, ImVec2 screen) {
    const std::string extension = extension_of(path), name = path.stem().string();
    const InstanceId on = target_at(e, e.viewport.film_point(screen));
    const bool picture = is_one_of(extension, picture_files), table = !picture && takes_table(e, extension, on);
    std::string text, onto;
    if (picture && becomes_sky(extension, on)) {
        text = name + " becomes the sky";
    } else if (picture || table) {
        e.drop_target = on;
        const scene::Material* material = material_of(e, on);
        const std::size_t users = material ? users_of(e.scene(), e.scene().instances[on].material) : 0;
        if (material) onto = material->name;
        text = !material ? "There is no material for " + name
               : users > 1
                   ? fmt::format("{} onto \"{}\", the material of {} objects", name, onto, users)
                   : fmt::format("{} onto \"{}\", the material of {}", name, onto, e.scene().instances[on].name);
    } else if (is_inserted(e, path)) {
        e.drop_target = on;
        text = on ? fmt::format("{}, to stand on {}", name, e.scene().instances[on].name) : name + ", into the scene";
        text += ImGui::GetIO().KeyAlt ? ", linked" : " (with Alt: linked)";
    } else {
        text = name + " is opened";
    }
    drop_tip(e, text, onto, screen);
}

void ask_scope(SelectContext& e, const std::vector<InstanceId>& objects, const std::string& what,
               std::function<void(SelectContext&, const MaterialScope&)> then) {
    const scene::Material* material = objects.empty() ? nullptr : material_of(e, objects.back());
    const auto id = material ? e.scene().instances[objects.back()].material : scene::Id<scene::Material>{};
    std::vector<InstanceId> mine; // those that have it
    for (const InstanceId one : objects)
        if (const scene::Instance* instance = e.scene().instances.find(one); instance && instance->material == id)
            mine.push_back(one);
    const std::size_t users = material ? users_of(e.scene(), id) : 0;
    if (users <= mine.size()) return then(e, {.alone = false, .objects = mine});
    const std::string these =
        mine.size() == 1 ? "Only " + e.scene().instances[mine[0]].name : fmt::format("Only these {}", mine.size());
    e.show_modal("Shared material", [text = fmt::format("{} goes onto the material \"{}\", which {} objects have.",
                                                        what, material->name, users),
                                     these, users, mine, then = std::move(then)](PanelContext& editor) {
        dialog_width(420);
        ImGui::TextWrapped("%s", text.c_str());
        ImGui::Spacing();
        bool stay = true;
        const auto choice = [&](const std::string& label, const char* mark, bool alone) {
            if (ImGui::Button((label + "###" + mark).c_str())) {
                editor.later([&editor, then, alone, mine] { then(editor, {alone, mine}); });
                stay = false;
            }
            editor.mark(mark);
        };
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        choice(these, "scope.alone", true);
        choice(fmt::format("All {} objects", users), "scope.all", false);
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("scope.cancel");
        return stay;
    });
}

Result<scene::Edit> edit_in_scope(
    const scene::Scene& s, const MaterialScope& scope,
    const std::function<Result<scene::Edit>(const scene::Scene&, scene::Id<scene::Material>)>& build) {
    const scene::Instance* instance = scope.objects.empty() ? nullptr : s.instances.find(scope.objects.back());
    if (!instance || !s.materials.find(instance->material)) return fail("There is no material to apply it to");
    if (!scope.alone) return build(s, instance->material);
    RESTAGE_TRY(scene::MadeUnique unique, scene::make_unique(s, scope.objects, instance->material));
    scene::Scene apart = s; // shares its data
    scene::apply(apart, unique.edit);
    RESTAGE_TRY(scene::Edit edit, build(apart, unique.material));
    unique.edit.changes.insert(unique.edit.changes.end(), std::make_move_iterator(edit.changes.begin()),
                               std::make_move_iterator(edit.changes.end()));
    unique.edit.label = std::move(edit.label);
    return std::move(unique.edit);
}

void Editor::place_inserted(const io::ImportedScene& imported) {
    const Opening::Request& request = opening_->request();
    // It stands on the visible surface there, or hangs from it.
    const query::ViewRay ray =
        query::view_ray(camera(), request.film_point.value_or(glm::dvec2(0.5, 0.6)), film_aspect());
    const auto hits = query::raycast_all(scene(), ray.origin, ray.direction);
    const scene::Bounds all = scene::world_bounds(scene());
    const double away = all.empty() ? 1 : std::max(glm::length(all.center() - ray.origin), 1e-6);
    glm::dvec3 at = hits.empty() ? ray.origin + glm::normalize(ray.direction) * away : hits[0].position;
    if (hits.empty() || glm::dot(hits[0].normal, up_) > 0.5) { // else it hangs there
        const scene::Bounds box = scene::world_bounds(imported.scene);
        std::vector<InstanceId> ids;
        imported.scene.instances.each([&](InstanceId id, const scene::Instance&) { ids.push_back(id); });
        if (!box.empty())
            at += room_for(
                *this, imported.scene, ids,
                glm::translate(glm::dmat4(1), at - box.center() + 0.5 * std::abs(glm::dot(box.size(), up_)) * up_));
    }
    const document::Session::Stand stand{at, up_, hits.empty() ? glm::dvec3(0) : hits[0].normal};
    const auto made = request.link ? document::link(*session_, imported, request.path.string(), stand)
                                   : session_->insert(imported, request.path.string(), stand);
    if (!made) {
        notices.add(LogLevel::error, made.error().message);
        return;
    }
    selection.set(made->instances);
    const auto dropped = imported.report.count(io::Fate::dropped);
    notices.add(LogLevel::info,
                fmt::format("{}: {} objects {}{}", request.path.filename().string(), made->instances.size(),
                            request.link ? "linked" : "inserted",
                            dropped ? fmt::format(", {} things dropped: see Import report", dropped) : ""));
}

} // namespace restage::editor
