// SPDX-License-Identifier: Apache-2.0
// Scatter: copies the selected objects over the surface that was selected last.
#include "source.hpp"
#include "surface.hpp"

#include <restage/action.h>
#include <algorithm>
#include <cstring>
#include <restage/plugin.hpp>

namespace {

using namespace restage::sdk;
using namespace scatter;

constexpr std::size_t most_copies = 200000;
constexpr std::size_t darts_a_copy = 32; // darts per copy at most, on average

constexpr RestageParam params[] = {
    choice("amount", "Amount", "count|density", 0, {.tooltip = "Either a number of copies or a number per unit area."}),
    integer("count", "Count", 1, int(most_copies), 100, {.tooltip = "Number of copies if the amount is a count."}),
    number("density", "Density", 0, 1e6f, 1, {.tooltip = "Copies per unit area if the amount is a density."}),
    integer("seed", "Seed", 0, 1000000, 1, {.tooltip = "Each seed gives a different arrangement."}),
    number("distance", "Least distance", 0, 1e6f, 0,
           {.tooltip = "Minimum distance between two copies, in scene units; 0 = unlimited."}),
    number("scale_min", "Smallest", 0.001f, 1000, 0.8f, {.tooltip = "Smallest scale of a copy."}),
    number("scale_max", "Largest", 0.001f, 1000, 1.2f, {.tooltip = "Largest scale of a copy."}),
    number("rotation", "Rotation", 0, 180, 180,
           {.tooltip = "Largest rotation of a copy about its upright axis, in either direction.", .unit = "deg"}),
    number("tilt", "Tilt", 0, 90, 0, {.tooltip = "Largest tilt of a copy, in any direction.", .unit = "deg"}),
    choice("align", "Stand", "normal|up", 0, {.tooltip = "Aligned with the surface normal, or upright."}),
    number("slope", "Steepest", 0, 180, 180,
           {.tooltip = "No copies where the surface is steeper than this.", .unit = "deg"}),
    number("offset", "Offset", -1e6f, 1e6f, 0,
           {.tooltip = "Offset of copies above (or below) the surface, in scene units."}),
    choice("up", "Up", "auto|x|y|z", 0, {.tooltip = "The scene's up axis; auto: the camera's.", .advanced = true}),
    choice(
        "side", "Side", "front|back", 0,
        {.tooltip = "The side of the surface: the one its normals point to, or the opposite one.", .advanced = true}),
    toggle("group", "In a group", true, {.tooltip = "Puts all copies into a new group.", .advanced = true}),
};

// The parameters by id; the host passes all of them.
class Options {
  public:
    Options(const RestageValue* values, std::uint32_t count) : values_(values), count_(count) {}
    double number(const char* id) const { return find(id).v[0]; }
    int integer(const char* id) const { return find(id).i; }
    bool is(const char* id, const char* choice) const {
        const RestageValue& v = find(id);
        return v.text && std::strcmp(v.text, choice) == 0;
    }

  private:
    const RestageValue& find(const char* id) const {
        static constexpr RestageValue nothing{};
        for (std::uint32_t i = 0; i < count_; ++i) {
            const RestageValue& v = RESTAGE_AT(RestageValue, values_, i);
            if (std::strcmp(v.id, id) == 0) return v;
        }
        return nothing;
    }
    const RestageValue* values_;
    std::uint32_t count_;
};

constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180); }

Vec up_of(const RestageSceneReader1& scene, const Options& o) {
    if (o.is("up", "x")) return {1, 0, 0};
    if (o.is("up", "y")) return {0, 1, 0};
    if (o.is("up", "z")) return {0, 0, 1};
    RestageCamera camera{};
    if (!scene.camera(scene.ctx, scene.active_camera(scene.ctx), &camera)) return {0, 0, 1};
    const Vec y = Affine::from(camera.camera_to_world).y;
    const double x_size = std::abs(y.x), y_size = std::abs(y.y), z_size = std::abs(y.z);
    if (z_size >= x_size && z_size >= y_size) return {0, 0, y.z < 0 ? -1.0 : 1.0};
    return y_size >= x_size ? Vec{0, y.y < 0 ? -1.0 : 1.0, 0} : Vec{y.x < 0 ? -1.0 : 1.0, 0, 0};
}

