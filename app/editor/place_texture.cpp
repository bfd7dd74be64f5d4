// SPDX-License-Identifier: Apache-2.0
#include "place_texture.hpp"

#include "document/session.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/box_projection.hpp"
#include "theme.hpp"
#include "viewport.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace restage::editor {

namespace {

using TextureId = scene::Id<scene::Texture>;
using Hold = TexturePlacing::Hold;
constexpr const char* gesture = "place texture";

// The frame's plane: the tangent plane, in which lengths and angles are those of the world.
struct Plane {
    glm::dvec3 middle, x, y, normal;
    glm::dmat2 from_uv; // displacements

    explicit Plane(const query::SurfaceSite& site)
        : middle(site.position),
          x(glm::normalize(site.dpdu)),
          y(glm::cross(site.normal, x)),
          normal(site.normal),
          from_uv(in(site.dpdu), in(site.dpdv)) {}
    glm::dvec2 in(const glm::dvec3& by) const { return {glm::dot(by, x), glm::dot(by, y)}; }
    glm::dvec3 at(const glm::dvec2& p) const { return middle + p.x * x + p.y * y; }
    std::optional<glm::dvec2> under(const query::ViewRay& ray) const {
        const double t = glm::dot(middle - ray.origin, normal) / glm::dot(ray.direction, normal);
        if (!std::isfinite(t) || t <= 0) return std::nullopt;
        return in(ray.origin + t * ray.direction - middle);
    }
};

const scene::Texture* shown(const PanelContext& e) {
    const TexturePlacing& p = e.viewport.placing;
    return p.textures.empty() ? nullptr : e.scene().textures.find(p.textures[0]);
}

// From the texture's own coordinates to the plane; none if the map has no inverse.
std::optional<glm::dmat2> from_texture(const Plane& plane, const scene::TextureMap& map) {
    if (std::abs(glm::determinant(map.linear)) < 1e-12) return std::nullopt;
    return plane.from_uv * glm::inverse(map.linear);
}

query::ViewRay ray_at(const PanelContext& e, ImVec2 screen) {
    return query::view_ray(e.camera(), e.viewport.film_point(screen), e.film_aspect());
}

float distance(ImVec2 a, ImVec2 b) { return std::hypot(a.x - b.x, a.y - b.y); }

// What is drawn: the corners in order, and the ring around them.
struct Frame {
    std::array<ImVec2, 4> corners;
    std::vector<ImVec2> ring;
    ImVec2 middle, knob;
};

std::optional<Frame> frame_of(const PanelContext& e, const Plane& plane, const glm::dmat2& to_plane, double repeats) {
    Frame frame;
    constexpr glm::dvec2 signs[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double radius = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec2 p = to_plane * (signs[i] * (0.5 * repeats));
        radius = std::max(radius, glm::length(p));
        const auto at = e.viewport.on_screen(e, plane.at(p));
        if (!at) return std::nullopt;
        frame.corners[i] = *at;
    }
    radius *= 1.15;
    const glm::dvec2 along = glm::normalize(to_plane[0]) * radius;
    constexpr int pieces = 64;
    for (int i = 0; i <= pieces; ++i) {
        const double a = glm::two_pi<double>() * i / pieces, c = std::cos(a), s = std::sin(a);
        const auto at = e.viewport.on_screen(e, plane.at({c * along.x - s * along.y, s * along.x + c * along.y}));
        if (!at) return std::nullopt;
        frame.ring.push_back(*at);
    }
    const auto middle = e.viewport.on_screen(e, plane.middle);
    if (!middle) return std::nullopt;
    frame.middle = *middle;
    frame.knob = frame.ring[0];
    return frame;
}

// A number of repetitions with which the frame can be handled, 1 if possible.
double suitable_repeats(const PanelContext& e, const Plane& plane, const glm::dmat2& to_plane) {
    const float least = 60 * ImGui::GetStyle().FontScaleMain,
                most = 0.5f * std::min(e.viewport.size.x, e.viewport.size.y);
    double repeats = 1;
    for (int i = 0; i < 40; ++i) {
        const auto frame = frame_of(e, plane, to_plane, repeats);
        float side = most + 1; // it reaches behind the camera
        if (frame)
            side = std::max(distance(frame->corners[0], frame->corners[1]),
                            distance(frame->corners[1], frame->corners[2]));
        if (side > most)
            repeats /= 2;
        else if (side < least && 2 * side <= most)
            repeats *= 2;
        else
            break;
    }
    return repeats;
}

bool inside(const std::array<ImVec2, 4>& corners, ImVec2 p) {
    int sign = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const ImVec2 a = corners[i], b = corners[(i + 1) % 4];
        const float side = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
        const int now = side > 0 ? 1 : -1;
        if (sign != 0 && now != sign) return false;
        sign = now;
    }
    return true;
}

