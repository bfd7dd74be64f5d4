// SPDX-License-Identifier: Apache-2.0
#include "document/clipboard.hpp"

#include "document/project.hpp"
#include "scene/bounds.hpp"
#include "scene/merge.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <set>

namespace restage::document {

using namespace scene;

namespace {

constexpr std::size_t most_inline = 6 << 20; // bytes of geometry and pixels written into the text
constexpr std::size_t most_text = 12 << 20; // X servers take requests of up to 16 MB

constexpr const char* mark = "copied"; // in the note

// Bytes of data not available from a file.
std::size_t data_bytes(const Scene& s) {
    std::set<const void*> seen;
    std::size_t bytes = 0;
    s.meshes.each([&](auto, const Mesh& m) {
        if (m.data && seen.insert(m.data.get()).second)
            bytes += m.data->positions.size() * 12 + m.data->normals.size() * 12 + m.data->uvs.size() * 8 +
                     m.data->triangles.size() * 12;
    });
    s.images.each([&](auto, const Image& i) {
        if (i.data && i.path.empty() && seen.insert(i.data.get()).second) bytes += i.data->values.size() * 4;
    });
    return bytes;
}

} // namespace

void add_carrier(Scene& s, Id<Material> material) {
    auto triangle = std::make_shared<MeshData>();
    triangle->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    triangle->triangles = {{0, 1, 2}};
    compute_bounds(*triangle);
    const Id<Mesh> mesh = s.meshes.next();
    apply(s, insert(s, Mesh{.name = "carrier", .data = triangle}, ""));
    apply(s, insert(s, Instance{.name = "carrier", .mesh = mesh, .material = material}, ""));
}

Result<Scene> part_of(const Scene& scene, const Selected& selected) {
    Scene part = scene; // shares its data
    const std::set<Id<Instance>> wanted(selected.instances.begin(), selected.instances.end());
    Edit rest;
    part.instances.each([&](Id<Instance> id, const Instance& i) {
        if (selected.material || !wanted.contains(id)) rest.changes.push_back(Change<Instance>{id, i, std::nullopt});
    });
    part.lights.each([&](Id<Light> id, const Light& l) {
        if (id != selected.light) rest.changes.push_back(Change<Light>{id, l, std::nullopt});
    });
    part.cameras.each([&](Id<Camera> id, const Camera& c) { // the active one defines up and handedness
        if (id != part.active_camera.value) rest.changes.push_back(Change<Camera>{id, c, std::nullopt});
    });
    apply(part, rest);
    part.environment.value.reset();
    part.settings.value = {};
    part.film.value = {};
    if (selected.material) {
        if (!part.materials.find(selected.material)) return fail("the material no longer exists");
        add_carrier(part, selected.material);
    }
    if (part.instances.live() + part.lights.live() == 0) return fail("nothing to copy");
    apply(part, remove_unused(part));
    return part;
}

Result<std::string> copy_text(const Session& session, const Selected& selected) {
    RESTAGE_TRY(const Scene part, part_of(session.scene(), selected));
    DataSources sources;
    if (data_bytes(part) > most_inline) {
        sources = session.sources();
        if (!session.base().file.empty())
            sources.note_all(session.base().scene, session.base().file, session.base().format, session.base().options);
    }
    const std::map<std::string, std::string> note{{mark, selected.material ? "material" : "objects"}};
    const Base nothing;
    std::string text = project_text({.base = nothing, .scene = part, .sources = sources, .note = &note}, {});
    if (text.size() > most_text)
        return fail(fmt::format("that is {} MB, too much for the clipboard; save the scene, and insert its file there",
                                text.size() >> 20));
    return text;
}

bool is_copy(std::string_view text) {
    const std::string_view head = text.substr(0, 200);
    return text.starts_with('{') && head.find("\"restage\"") != head.npos &&
           head.find(std::string("\"") + mark + "\"") != head.npos;
}

Result<Copy> read_copy(const std::string& text, const plugin::Registry& registry) {
    RESTAGE_TRY(Document document, read_project_text(text, "clipboard", registry));
    Copy copy;
    apply(copy.scene, document.changes);
    const auto what = document.note.find(mark);
    copy.material = what != document.note.end() && what->second == "material";
    return copy;
}

namespace {

bool near(const glm::dmat4& a, const glm::dmat4& b) {
    for (int c = 0; c < 4; ++c)
        if (glm::length(a[c] - b[c]) > 1e-6 * (1 + glm::length(b[c]))) return false;
    return true;
}

std::size_t triangles(const Scene& s, const Instance& i) {
    const Mesh* mesh = s.meshes.find(i.mesh);
    return mesh && mesh->data ? mesh->data->triangles.size() : 0;
}

// The same shape is already in that place, so that the copy would be invisible.
bool covered(const Scene& into, const Scene& copied, const glm::dmat4& move) {
    bool found = false;
    copied.instances.each([&](auto, const Instance& i) {
        into.instances.each([&](auto, const Instance& other) {
            found = found || (near(other.object_to_world, move * i.object_to_world) &&
                              triangles(into, other) == triangles(copied, i));
        });
    });
    copied.lights.each([&](auto, const Light& l) {
        into.lights.each(
            [&](auto, const Light& other) { found = found || near(other.light_to_world, move * l.light_to_world); });
    });
    return found;
}

} // namespace

Pasted paste(const Scene& into, const Scene& copied, const glm::dvec3& aside) {
    Scene placed = copied;
    glm::dmat4 move(1);
    if (aside != glm::dvec3(0))
        while (covered(into, copied, move))
            move[3] += glm::dvec4(aside, 0);
    std::string name;
    copied.instances.each([&](Id<Instance> id, const Instance& i) {
        Instance there = i;
        there.object_to_world = move * i.object_to_world;
        placed.instances.set(id, std::move(there), ++placed.clock);
        name = i.name;
    });
    copied.lights.each([&](Id<Light> id, const Light& l) {
        Light there = l;
        there.light_to_world = move * l.light_to_world;
        placed.lights.set(id, std::move(there), ++placed.clock);
        name = l.name;
    });
    Merged merged = merge(into, placed, "");
    Pasted pasted{.edit = std::move(merged.edit), .instances = std::move(merged.instances), .light = {}};
    for (const AnyChange& change : pasted.edit.changes)
        if (const auto* light = std::get_if<Change<Light>>(&change)) pasted.light = light->id;
    const std::size_t count = pasted.instances.size();
    pasted.edit.label = count > 1 ? fmt::format("Paste {} objects", count) : "Paste " + name;
    return pasted;
}

Result<Edit> paste_material(const Scene& into, const Copy& copy, std::span<const Id<Instance>> to) {
    Id<Material> original;
    copy.scene.instances.each([&](auto, const Instance& i) { original = i.material; });
    const Material* material = copy.scene.materials.find(original);
    if (!material) return fail("the clipboard contains no material");
    Merged merged = merge(into, copy.scene, "");
    Edit edit{"Paste material " + material->name, {}};
    Id<Material> pasted;
    for (AnyChange& change : merged.edit.changes) // except its carrier object
        if (const auto* carrier = std::get_if<Change<Instance>>(&change))
            pasted = carrier->after->material;
        else if (!std::holds_alternative<Change<Mesh>>(change))
            edit.changes.push_back(std::move(change));
    for (const Id<Instance> id : to) {
        const Instance* before = into.instances.find(id);
        if (!before) return fail("an object no longer exists");
        Instance after = *before;
        after.material = pasted;
        edit.changes.push_back(Change<Instance>{id, *before, std::move(after)});
    }
    return edit;
}

} // namespace restage::document
