// SPDX-License-Identifier: Apache-2.0
// Editor::drop and what becomes of an inserted file: things arrive where the mouse is.
#include "editor.hpp"
#include "files.hpp"
#include "io/image_file.hpp"
#include "plugin/table_reader.hpp"
#include "saving.hpp"
#include "session/navigation.hpp"
#include "session/raycast.hpp"
#include "session/sky.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

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

Result<scene::Edit> make_texture(const scene::Scene& s, const plugin::Registry& registry, InstanceId on,
                                 const fs::path& path, const std::shared_ptr<const scene::PixelData>& pixels) {
    const scene::Instance* instance = s.instances.find(on);
    const scene::Material* material = instance ? s.materials.find(instance->material) : nullptr;
    if (!material) return fail("There is no material for the image to go on");
    const auto plugin = registry.find_material(material->type);
    if (!plugin)
        return fail("material \"" + material->name + "\": there is no plugin \"" + material->type +
                    "\" that could say where an image goes");
    // The base colour comes first in every table.
    const RestageParam* begin = plugin->table->params;
    const RestageParam* end = begin + plugin->table->param_count;
    const RestageParam* slot = std::find_if(begin, end, [](const RestageParam& p) {
        return p.type == RESTAGE_COLOR && (p.flags & RESTAGE_PARAM_TEXTURABLE);
    });
    if (slot == end)
        return fail(fmt::format("material \"{}\": a {} has no colour an image could stand for", material->name,
                                material->type));
    RESTAGE_TRY(scene::Edit edit, scene::set_image_texture(s, instance->material, slot->id, RESTAGE_COLOR, false,
                                                           scene::Image{.name = path.stem().string(),
                                                                        .path = path.string(),
                                                                        .encoding = RESTAGE_SRGB,
                                                                        .data = pixels}));
    edit.label = fmt::format("Texture {} on {}", path.stem().string(), material->name);
    return edit;
}

// A file that the material there looks up.
bool drop_table(Editor& e, const fs::path& path, const std::string& extension, InstanceId on) {
    const scene::Instance* instance = e.scene().instances.find(on);
    const scene::Material* material = instance ? e.scene().materials.find(instance->material) : nullptr;
    const auto plugin = material ? e.registry().find_material(material->type) : std::nullopt;
    const auto reader = plugin ? plugin->source->table_reader() : nullptr;
    if (!reader || std::ranges::find(reader->extensions(), extension) == reader->extensions().end()) return false;
    const RestageParam* begin = plugin->table->params;
    const RestageParam* line = std::find_if(begin, begin + plugin->table->param_count,
                                            [](const RestageParam& p) { return p.type == RESTAGE_TABLE; });
    e.edit([id = instance->material, param = std::string(line->id), file = path.string()](const scene::Scene& s) {
        return scene::set_param(s, id, param, scene::Value::table(file));
    });
    return true;
}

void drop_image(Editor& e, const fs::path& path, InstanceId on) {
    const std::string extension = extension_of(path);
    const bool sky = !on || is_one_of(extension, {"hdr", "exr", "pfm"});
    e.files().jobs.start(
        {.title = "Reading " + path.filename().string()},
        [path, sky, on](BackgroundJob&) -> std::function<void(Editor&)> {
            auto pixels = io::read_image(path.string(), RESTAGE_SRGB);
            if (!pixels)
                return [message = pixels.error().message](Editor& editor) {
                    editor.notices.add(LogLevel::error, message);
                };
            return
                [path, sky, on, data = std::make_shared<const scene::PixelData>(std::move(*pixels))](Editor& editor) {
                    editor.edit(
                        [path, sky, on, data, up = editor.up(), &registry = editor.registry()](const scene::Scene& s) {
                            return sky ? Result<scene::Edit>(session::image_sky(s, path.string(), data, up))
                                       : make_texture(s, registry, on, path, data);
                        });
                };
        });
}

} // namespace

void Editor::drop(const std::vector<fs::path>& paths, ImVec2 screen) {
    const glm::dvec2 film = viewport.film_point(screen);
    const bool over = film.x >= 0 && film.y >= 0 && film.x < 1 && film.y < 1;
    InstanceId on; // asked of the scene, not of the picture, which may be of another moment
    if (over && scene().instances.live() > 0) {
        const session::ViewRay ray = session::view_ray(camera(), film, film_aspect());
        if (const auto hits = session::raycast_all(scene(), ray.origin, ray.direction); !hits.empty())
            on = hits[0].instance;
    }
    for (const fs::path& given : paths) {
        const fs::path path = fs::absolute(given).lexically_normal();
        const std::string extension = extension_of(path);
        if (is_one_of(extension, {"png", "jpg", "jpeg", "tga", "bmp", "hdr", "exr", "pfm"}))
            drop_image(*this, path, on);
        // Files of objects join what is there; scenes, and anything when there is nothing yet, are opened.
        else if (drop_table(*this, path, extension, on))
            continue;
        else if (is_one_of(extension, {"obj", "ply", "stl", "gltf", "glb"}) && scene().instances.live() > 0)
            insert(path, over ? std::optional(film) : std::nullopt);
        else {
            open(path);
            return; // there is room for one
        }
    }
}

void Editor::place_inserted(const io::ImportedScene& imported) {
    const Opening::Request& request = opening_.request();
    // The middle of its underside comes to stand on what is seen there.
    const session::ViewRay ray =
        session::view_ray(camera(), request.film_point.value_or(glm::dvec2(0.5, 0.6)), film_aspect());
    const auto hits = session::raycast_all(scene(), ray.origin, ray.direction);
    const scene::Bounds all = scene::world_bounds(scene());
    const double away = all.empty() ? 1 : std::max(glm::length(all.center() - ray.origin), 1e-6);
    const glm::dvec3 at = hits.empty() ? ray.origin + glm::normalize(ray.direction) * away : hits[0].position;
    const auto made = session_.insert(imported, request.path.string(), session::Session::Stand{at, up_});
    if (!made) {
        notices.add(LogLevel::error, made.error().message);
        return;
    }
    selection.set(made->instances);
    const auto dropped = imported.report.count(RESTAGE_DROPPED);
    notices.add(LogLevel::info,
                fmt::format("{}: {} objects inserted{}", request.path.filename().string(), made->instances.size(),
                            dropped ? fmt::format(", {} things dropped: see Import report", dropped) : ""));
}

} // namespace restage::editor
