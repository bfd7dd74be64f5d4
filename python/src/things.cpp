// SPDX-License-Identifier: Apache-2.0
// Objects, groups and selections: the things placed in a scene, and their common operations.
#include "workspace.hpp"

#include "document/projected.hpp"
#include "query/collision.hpp"
#include "query/support.hpp"
#include "scene/arrange.hpp"
#include "scene/box_projection.hpp"
#include "scene/links.hpp"
#include "scene/path_array.hpp"

#include <cmath>
#include <filesystem>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace restage::python {

using namespace scene;

namespace {

using ObjectHandle = Handle<Instance>;
using GroupHandle = Handle<Group>;

std::vector<ObjectHandle> handles(const std::shared_ptr<Workspace>& in, const Objects& ids) {
    std::vector<ObjectHandle> out;
    out.reserve(ids.size());
    for (const auto id : ids)
        out.push_back({in, id});
    return out;
}

Bounds bounds_of(Workspace& workspace, const Objects& ids) {
    Bounds bounds;
    for (const auto id : ids)
        bounds.add(world_bounds(workspace.scene(), id));
    if (bounds.empty()) throw Failure("there is no geometry, so there are no bounds");
    return bounds;
}

// And texture coordinates to those that need some and have none.
void give_material(Workspace& workspace, const Objects& ids, Id<Material> material) {
    Edit given = take(set_material(workspace.scene(), ids, material));
    workspace.edit(document::project_where_needed(workspace.scene(), std::move(given), ids, workspace.host().registry(),
                                                  workspace.up())
                       .edit);
}

// A matrix about a point, in world space.
template <class C>
void transform_about(const C& c, const glm::dmat4& by, const std::optional<Three>& center) {
    const Objects ids = objects_of(c);
    const glm::dvec3 middle = center ? vec(*center) : bounds_of(*c.in, ids).center();
    c.in->edit(move_instances(c.in->scene(), ids,
                              glm::translate(glm::dmat4(1), middle) * by * glm::translate(glm::dmat4(1), -middle)));
}

ObjectHandle copy_as(const ObjectHandle& original, const Objects& copies, Id<Group>) {
    return {original.in, copies.at(0)};
}
Selection copy_as(const Selection& original, const Objects& copies, Id<Group>) { return {original.in, copies}; }
// The outermost new group.
GroupHandle copy_as(const GroupHandle& original, const Objects& copies, Id<Group> first_new) {
    const Scene& s = original.in->scene();
    Id<Group> group = s.instances[copies.at(0)].group;
    while (s.groups[group].parent.value >= first_new.value)
        group = s.groups[group].parent;
    return {original.in, group};
}

Selection copies_at(const std::shared_ptr<Workspace>& in, const Objects& ids, const std::vector<glm::dmat4>& moves) {
    auto made = take(duplicate_each(in->scene(), ids, moves));
    made.edit.label.replace(0, std::string_view("Duplicate").size(), "Array of");
    in->edit(std::move(made.edit));
    return {in, made.copies};
}

int at_least_one(int count) {
    if (count < 1) throw Failure("array: count is " + std::to_string(count) + "; it includes the original");
    return count;
}

// The operations of everything that represents objects.
template <class C>
void bind_verbs(nb::class_<C>& c) {
    c.def_prop_ro(
         "objects", [](const C& self) { return handles(self.in, objects_of(self)); },
         "The objects it comprises: a list of Object.")
        .def_prop_ro(
            "bounds",
            [](const C& self) {
                const Bounds b = bounds_of(*self.in, objects_of(self));
                return to_numpy(b.lower, b.upper);
            },
            nb::rv_policy::automatic,
            "Axis-aligned box in world space: array (2, 3), lower and upper corner [scene units].")
        .def_prop_ro(
            "center", [](const C& self) { return triple(bounds_of(*self.in, objects_of(self)).center()); },
            "Centre of the bounds, world space [scene units].")
        .def_prop_ro(
            "extent", [](const C& self) { return triple(bounds_of(*self.in, objects_of(self)).size()); },
            "Size of the bounds along the world's axes [scene units].")
        .def(
            "move",
            [](const C& self, const Three& by, bool collide) {
                const Objects ids = objects_of(self);
                glm::dvec3 way = vec(by);
                if (collide) {
                    const Scene& scene = self.in->scene();
                    query::Collision thing(scene, query::Collision::thing_of(scene, ids), {ids.begin(), ids.end()},
                                           self.in->up());
                    thing.slide(way);
                    way = thing.at();
                }
                self.in->edit(move_instances(self.in->scene(), ids, glm::translate(glm::dmat4(1), way)));
            },
            "by"_a, nb::kw_only(), "collide"_a = false,
            "Moves by this vector, world space [scene units]. collide=True: only until it touches another visible "
            "object, and on along that; contact before the move does not hold it.")
        .def(
            "move_to",
            [](const C& self, const Three& place) {
                const Objects ids = objects_of(self);
                const glm::dvec3 by = vec(place) - bounds_of(*self.in, ids).center();
                self.in->edit(move_instances(self.in->scene(), ids, glm::translate(glm::dmat4(1), by)));
            },
            "center"_a, "Moves so that the centre of the bounds is at this point, world space [scene units].")
        .def(
            "rotate",
            [](const C& self, double degrees, const std::optional<Three>& axis, const std::optional<Three>& center) {
                const glm::dvec3 about = axis ? vec(*axis) : self.in->up();
                if (!(glm::length(about) > 0)) throw Failure("rotate: the axis has no length");
                transform_about(self, glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(about)), center);
            },
            "degrees"_a, "axis"_a = nb::none(), "center"_a = nb::none(),
            "Rotates about an axis (default: the scene's up) through a point (default: the centre of the bounds).")
        .def(
            "scale",
            [](const C& self, const std::variant<double, Three>& factor, const std::optional<Three>& center) {
                const glm::dvec3 f = std::holds_alternative<double>(factor) ? glm::dvec3(std::get<double>(factor))
                                                                            : vec(std::get<Three>(factor));
                transform_about(self, glm::scale(glm::dmat4(1), f), center);
            },
            "factor"_a, "center"_a = nb::none(),
            "Scales by one number, or by three along the world's axes, about a point (default: the centre of the "
            "bounds).")
        .def(
            "transform_by",
            [](const C& self, nb::handle matrix) {
                self.in->edit(move_instances(self.in->scene(), objects_of(self), to_matrix(matrix)));
            },
            "matrix"_a, "Applies a 4x4 matrix in world space, after the current transform.",
            nb::sig("def transform_by(self, matrix: numpy.typing.ArrayLike) -> None"))
        .def(
            "drop",
            [](const C& self) -> std::optional<double> {
                const Objects ids = objects_of(self);
                const glm::dvec3 up = self.in->up();
                const auto fall = query::fall_distance(self.in->scene(), ids, up);
                if (fall)
                    self.in->edit(move_instances(self.in->scene(), ids, glm::translate(glm::dmat4(1), -*fall * up)));
                return fall;
            },
            "Lowers it onto the visible surface below. Returns the distance [scene units] (negative: it "
            "was lifted out of something), or None if there is no surface below.")
        .def(
            "duplicate",
            [](const C& self, const Three& by) {
                const Objects ids = objects_of(self);
                if (ids.empty()) throw Failure("duplicate: it contains no objects");
                const auto first_new = self.in->scene().groups.next();
                auto made = take(duplicate_instances(self.in->scene(), ids, glm::translate(glm::dmat4(1), vec(by))));
                self.in->edit(std::move(made.edit));
                return copy_as(self, made.copies, first_new);
            },
            "by"_a = Three{0, 0, 0}, "A copy, moved by this vector; it shares meshes and materials. Returns the copy.")
        .def(
            "mirror",
            [](const C& self, const std::string& axis, std::optional<double> at) {
                const std::size_t i = std::string_view("xyz").find(axis);
                if (axis.size() != 1 || i > 2) throw Failure("mirror: axis is \"" + axis + "\"; it must be x, y or z");
                const Objects ids = objects_of(self);
                const double place = at ? *at : bounds_of(*self.in, ids).center()[int(i)];
                self.in->edit(mirror(self.in->scene(), ids, int(i), place));
            },
            "axis"_a, "at"_a = nb::none(),
            "Mirrors it along the world's axis \"x\", \"y\" or \"z\", at this coordinate (default: the centre of the "
            "bounds).")
        .def(
            "array",
            [](const C& self, int count, const Three& by) {
                return copies_at(self.in, objects_of(self), line_array(at_least_one(count), vec(by)));
            },
            "count"_a, "by"_a,
            "A row of `count` things with the original, each displaced by this vector from the one before [scene "
            "units]. "
            "Copies share meshes and materials. Returns the copies, one step of undo.")
        .def(
            "array_around",
            [](const C& self, int count, const Three& center, const std::optional<Three>& axis, double degrees,
               bool turn) {
                const Objects ids = objects_of(self);
                const glm::dvec3 about = axis ? vec(*axis) : self.in->up();
                if (!(glm::length(about) > 0)) throw Failure("array_around: the axis has no length");
                return copies_at(self.in, ids,
                                 circle_array({at_least_one(count), vec(center), about, degrees, turn},
                                              bounds_of(*self.in, ids).center()));
            },
            "count"_a, "center"_a, "axis"_a = nb::none(), "degrees"_a = 360.0, "turn"_a = true,
            "A circle of `count` things with the original around a point, about an axis (default: the scene's up); "
            "less "
            "than 360 degrees: an arc from the first to the last. turn=False: all keep their direction. Returns the "
            "copies, one step of undo.")
        .def(
            "array_along",
            [](const C& self, const std::vector<Three>& points, std::optional<int> count, std::optional<double> spacing,
               bool smooth, bool turn) {
                if (count.has_value() == spacing.has_value())
                    throw Failure("array_along: give either count or spacing");
                if (spacing && !(*spacing > 0)) throw Failure("array_along: spacing is not above 0");
                const Objects ids = objects_of(self);
                const glm::dvec3 up = self.in->up();
                const Bounds box = bounds_of(*self.in, ids);
                std::vector<glm::dvec3> path{box.center() - up * (0.5 * std::abs(glm::dot(box.size(), up)))};
                for (const Three& p : points) {
                    path.push_back(vec(p));
                    if (!std::isfinite(p[0] + p[1] + p[2])) throw Failure("array_along: a point is not finite");
                }
                return copies_at(self.in, ids,
                                 path_array(path_through(path, smooth), {.count = at_least_one(count.value_or(1)),
                                                                         .spacing = spacing.value_or(0),
                                                                         .up = up,
                                                                         .turn = turn}));
            },
            "points"_a, "count"_a = nb::none(), "spacing"_a = nb::none(), "smooth"_a = true, "turn"_a = true,
            "Copies along a path, from the middle of its underside through these points: array (n, 3). Either `count`, "
            "with "
            "the original, to the last point, or `spacing` along the path [scene units]. smooth: a curve, else "
            "straight "
            "pieces; turn: copies turn with the path about the scene's up. Returns the copies, one step of undo.")
        .def(
            "remove", [](const C& self) { self.in->edit(remove_instances(self.in->scene(), objects_of(self))); },
            "Removes it from the scene. Its meshes and materials stay: see Session.remove_unused.")
        .def(
            "set_material",
            [](const C& self, const Handle<Material>& material) {
                if (material.in != self.in) throw Failure("this material belongs to another session");
                give_material(*self.in, objects_of(self), material.id);
            },
            "material"_a,
            "Gives all its objects this material. Those whose mesh has no texture coordinates get some by box "
            "projection, "
            "if its textures need them: see project_texture.")
        .def(
            "project_texture",
            [](const C& self, double size, const std::string& axes) {
                if (axes != "object" && axes != "world")
                    throw Failure("project_texture: axes is \"" + axes + "\"; it must be object or world");
                self.in->edit(take(project_box(self.in->scene(), objects_of(self),
                                               {.size = size, .world_axes = axes == "world", .up = self.in->up()})));
            },
            "size"_a = 1.0, "axes"_a = "object",
            "Texture coordinates by box projection: each triangle is seen along the axis its normal is nearest to. "
            "size: of one repetition of a texture [scene units]; axes: \"object\" or \"world\". Other objects keep "
            "the mesh as it was.")
        .def(
            "make_unique",
            [](const C& self, const Handle<Material>& material) {
                auto made = take(make_unique(self.in->scene(), objects_of(self), material.id));
                self.in->edit(std::move(made.edit));
                return Handle<Material>{self.in, made.material};
            },
            "material"_a, "Gives these objects their own copy of the material; other objects keep theirs.")
        .def_prop_ro(
            "materials",
            [](const C& self) {
                std::vector<Handle<Material>> found;
                for (const auto id : objects_of(self)) {
                    const Handle<Material> one{self.in, self.in->scene().instances[id].material};
                    if (one.id && std::find(found.begin(), found.end(), one) == found.end()) found.push_back(one);
                }
                return found;
            },
            "The materials of its objects, each once.")
        .def_prop_rw(
            "hidden",
            [](const C& self) {
                const Objects ids = objects_of(self);
                return !ids.empty() && std::all_of(ids.begin(), ids.end(), [&](Id<Instance> id) {
                    return self.in->scene().instances[id].hidden;
                });
            },
            [](const C& self, bool hidden) { self.in->edit(set_hidden(self.in->scene(), objects_of(self), hidden)); },
            "True: it is in the scene, but rays do not hit it.")
        .def_prop_rw(
            "shadow_catcher",
            [](const C& self) {
                const Objects ids = objects_of(self);
                return !ids.empty() && std::all_of(ids.begin(), ids.end(), [&](Id<Instance> id) {
                    return self.in->scene().instances[id].catcher;
                });
            },
            [](const C& self, bool on) { self.in->edit(set_catcher(self.in->scene(), objects_of(self), on)); },
            "True: not seen itself, but it takes the shadows of other objects over the sky, or with alpha over a "
            "transparent backdrop.");
}

} // namespace