// From the source to the place of a copy.
Affine placement(const Source& source, const Spot& spot, Vec up, const Options& o, Random& random) {
    // Drawn in a fixed order, independent of the parameters.
    const double scale_at = random.uniform(), spin_at = random.uniform(), lean_at = random.uniform(),
                 lean_to = random.uniform();
    const double low = o.number("scale_min"), high = std::max(low, o.number("scale_max"));
    const double scale = low + (high - low) * scale_at;
    const Vec stand = o.is("align", "up") ? up : spot.normal;
    const auto [spin_sin, spin_cos] = sin_cos(radians(o.number("rotation")) * (2 * spin_at - 1));
    const auto [lean_sin, lean_cos] = sin_cos(radians(o.number("tilt")) * lean_at);
    const auto [to_sin, to_cos] = sin_cos(2 * std::numbers::pi * lean_to);
    const Vec across = perpendicular(up);
    const Vec axis = across * to_cos + cross(up, across) * to_sin;
    const Affine turned = rotation(up, stand) * rotation(axis, lean_sin, lean_cos) * rotation(up, spin_sin, spin_cos);
    Affine move = turned;
    move.x = move.x * scale, move.y = move.y * scale, move.z = move.z * scale;
    move.origin = spot.at + stand * o.number("offset") - move.direction(source.foot);
    return move;
}

bool add_copy(const RestageEditWriter1& edits, const Source& source, const Affine& move, RestageHandle group) {
    if (source.group) {
        RestageGroup own{};
        own.name = source.name.c_str();
        own.parent = group;
        group = edits.add_group(edits.ctx, &own);
    }
    for (RestageInstance object : source.objects) {
        (move * Affine::from(object.object_to_world)).to(object.object_to_world);
        if (source.group || group) object.group = group; // else it is in the group of its original
        if (!edits.add_instance(edits.ctx, &object)) return false;
    }
    return true;
}

// What is rendered instead of the triangles; "" = the triangles are rendered.
std::string stand_in(const RestageMesh& mesh) {
    const std::string shape(mesh.primitive, std::strcspn(mesh.primitive, " "));
    for (const char* other : {"sphere", "disk", "cylinder", "curve", "missing"})
        if (shape == other) return shape == "missing" ? "missing shape" : shape;
    return "";
}

int refuse(const RestageEditWriter1& edits, const std::string& why) {
    edits.error(edits.ctx, why.c_str());
    return 0;
}