Hold handle_at(const Frame& frame, ImVec2 mouse) {
    const float reach = 9 * ImGui::GetStyle().FontScaleMain;
    for (const ImVec2 corner : frame.corners)
        if (distance(corner, mouse) <= reach) return Hold::corner;
    for (std::size_t i = 0; i + 1 < frame.ring.size(); ++i) {
        const ImVec2 a = frame.ring[i], b = frame.ring[i + 1];
        if (distance({(a.x + b.x) / 2, (a.y + b.y) / 2}, mouse) <= std::max(reach, distance(a, b) / 2))
            return Hold::ring;
    }
    return inside(frame.corners, mouse) ? Hold::inside : Hold::none;
}

double nearest_whole(double repeats) {
    return repeats >= 1 ? std::round(repeats) : 1 / std::round(1 / std::max(repeats, 1e-3));
}

// The map of the gesture, and what it did in words. `p.place` follows the mouse while the picture is moved.
struct Change {
    std::function<scene::TextureMap(const scene::TextureMap&)> map;
    std::string text, verb;
};
std::optional<Change> change_of(PanelContext& e, TexturePlacing& p, ImVec2 mouse, bool snap) {
    const TexturePlacing::Grip& grip = p.grip;
    const Plane plane(grip.site);
    const scene::TextureMap& start = grip.maps[0].second;
    const query::ViewRay ray = ray_at(e, mouse);
    if (p.held == Hold::inside) {
        glm::dvec2 uv;
        if (const auto place = query::place_on(e.scene(), p.place.instance, ray.origin, ray.direction);
            const auto site = place ? query::site_at(e.scene(), *place, start.set) : std::nullopt) {
            uv = site->uv;
        } else { // beside the object: on the plane
            const auto at = plane.under(ray);
            if (!at) return std::nullopt;
            uv = grip.site.uv + glm::inverse(plane.from_uv) * *at;
        }
        const query::ViewRay middle = ray_at(e, {mouse.x + p.grip.offset.x, mouse.y + p.grip.offset.y});
        if (const auto place = query::place_on(e.scene(), p.place.instance, middle.origin, middle.direction);
            place && query::site_at(e.scene(), *place, start.set))
            p.place = *place;
        glm::dvec2 by = start.linear * (uv - grip.uv); // in repetitions
        if (snap) by[std::abs(by.x) > std::abs(by.y) ? 1 : 0] = 0;
        const glm::dvec2 to = grip.uv + glm::inverse(start.linear) * by;
        return Change{[from = grip.uv, to](const scene::TextureMap& map) { return scene::moved(map, from, to); },
                      fmt::format("{:+.3g}, {:+.3g} repeats", by.x, by.y), "Move"};
    }
    const auto at = plane.under(ray);
    if (!at || glm::length(*at) < 1e-12) return std::nullopt;
    const auto to_plane = from_texture(plane, start);
    if (!to_plane) return std::nullopt;
    if (p.held == Hold::ring) {
        double angle = std::atan2(grip.at.x * at->y - grip.at.y * at->x, glm::dot(grip.at, *at));
        const double before = std::atan2((*to_plane)[0].y, (*to_plane)[0].x);
        constexpr double step = glm::radians(15.0);
        if (snap) angle = std::round((before + angle) / step) * step - before;
        const glm::dmat2 turn(std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle));
        const glm::dmat2 by = glm::inverse(plane.from_uv) * turn * plane.from_uv;
        return Change{
            [by, about = grip.site.uv](const scene::TextureMap& map) { return scene::transformed(map, by, about); },
            fmt::format("{:.1f}°", glm::degrees(std::remainder(before + angle, glm::two_pi<double>()))), "Turn"};
    }
    double factor = std::clamp(glm::length(*at) / glm::length(grip.at), 1e-3, 1e3);
    const double repeats = std::hypot(start.linear[0][0], start.linear[1][0]); // in a unit of uv
    if (snap) factor = repeats / nearest_whole(repeats / factor);
    p.repeats = grip.repeats;
    return Change{
        [factor, about = grip.site.uv](const scene::TextureMap& map) {
            return scene::stretched(map, glm::dvec2(factor), about);
        },
        fmt::format("{:.3g} × {:.3g} per repeat, {:.3g} in a unit of uv", factor * glm::length((*to_plane)[0]),
                    factor * glm::length((*to_plane)[1]), repeats / factor),
        "Scale"};
}

