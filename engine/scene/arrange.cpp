// SPDX-License-Identifier: Apache-2.0
#include "scene/arrange.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <numeric>
#include <unordered_set>

namespace restage::scene {

namespace {

void append(Edit& edit, Edit&& more) {
    edit.changes.insert(edit.changes.end(), std::make_move_iterator(more.changes.begin()),
                        std::make_move_iterator(more.changes.end()));
}

double coordinate(const Bounds& box, int axis, Side side) {
    return side == Side::lower ? box.lower[axis] : side == Side::upper ? box.upper[axis] : box.center()[axis];
}

std::string counted(Things things) { return std::to_string(things.size()) + " things"; }

// Things with their boxes; those without geometry are left out.
struct Boxed {
    std::span<const Id<Instance>> ids;
    Bounds box;
};
Result<std::vector<Boxed>> boxes_of(const Scene& scene, Things things) {
    std::vector<Boxed> found;
    for (const Thing& thing : things) {
        for (const Id<Instance> id : thing)
            if (!scene.instances.find(id)) return fail("there is no object with id " + std::to_string(id.value));
        if (const Bounds box = world_bounds(scene, thing); !box.empty()) found.push_back({thing, box});
    }
    return found;
}

// Each moved along the axis.
Result<Edit> shift(const Scene& scene, std::span<const Boxed> things, int axis, std::span<const double> by,
                   std::string label) {
    Edit edit{std::move(label), {}};
    for (std::size_t i = 0; i < things.size(); ++i) {
        glm::dvec3 move(0);
        move[axis] = by[i];
        RESTAGE_TRY(Edit one, move_instances(scene, things[i].ids, glm::translate(glm::dmat4(1), move)));
        append(edit, std::move(one));
    }
    return edit;
}

// The rotation about `up` nearest to the rotation from one object space to another (a swing and a twist). Scale, shear
// and mirroring are left out.
glm::dmat3 turn_between(const glm::dmat4& from, const glm::dmat4& to, const glm::dvec3& up) {
    const auto rotation = [](const glm::dmat4& m) {
        glm::dmat3 r(m);
        r[0] = glm::normalize(r[0]);
        r[1] = glm::normalize(r[1] - r[0] * glm::dot(r[0], r[1]));
        r[2] = glm::cross(r[0], r[1]);
        return r;
    };
    // Of the quaternion of a rotation the twist about `up` is the real part and the part along `up`; these are, up to
    // one factor, the trace + 1 and the antisymmetric part of its matrix.
    const glm::dmat3 r = rotation(to) * glm::transpose(rotation(from));
    const glm::dvec3 antisymmetric(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
    const double real = 1 + r[0][0] + r[1][1] + r[2][2], along = glm::dot(antisymmetric, up);
    if (std::hypot(real, along) < 1e-9) // half a turn, about `up` or across it
        return glm::dmat3(glm::rotate(glm::dmat4(1), glm::dot(r * up, up) > 0 ? glm::radians(180.0) : 0.0, up));
    return glm::dmat3(glm::rotate(glm::dmat4(1), 2 * std::atan2(along, real), up));
}

// The largest factor with which a box of this size fits into the other. Flat sides do not count.
double fitting(const glm::dvec3& size, const glm::dvec3& into) {
    const double least = 1e-6 * glm::length(size), least_into = 1e-6 * glm::length(into);
    double factor = 0;
    for (int i = 0; i < 3; ++i)
        if (size[i] > least && into[i] > least_into && (factor == 0 || into[i] / size[i] < factor))
            factor = into[i] / size[i];
    return factor > 0 ? factor : 1;
}

glm::dvec3 underside(const Bounds& box, const glm::dvec3& up) {
    return box.center() - up * (0.5 * std::abs(glm::dot(box.size(), up)));
}

} // namespace

Bounds world_bounds(const Scene& scene, std::span<const Id<Instance>> ids) {
    Bounds box;
    for (const Id<Instance> id : ids)
        box.add(world_bounds(scene, id));
    return box;
}

Result<Edit> align(const Scene& scene, Things things, int axis, Side side, const Bounds& target) {
    if (target.empty()) return fail("there is no geometry to align to");
    RESTAGE_TRY(const std::vector<Boxed> boxed, boxes_of(scene, things));
    std::vector<double> by;
    for (const Boxed& thing : boxed)
        by.push_back(coordinate(target, axis, side) - coordinate(thing.box, axis, side));
    return shift(scene, boxed, axis, by, "Align " + counted(things));
}

Result<Edit> distribute(const Scene& scene, Things things, int axis, Spacing spacing) {
    RESTAGE_TRY(std::vector<Boxed> boxed, boxes_of(scene, things));
    if (boxed.size() < 3) return fail("select at least three things to distribute them");
    std::ranges::stable_sort(boxed, {}, [&](const Boxed& thing) { return thing.box.center()[axis]; });
    const Bounds &first = boxed.front().box, &last = boxed.back().box;
    const double steps = double(boxed.size() - 1);
    std::vector<double> by;
    if (spacing == Spacing::centers) {
        const double from = first.center()[axis], to = last.center()[axis];
        for (std::size_t i = 0; i < boxed.size(); ++i)
            by.push_back(glm::mix(from, to, double(i) / steps) - boxed[i].box.center()[axis]);
    } else {
        double free = last.upper[axis] - first.lower[axis]; // negative if they overlap: then all do alike
        for (const Boxed& thing : boxed)
            free -= thing.box.size()[axis];
        double at = first.lower[axis];
        for (const Boxed& thing : boxed) {
            by.push_back(at - thing.box.lower[axis]);
            at += thing.box.size()[axis] + free / steps;
        }
    }
    by.front() = by.back() = 0; // not even by a rounding error
    return shift(scene, boxed, axis, by, "Distribute " + counted(things));
}

glm::dmat4 reflection(int axis, double at) {
    glm::dmat4 m(1);
    m[axis][axis] = -1;
    m[3][axis] = 2 * at;
    return m;
}

Result<Edit> mirror(const Scene& scene, std::span<const Id<Instance>> ids, int axis, double at) {
    RESTAGE_TRY(Edit edit, move_instances(scene, ids, reflection(axis, at)));
    edit.label.replace(0, std::string_view("Move").size(), "Mirror");
    return edit;
}

Result<Edit> mirror(const Scene& scene, Id<Light> id, int axis, double at) {
    const Light* light = scene.lights.find(id);
    return modify(scene, id, "Mirror " + (light ? light->name : "light"),
                  [&](Light& l) { l.light_to_world = reflection(axis, at) * l.light_to_world; });
}

std::vector<glm::dmat4> line_array(int count, const glm::dvec3& step) {
    std::vector<glm::dmat4> moves;
    for (int i = 1; i < count; ++i)
        moves.push_back(glm::translate(glm::dmat4(1), double(i) * step));
    return moves;
}

std::vector<glm::dmat4> grid_array(const glm::ivec3& count, const glm::dvec3& spacing) {
    std::vector<glm::dmat4> moves;
    for (int z = 0; z < count.z; ++z)
        for (int y = 0; y < count.y; ++y)
            for (int x = 0; x < count.x; ++x)
                if (x || y || z) moves.push_back(glm::translate(glm::dmat4(1), spacing * glm::dvec3(x, y, z)));
    return moves;
}

std::vector<glm::dmat4> circle_array(const Circle& circle, const glm::dvec3& middle) {
    const bool whole = std::abs(std::fmod(circle.angle, 360)) < 1e-9;
    const double step = circle.angle / std::max(whole ? circle.count : circle.count - 1, 1);
    const glm::dvec3 arm = middle - circle.center;
    std::vector<glm::dmat4> moves;
    for (int i = 1; i < circle.count; ++i) {
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), glm::radians(step * i), glm::normalize(circle.axis));
        const glm::dmat4 there = glm::translate(glm::dmat4(1), circle.center + glm::dmat3(turn) * arm);
        moves.push_back(there * (circle.turn ? turn : glm::dmat4(1)) * glm::translate(glm::dmat4(1), -middle));
    }
    return moves;
}