nb::class_<ObjectHandle> bind_things(nb::module_& m) {
    nb::class_<ObjectHandle> object(m, "Object",
                                    "One object: a mesh with a material at a place. Changing a property is "
                                    "an edit, which Session.undo reverts.");
    bind_handle(object, "Object");
    bind_verbs(object);
    object
        .def_prop_rw(
            "transform", [](const ObjectHandle& h) { return to_numpy(h.get().object_to_world); },
            [](const ObjectHandle& h, nb::handle matrix) {
                h.in->edit(set_transform(h.in->scene(), h.id, to_matrix(matrix)));
            },
            "Object to world: array (4, 4) float64, for column vectors.", nb::for_getter(nb::rv_policy::automatic),
            nb::for_getter(nb::sig("def transform(self) -> numpy.typing.NDArray[numpy.float64]")),
            nb::for_setter(nb::sig("def transform(self, matrix: numpy.typing.ArrayLike, /) -> None")))
        .def_prop_rw(
            "material",
            [](const ObjectHandle& h) -> std::optional<Handle<Material>> {
                if (!h.get().material) return std::nullopt;
                return Handle<Material>{h.in, h.get().material};
            },
            [](const ObjectHandle& h, const Handle<Material>& material) {
                if (material.in != h.in) throw Failure("this material belongs to another session");
                give_material(*h.in, {h.id}, material.id);
            },
            "Its material. Given one with textures that need coordinates, an object whose mesh has none gets some by "
            "box "
            "projection: see project_texture.")
        .def_prop_ro(
            "group",
            [](const ObjectHandle& h) -> std::optional<GroupHandle> {
                if (!h.get().group) return std::nullopt;
                return GroupHandle{h.in, h.get().group};
            },
            "The group it is in, or None.")
        .def_prop_rw(
            "emission",
            [](const ObjectHandle& h) -> std::optional<Triple> {
                const auto& emission = h.get().emission;
                return emission ? std::optional(triple(emission->radiance)) : std::nullopt;
            },
            [](const ObjectHandle& h, const std::optional<Three>& radiance) {
                std::optional<Emission> emission;
                if (radiance)
                    emission = Emission{.radiance = glm::vec3(vec(*radiance)),
                                        .two_sided = h.get().emission && h.get().emission->two_sided};
                h.in->edit(set_emission(h.in->scene(), h.id, emission));
            },
            "Radiance it emits, linear sRGB [W/(m^2 sr)], or None.", nb::for_setter(nb::arg("radiance").none()))
        .def_prop_ro(
            "triangle_count",
            [](const ObjectHandle& h) -> std::size_t {
                const Mesh* mesh = h.in->scene().meshes.find(h.get().mesh);
                return mesh && mesh->data ? mesh->data->triangles.size() : 0;
            },
            "Triangles of its mesh.");

    nb::class_<GroupHandle> group(
        m, "Group", "Objects that belong together, such as the parts of a chair; one click in the editor selects all.");
    bind_handle(group, "Group");
    bind_verbs(group);
    group.def_prop_ro(
        "parent",
        [](const GroupHandle& h) -> std::optional<GroupHandle> {
            if (!h.get().parent) return std::nullopt;
            return GroupHandle{h.in, h.get().parent};
        },
        "The group it is in, or None.");
    group.def_prop_ro(
        "linked_file",
        [](const GroupHandle& h) -> std::optional<std::filesystem::path> {
            const auto source = link_source(h.get());
            return source ? std::optional<std::filesystem::path>(source->file) : std::nullopt;
        },
        "The file whose objects it shows, or None; see Session.insert.");
    group.def(
        "make_editable", [](const GroupHandle& h) { h.in->edit(scene::make_editable(h.in->scene(), h.id)); },
        "A link becomes an ordinary group of this document.");

    nb::class_<Selection> selection(m, "Selection", "Some objects, handled as one; see Session.select.");
    bind_verbs(selection);
    selection.def("__len__", [](const Selection& s) { return objects_of(s).size(); })
        .def("__repr__", [](const Selection& s) {
            return "<restage.Selection of " + std::to_string(s.in->closed() ? 0 : objects_of(s).size()) + " objects>";
        });
    return object;
}

} // namespace restage::python