void drag(PanelContext& e, TexturePlacing& p, ImVec2 mouse, std::string& text) {
    const auto change = change_of(e, p, mouse, ImGui::GetIO().KeyShift);
    if (!change) return;
    text = change->text;
    std::vector<std::pair<TextureId, scene::TextureMap>> maps = p.grip.maps;
    for (auto& [id, map] : maps)
        map = change->map(map);
    const scene::Texture* first = e.scene().textures.find(maps[0].first);
    e.edit([maps = std::move(maps), label = change->verb + " texture " + (first ? first->name : "")](
               const scene::Scene& s) { return scene::set_texture_maps(s, maps, label); },
           gesture);
}

void grip(PanelContext& e, TexturePlacing& p, const query::SurfaceSite& site, Hold held, const Frame& frame,
          ImVec2 mouse) {
    TexturePlacing::Grip grip{.maps = {}, .site = site, .repeats = p.repeats};
    for (const TextureId id : p.textures)
        if (const scene::Texture* texture = e.scene().textures.find(id))
            grip.maps.emplace_back(id, scene::texture_map(texture->params));
    const query::ViewRay ray = ray_at(e, mouse);
    const Plane plane(site);
    grip.at = plane.under(ray).value_or(glm::dvec2(1, 0));
    grip.uv = site.uv + glm::inverse(plane.from_uv) * grip.at;
    if (const auto place = query::place_on(e.scene(), p.place.instance, ray.origin, ray.direction))
        if (const auto under = query::site_at(e.scene(), *place, grip.maps[0].second.set)) grip.uv = under->uv;
    grip.offset = {frame.middle.x - mouse.x, frame.middle.y - mouse.y};
    p.grip = std::move(grip);
    p.held = held;
}

// Text and buttons at the top of the picture.
void draw_bar(PanelContext& e, TexturePlacing& p) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    const Viewport& v = e.viewport;
    const float width = std::min(380 * scale, v.size.x - 16 * scale);
    ImGui::SetCursorScreenPos({v.corner.x + (v.size.x - width) / 2, v.corner.y + 8 * scale});
    ImGui::BeginChild("placing", {width, 0}, ImGuiChildFlags_Borders | ImGuiChildFlags_AutoResizeY);
    std::string name = shown(e)->name;
    if (p.textures.size() > 1) name += fmt::format(" and {} more of its material", p.textures.size() - 1);
    ImGui::TextColored(colors::accent, "%s", name.c_str());
    ImGui::TextWrapped(
        "Drag inside to move it, a corner to scale it, the ring to turn it. Shift: along one direction, whole repeats, "
        "15°. A click elsewhere on the object brings the frame there.");
    e.mark("placing.note");
    const scene::TextureUsers users = scene::users_of(e.scene(), p.textures);
    if (users.objects > 1) {
        ImGui::TextColored(colors::hover, "%s",
                           users.materials > 1
                               ? fmt::format("On {} objects, by {} materials", users.objects, users.materials).c_str()
                               : fmt::format("On {} objects, which share the material", users.objects).c_str());
        e.mark("placing.shared");
        const scene::Instance& object = e.scene().instances[p.place.instance];
        if (ImGui::Button("Make it this object's own"))
            e.change([&e, id = p.place.instance, material = object.material,
                      textures = p.textures](document::Session& session) {
                auto own = scene::own_textures(session.scene(), std::span(&id, 1), material, textures);
                if (!own) return e.notices.add(LogLevel::error, own.error().message);
                if (const auto done = session.edit(std::move(own->edit)); !done)
                    return e.notices.add(LogLevel::error, done.error().message);
                TexturePlacing& now = e.viewport.placing;
                now.material = own->material;
                for (TextureId& texture : now.textures)
                    if (const auto copy = own->copies.find(texture); copy != own->copies.end()) texture = copy->second;
            });
        tip(("A copy of the texture, and of the material where others have it, for " + object.name +
             " alone; the others stay as they are")
                .c_str());
        e.mark("placing.own");
        ImGui::SameLine();
    }
    if (ImGui::Button("Done")) end_placing(e);
    tip("Enter or Esc");
    e.mark("placing.done");
    ImGui::EndChild();
}