int run_unguarded(const RestageSceneReader1& scene, const RestageSelection1& selection, const Options& o,
                  const RestageEditWriter1& edits) {
    if (selection.instance_count < 2)
        return refuse(edits, "select at least two objects: what to scatter first, and the surface last");
    std::vector<RestageHandle> selected(selection.instances, selection.instances + selection.instance_count);
    RestageInstance ground{};
    RestageMesh mesh{};
    const bool there = scene.instance(scene.ctx, selected.back(), &ground) != 0;
    selected.pop_back();
    const std::string who = "the surface \"" + std::string(there ? ground.name : "") + "\" ";
    if (!there || !scene.mesh(scene.ctx, ground.mesh, &mesh) || mesh.triangle_count == 0)
        return refuse(edits, who + "has no triangles: select another object last");
    if (const std::string shape = stand_in(mesh); !shape.empty())
        return refuse(edits, who + "is a " + shape + ", which is not rendered from its triangles: select a mesh last");
    const Vec up = up_of(scene, o);
    const Surface surface(mesh, ground,
                          {.back = o.is("side", "back"),
                           .up = up,
                           .least_cos = o.number("slope") >= 180 ? -2 : sin_cos(radians(o.number("slope"))).second});
    if (!(surface.whole_area() > 0)) return refuse(edits, who + "has no area: select another object last");
    if (!(surface.area() > 0))
        return refuse(edits,
                      who +
                          "is steeper everywhere than \"Steepest\" allows, or faces the other way: increase it, or "
                          "change \"Side\"");
    const std::vector<Source> sources = sources_of(scene, selected, up);
    if (sources.empty()) return refuse(edits, "none of the objects to scatter has geometry: select other objects");

    const double wanted =
        o.is("amount", "density") ? std::floor(o.number("density") * surface.area() + 0.5) : double(o.integer("count"));
    if (wanted > double(most_copies))
        return refuse(edits, "these would be more than " + std::to_string(most_copies) + " copies: lower the density");
    const auto count = static_cast<std::size_t>(wanted);
    const auto seed = static_cast<std::uint64_t>(o.integer("seed"));
    RestageHandle group = 0;
    if (o.integer("group") && count > 0) {
        const std::string name = "scattered " + sources[0].name;
        RestageGroup made{};
        made.name = name.c_str();
        group = edits.add_group(edits.ctx, &made);
        if (!group) return refuse(edits, "the group for the copies could not be created");
    }
    const double distance = o.number("distance");
    Disks disks(distance);
    std::size_t copies = 0;
    for (std::size_t dart = 0; copies < count && dart < darts_a_copy * count; ++dart) {
        if (dart % 512 == 0 &&
            !edits.progress(edits.ctx,
                            std::max(float(copies) / float(count), float(dart) / float(darts_a_copy * count)),
                            "scattering"))
            return 0;
        Random random(seed, dart);
        const double u = random.uniform(), v = random.uniform(), w = random.uniform();
        const Spot spot = surface.sample(u, v, w);
        if (distance > 0 && !disks.add(spot.at)) continue;
        const std::size_t which = std::min(std::size_t(random.uniform() * double(sources.size())), sources.size() - 1);
        if (!add_copy(edits, sources[which], placement(sources[which], spot, up, o, random), group))
            return refuse(edits, "a copy of \"" + sources[which].name + "\" was refused");
        ++copies;
    }
    const std::string what = std::to_string(copies) + " copies on \"" + ground.name + "\"";
    const bool full = copies < count;
    const std::string note = full ? "of " + std::to_string(count) + ": no more fit at the minimum distance" : "";
    edits.report(edits.ctx, full ? RESTAGE_APPROXIMATED : RESTAGE_KEPT, what.c_str(), note.c_str());
    return 1;
}

int run(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* values,
        std::uint32_t count, RestageEditWriter1* edits) {
    try {
        return run_unguarded(*scene, *selection, Options(values, count), *edits);
    } catch (const std::exception& e) {
        edits->error(edits->ctx, e.what());
        return 0;
    }
}

constexpr RestageAction1 action{
    .size = sizeof(RestageAction1),
    .id = "scatter",
    .label = "Scatter",
    .tooltip = "Copies the selected objects over the surface that was selected last.",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .flags = RESTAGE_ACTION_NEEDS_SELECTION,
    .run = run,
};

void draw(const RestageUi1* ui, void* ctx) {
    RestageValue amount{};
    const bool density = ui->get(ctx, "amount", &amount) && amount.text && std::strcmp(amount.text, "density") == 0;
    for (const RestageParam& line : params) {
        if (line.flags & RESTAGE_PARAM_ADVANCED) continue;
        if (std::strcmp(line.id, density ? "count" : "density") == 0)
            ui->hide(ctx, line.id);
        else
            ui->param(ctx, line.id);
    }
    if (ui->begin_group(ctx, "Advanced")) {
        for (const RestageParam& line : params)
            if (line.flags & RESTAGE_PARAM_ADVANCED) ui->param(ctx, line.id);
        ui->end_group(ctx);
    }
    const std::uint32_t selected = ui->selected(ctx);
    if (selected < 2)
        ui->text(ctx, "Select what to scatter first, and then the surface.");
    else if (ui->button(ctx, "Scatter", "The object that was selected last is the surface."))
        ui->run(ctx, "scatter");
}

constexpr RestagePanel1 panel{
    .size = sizeof(RestagePanel1),
    .id = "scatter",
    .label = "Scatter",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .draw = draw,
};

} // namespace

RESTAGE_PLUGIN("org.restage.action.scatter", "0.1.0", {RESTAGE_ACTION1, &action}, {RESTAGE_PANEL1, &panel})
