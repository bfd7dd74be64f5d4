// SPDX-License-Identifier: Apache-2.0
// Geometry as arrays, and new things: meshes, cameras, groups.
#include "values.hpp"

#include "scene/bounds.hpp"

#include <map>

namespace restage::python {

using namespace scene;
using Shared = std::shared_ptr<Workspace>;

namespace {

template <class T>
using Rows = nb::ndarray<const T, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

// Anything numpy can convert to an array (n, columns).
template <class Row, class T>
std::vector<Row> rows(nb::handle h, const char* type, const char* what) {
    constexpr std::size_t columns = sizeof(Row) / sizeof(T);
    const nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(h, "dtype"_a = type);
    Rows<T> view;
    if (!nb::try_cast(array, view) || view.shape(1) != columns)
        throw Failure(std::string("add_mesh: ") + what + " are an array (n, " + std::to_string(columns) + ")");
    std::vector<Row> out(view.shape(0));
    for (std::size_t i = 0; i < out.size(); ++i)
        for (std::size_t k = 0; k < columns; ++k)
            out[i][static_cast<glm::length_t>(k)] = view(i, k);
    return out;
}

// Indices below 0 or beyond 32 bits must not wrap into range.
std::vector<glm::uvec3> triangles_of(nb::handle h) {
    std::vector<glm::uvec3> out;
    for (const glm::i64vec3& t : rows<glm::i64vec3, std::int64_t>(h, "int64", "triangles")) {
        for (int k = 0; k < 3; ++k)
            if (t[k] < 0 || t[k] > std::int64_t{0xffffffff})
                throw Failure("add_mesh: triangle " + std::to_string(out.size()) + " refers to vertex " +
                              std::to_string(t[k]));
        out.emplace_back(t);
    }
    return out;
}

Handle<Instance> add_mesh(const Shared& w, nb::handle positions, nb::handle triangles, const std::string& name,
                          const std::optional<Handle<Material>>& material, nb::handle normals, nb::handle uvs,
                          nb::handle transform) {
    if (material && material->in != w) throw Failure("add_mesh: this material belongs to another session");
    auto data = std::make_shared<MeshData>();
    data->positions = rows<glm::vec3, float>(positions, "float32", "positions");
    data->triangles = triangles_of(triangles);
    if (!normals.is_none()) data->normals = rows<glm::vec3, float>(normals, "float32", "normals");
    if (!uvs.is_none()) data->uvs = rows<glm::vec2, float>(uvs, "float32", "uvs");
    compute_bounds(*data);
    const Scene& s = w->scene();
    const Handle<Instance> h{w, s.instances.next()};
    Instance instance{.name = name, .mesh = s.meshes.next(), .material = material ? material->id : s.materials.next()};
    if (!transform.is_none()) instance.object_to_world = to_matrix(transform);
    Edit edit{"Add " + name, {}};
    edit.changes.push_back(Change<Mesh>{s.meshes.next(), std::nullopt, Mesh{.name = name, .data = std::move(data)}});
    if (!material)
        edit.changes.push_back(
            Change<Material>{s.materials.next(), std::nullopt, Material{.name = name, .type = "diffuse"}});
    edit.changes.push_back(Change<Instance>{h.id, std::nullopt, std::move(instance)});
    w->edit(std::move(edit));
    return h;
}

Handle<Camera> add_camera(const Shared& w, const Three& position, const Three& target, const std::optional<Three>& up,
                          std::optional<double> fov, const std::string& name) {
    Camera camera; // mirrored like the active one: a scene may be mirrored
    if (const Camera* active = w->scene().cameras.find(w->scene().active_camera.value)) {
        camera = *active;
        camera.origin = {};
        camera.screen_window.reset();
    }
    camera.name = name;
    if (fov) camera.fov = float(*fov);
    const Handle<Camera> h{w, w->scene().cameras.next()};
    const bool first = !w->scene().active_camera.value;
    w->begin_step("Add " + name);
    try {
        w->edit(insert(w->scene(), std::move(camera), "Add " + name));
        nb::cast(h).attr("look_at")(target, "position"_a = position, "up"_a = up);
        if (first) w->edit(set_active_camera(w->scene(), h.id));
    } catch (...) { // reverted completely
        if (w->scene().cameras.find(h.id)) w->edit(remove(w->scene(), h.id));
        w->end_step();
        throw;
    }
    w->end_step();
    return h;
}

Handle<Group> add_group(const Shared& w, nb::handle things, const std::string& name) {
    const Objects ids = objects_of(*w, things);
    if (ids.empty()) throw Failure("add_group: a group needs at least one object");
    const Scene& s = w->scene();
    const Handle<Group> h{w, s.groups.next()};
    // Groups wholly contained are kept: they move into the new one, with their objects.
    std::map<std::uint32_t, std::size_t> chosen; // of each group: objects in it or in groups of it
    const auto each_group = [&](Id<Instance> id, auto&& f) {
        for (Id<Group> g = s.instances[id].group; g; g = s.groups[g].parent)
            f(g);
    };
    for (const auto id : ids)
        each_group(id, [&](Id<Group> g) { ++chosen[g.value]; });
    std::map<std::uint32_t, std::size_t> all;
    s.instances.each([&](Id<Instance> id, const Instance&) { each_group(id, [&](Id<Group> g) { ++all[g.value]; }); });
    const auto whole = [&](Id<Group> g) { return g && chosen[g.value] == all[g.value]; };
    // A parent common to all becomes the new group's.
    Id<Group> parent = s.instances[ids[0]].group;
    while (parent && (whole(parent) || chosen[parent.value] != ids.size()))
        parent = s.groups[parent].parent;
    Edit edit{"Add " + name, {}};
    edit.changes.push_back(Change<Group>{h.id, std::nullopt, Group{.name = name, .parent = parent}});
    std::set<std::uint32_t> moved;
    for (const auto id : ids) {
        Id<Group> outermost;
        each_group(id, [&](Id<Group> g) {
            if (whole(g)) outermost = g;
        });
        if (!outermost) {
            Instance after = s.instances[id];
            after.group = h.id;
            edit.changes.push_back(Change<Instance>{id, s.instances[id], std::move(after)});
        } else if (moved.insert(outermost.value).second) {
            Group after = s.groups[outermost];
            after.parent = h.id;
            edit.changes.push_back(Change<Group>{outermost, s.groups[outermost], std::move(after)});
        }
    }
    w->edit(std::move(edit));
    return h;
}

using Geometry = std::shared_ptr<const MeshData>;

// The array is a view of the mesh, which it keeps alive; meshes never change, so it is read-only.
template <class T, class V>
nb::object look_into(const Handle<Instance>& h, std::vector<V> MeshData::* member) {
    const Mesh* mesh = h.in->scene().meshes.find(h.get().mesh);
    if (!mesh || !mesh->data) throw Failure("the object has no mesh");
    const std::vector<V>& rows = (*mesh->data).*member;
    if (rows.empty()) return nb::none();
    auto* keep = new Geometry(mesh->data);
    const nb::capsule owner(keep, [](void* at) noexcept { delete static_cast<Geometry*>(at); });
    return nb::cast(nb::ndarray<nb::numpy, const T, nb::ndim<2>>(reinterpret_cast<const T*>(rows.data()),
                                                                 {rows.size(), sizeof(V) / sizeof(T)}, owner));
}

} // namespace

void bind_geometry(nb::class_<Workspace>& session, nb::class_<Handle<Instance>>& object) {
    using H = Handle<Instance>;
    session
        .def(
            "add_mesh", &add_mesh, "positions"_a, "triangles"_a, "name"_a = "Mesh", "material"_a = nb::none(),
            "normals"_a = nb::none(), "uvs"_a = nb::none(), "transform"_a = nb::none(),
            "A new object of triangles. positions: (n, 3) [scene units]; triangles: (m, 3), indices of positions,\n"
            "counter-clockwise seen from the front; normals: (n, 3), smooth shading, or None for flat; uvs: (n, 2) or\n"
            "None. material: None = a new diffuse one of the same name. transform: 4x4, to world.",
            nb::sig("def add_mesh(self, positions: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike, "
                    "name: str = 'Mesh', material: Material | None = None, "
                    "normals: numpy.typing.ArrayLike | None = None, uvs: numpy.typing.ArrayLike | None = None, "
                    "transform: numpy.typing.ArrayLike | None = None) -> Object"))
        .def("add_camera", &add_camera, "position"_a, "target"_a, "up"_a = nb::none(), "fov"_a = nb::none(),
             "name"_a = "Camera",
             "A new camera at a point, looking at another [scene units]; other values as in the active one; it "
             "becomes\nactive if there is none. up: default the scene's; fov: of the shorter side [deg].")
        .def("add_group", &add_group, "things"_a, "name"_a = "Group",
             "A new group of objects, groups and selections; groups wholly contained stay groups.",
             nb::sig("def add_group(self, things: Object | Group | Selection | collections.abc.Iterable[Object | Group "
                     "| Selection], name: str = 'Group') -> Group"));
    object
        .def_prop_ro(
            "vertices", [](const H& h) { return look_into<float>(h, &MeshData::positions); },
            "float32 (n, 3), read-only: the vertices of its mesh, object space; `transform` takes them to world space.",
            nb::sig("def vertices(self) -> numpy.typing.NDArray[numpy.float32]"))
        .def_prop_ro(
            "triangles", [](const H& h) { return look_into<std::uint32_t>(h, &MeshData::triangles); },
            "uint32 (m, 3), read-only: indices of vertices.",
            nb::sig("def triangles(self) -> numpy.typing.NDArray[numpy.uint32]"))
        .def_prop_ro(
            "normals", [](const H& h) { return look_into<float>(h, &MeshData::normals); },
            "float32 (n, 3), read-only: shading normals, object space; None = flat.",
            nb::sig("def normals(self) -> numpy.typing.NDArray[numpy.float32] | None"))
        .def_prop_ro(
            "uvs", [](const H& h) { return look_into<float>(h, &MeshData::uvs); },
            "float32 (n, 2), read-only: texture coordinates, or None.",
            nb::sig("def uvs(self) -> numpy.typing.NDArray[numpy.float32] | None"));
}

} // namespace restage::python