void draw_frame(PanelContext& e, const Frame& frame, Hold hot, const std::string& text) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    const Viewport& v = e.viewport;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(v.corner, {v.corner.x + v.size.x, v.corner.y + v.size.y}, true);
    const ImU32 ground = ImGui::GetColorU32(colors::over_picture);
    const auto color = [&](Hold one) { return ImGui::GetColorU32(hot == one ? colors::hover : colors::accent); };
    for (const bool dark : {true, false}) {
        const float width = (dark ? 4 : 2) * scale;
        draw->AddPolyline(frame.ring.data(), int(frame.ring.size()), dark ? ground : color(Hold::ring), width);
        draw->AddPolyline(frame.corners.data(), 4, dark ? ground : color(Hold::inside), width, ImDrawFlags_Closed);
    }
    draw->AddCircleFilled(frame.knob, 6 * scale, color(Hold::ring));
    draw->AddCircleFilled(frame.middle, 2.5f * scale, color(Hold::inside));
    for (const ImVec2 c : frame.corners) {
        const float half = 5 * scale;
        draw->AddRectFilled({c.x - half - scale, c.y - half - scale}, {c.x + half + scale, c.y + half + scale}, ground);
        draw->AddRectFilled({c.x - half, c.y - half}, {c.x + half, c.y + half}, color(Hold::corner));
    }
    if (!text.empty()) {
        const ImVec2 extent = ImGui::CalcTextSize(text.c_str()), mouse = ImGui::GetIO().MousePos;
        const ImVec2 at(mouse.x + 16 * scale, mouse.y + 16 * scale);
        draw->AddRectFilled({at.x - 5 * scale, at.y - 3 * scale},
                            {at.x + extent.x + 5 * scale, at.y + extent.y + 3 * scale}, ground, 3 * scale);
        draw->AddText(at, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
        e.mark("placing.value", at, {at.x + extent.x, at.y + extent.y});
    }
    draw->PopClipRect();
    e.mark("placing.middle", frame.middle);
    e.mark("placing.ring", frame.knob);
    for (std::size_t i = 0; i < 4; ++i)
        e.mark("placing.corner." + std::to_string(i), frame.corners[i]);
}

// A visible place of the object: under the mouse, else near the middle of what the picture shows of it.
std::optional<query::SurfacePlace> visible_place(const PanelContext& e, InstanceId object, int set) {
    const Viewport& v = e.viewport;
    const auto place_at = [&](ImVec2 screen) -> std::optional<query::SurfacePlace> {
        const query::ViewRay ray = ray_at(e, screen);
        const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
        if (hits.empty() || hits[0].instance != object) return std::nullopt;
        const auto place = query::place_on(e.scene(), object, ray.origin, ray.direction);
        return place && query::site_at(e.scene(), *place, set) ? place : std::nullopt;
    };
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (v.instance_at(e, mouse) == object)
        if (const auto place = place_at(mouse)) return place;
    constexpr int across = 40;
    std::vector<ImVec2> seen;
    ImVec2 sum(0, 0);
    for (int y = 0; y < across; ++y)
        for (int x = 0; x < across; ++x) {
            const ImVec2 at(v.corner.x + (float(x) + 0.5f) / across * v.size.x,
                            v.corner.y + (float(y) + 0.5f) / across * v.size.y);
            if (v.instance_at(e, at) != object) continue;
            seen.push_back(at);
            sum = {sum.x + at.x, sum.y + at.y};
        }
    if (seen.empty()) return std::nullopt;
    const ImVec2 middle(sum.x / float(seen.size()), sum.y / float(seen.size()));
    std::ranges::sort(seen, {}, [&](ImVec2 at) { return distance(at, middle); });
    constexpr std::size_t tries = 30; // the picture may be coarse
    for (std::size_t i = 0; i < std::min(seen.size(), tries); ++i)
        if (const auto place = place_at(seen[i])) return place;
    return std::nullopt;
}

} // namespace

void ask_to_place(EditContext& e, TextureId texture) {
    e.panel_state->texture_to_place = texture;
    e.run("edit.place_texture");
}