Result<Duplicate> replace(const Scene& scene, Things things, std::span<const Id<Instance>> by,
                          const ReplaceOptions& options) {
    RESTAGE_TRY(const std::vector<Boxed> boxed, boxes_of(scene, things));
    const Bounds own = world_bounds(scene, by);
    if (own.empty()) return fail("the replacement has no geometry");
    if (boxed.empty()) return fail("there is nothing with geometry to replace");
    std::unordered_set<Id<Instance>> replacement(by.begin(), by.end());
    std::vector<glm::dmat4> moves;
    std::vector<Id<Instance>> gone;
    for (const Boxed& thing : boxed) {
        for (const Id<Instance> id : thing.ids) {
            if (replacement.contains(id)) return fail("a thing cannot replace itself");
            gone.push_back(id);
        }
        glm::dmat4 turn(1);
        if (options.turn)
            turn = glm::dmat4(turn_between(scene.instances[by.back()].object_to_world,
                                           scene.instances[thing.ids.back()].object_to_world, options.up));
        Bounds turned;
        for (const Id<Instance> id : by)
            if (const Mesh* mesh = scene.meshes.find(scene.instances[id].mesh); mesh && mesh->data)
                turned.add(world_bounds(*mesh->data, turn * scene.instances[id].object_to_world));
        const double size = options.keep_size ? 1 : fitting(turned.size(), thing.box.size());
        const glm::dvec3 from = underside(turned, options.up), to = underside(thing.box, options.up);
        moves.push_back(glm::translate(glm::dmat4(1), to) * glm::scale(glm::dmat4(1), glm::dvec3(size)) *
                        glm::translate(glm::dmat4(1), -from) * turn);
    }
    RESTAGE_TRY(Duplicate made, duplicate_each(scene, by, moves));
    RESTAGE_TRY(Edit removal, remove_instances(scene, gone));
    append(made.edit, std::move(removal));
    const std::string& name = scene.instances[by.back()].name;
    made.edit.label =
        "Replace " + (boxed.size() == 1 ? scene.instances[boxed[0].ids.back()].name : counted(things)) + " by " + name;
    return made;
}

} // namespace restage::scene