void begin_placing(PanelContext& e) {
    const TextureId asked = std::exchange(e.panel_state->texture_to_place, {});
    const InstanceId object = e.selection.active();
    const scene::Instance* instance = e.scene().instances.find(object);
    const scene::Material* material = instance ? e.scene().materials.find(instance->material) : nullptr;
    const scene::Mesh* mesh = instance ? e.scene().meshes.find(instance->mesh) : nullptr;
    const auto say = [&](const std::string& text) { e.notices.add(LogLevel::info, text); };
    if (!material || !mesh) return say("Select an object with a texture to place it");
    TexturePlacing placing{.on = true, .place = {}, .material = instance->material, .textures = {}, .grip = {}};
    scene::TextureMap map;
    for (const TextureId id : scene::textures_of(e.scene(), *material)) {
        const scene::Texture& texture = e.scene().textures[id];
        const auto plugin = e.registry().find_texture(texture.type);
        if (!plugin || !plugin->table->mapped) continue;
        if (placing.textures.empty() && asked && id != asked) continue;
        const scene::TextureMap own = scene::texture_map(texture.params);
        if (placing.textures.empty()) map = own;
        if (own == map) placing.textures.push_back(id);
    }
    if (placing.textures.empty())
        return say(material->name + " has no texture with a place on the surface: give a colour an image first");
    if (asked) // those before it, too
        for (const TextureId id : scene::textures_of(e.scene(), *material)) {
            const auto plugin = e.registry().find_texture(e.scene().textures[id].type);
            if (plugin && plugin->table->mapped && scene::texture_map(e.scene().textures[id].params) == map &&
                std::ranges::find(placing.textures, id) == placing.textures.end())
                placing.textures.push_back(id);
        }
    if (!scene::has_uv(*mesh)) {
        say(instance->name + " has no texture coordinates yet");
        return e.run("edit.project_texture");
    }
    const auto place = visible_place(e, object, map.set);
    if (!place) return say(instance->name + " is not visible in the picture, or its texture coordinates do not vary");
    placing.place = *place;
    const Plane plane(*query::site_at(e.scene(), *place, map.set));
    if (const auto to_plane = from_texture(plane, map))
        placing.repeats = suitable_repeats(e, plane, *to_plane);
    else
        return say(e.scene().textures[placing.textures[0]].name + " is stretched to a line: reset its repeats first");
    e.viewport.placing = std::move(placing);
}

void end_placing(PanelContext& e) {
    if (e.viewport.placing.held != Hold::none) e.end_gesture();
    e.viewport.placing = {};
}

void cancel_placing(PanelContext& e) {
    TexturePlacing& p = e.viewport.placing;
    if (p.held == Hold::none) return;
    e.change([](document::Session& session) { session.cancel_gesture(); });
    p.held = Hold::none;
    p.repeats = p.grip.repeats;
}

bool run_placing(PanelContext& e, bool over) {
    TexturePlacing& p = e.viewport.placing;
    if (!p.on) return false;
    const scene::Texture* texture = shown(e);
    const auto site =
        texture ? query::site_at(e.scene(), p.place, scene::texture_map(texture->params).set) : std::nullopt;
    const scene::Instance* object = e.scene().instances.find(p.place.instance);
    if (!site || !object || object->material != p.material || !e.selection.contains(p.place.instance)) {
        end_placing(e); // undone, removed, or something else was selected
        return false;
    }
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Plane plane(*site);
    const auto to_plane = from_texture(plane, scene::texture_map(texture->params));
    const auto frame = to_plane ? frame_of(e, plane, *to_plane, p.repeats) : std::nullopt;
    Hold hot = p.held;
    std::string text;
    if (p.held != Hold::none) {
        if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) {
            p.held = Hold::none;
            e.end_gesture();
            if (to_plane) p.repeats = suitable_repeats(e, plane, *to_plane);
        } else {
            drag(e, p, mouse, text);
        }
    } else if (frame && over) {
        hot = handle_at(*frame, mouse);
        if (hot != Hold::none)
            ImGui::SetMouseCursor(hot == Hold::inside ? ImGuiMouseCursor_ResizeAll : ImGuiMouseCursor_Hand);
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
            if (hot != Hold::none) {
                grip(e, p, *site, hot, *frame, mouse);
            } else {
                const query::ViewRay ray = ray_at(e, mouse);
                const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction);
                const auto place = query::place_on(e.scene(), p.place.instance, ray.origin, ray.direction);
                if (!hits.empty() && hits[0].instance == p.place.instance && place)
                    p.place = *place;
                else
                    end_placing(e);
                return true;
            }
        }
    }
    if (frame) draw_frame(e, *frame, hot, text);
    draw_bar(e, p);
    if (p.held == Hold::none && ImGui::IsKeyPressed(ImGuiKey_Enter, false) && !ImGui::GetIO().WantTextInput)
        end_placing(e);
    return true;
}

} // namespace restage::editor
