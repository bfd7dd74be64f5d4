// SPDX-License-Identifier: Apache-2.0
// Objects: meshes, groups, and the instances that place them.
#include "io/scene_writer_calls.hpp"
#include "plugin/abi.hpp"
#include "scene/bounds.hpp"

#include <cstring>
#include <memory>

namespace restage::io {

using namespace scene;

RestageHandle SceneWriter::Calls::mesh(void* ctx, const RestageMesh* given) {
    return guarded(ctx, "mesh", [&](SceneWriter& w) -> RestageHandle {
        const RestageMesh in = plugin::sized(*given);
        const std::string who = "mesh \"" + text(in.name) + "\"";
        if (!in.positions || !in.indices || in.vertex_count == 0 || in.triangle_count == 0) {
            w.refuse(who, "it has no triangles");
            return 0;
        }
        auto data = std::make_shared<MeshData>();
        const auto copy = [n = std::size_t{in.vertex_count}](auto& to, const float* from) {
            to.resize(n);
            std::memcpy(static_cast<void*>(to.data()), from, n * sizeof to[0]);
        };
        copy(data->positions, in.positions);
        data->triangles.resize(in.triangle_count);
        std::memcpy(static_cast<void*>(data->triangles.data()), in.indices,
                    data->triangles.size() * sizeof(glm::uvec3));
        if (const std::string problem = check_mesh(*data); !problem.empty()) {
            w.refuse(who, problem);
            return 0;
        }
        const auto optional = [&](auto& to, const float* from) { // optional: the mesh is kept without it
            if (!from) return;
            copy(to, from);
            if (const std::string problem = check_mesh(*data); !problem.empty()) {
                w.report.add(Fate::approximated, who, problem + "; left out");
                to.clear();
            }
        };
        optional(data->normals, in.normals);
        optional(data->uvs, in.uvs);
        optional(data->uvs2, in.uvs2);
        optional(data->tangents, in.tangents);
        compute_bounds(*data);
        return w.push(Mesh{.name = w.unique_name("mesh", text(in.name)),
                           .data = std::move(data),
                           .source_file = text(in.source_file),
                           .primitive = text(in.primitive),
                           .origin = w.origin(in.origin)});
    });
}

RestageHandle SceneWriter::Calls::group(void* ctx, const RestageGroup* given) {
    return guarded(ctx, "group", [&](SceneWriter& w) -> RestageHandle {
        const RestageGroup in = plugin::sized(*given);
        if (!w.known<Group>(in.parent, "group", text(in.name))) return 0;
        return w.push(
            Group{.name = w.unique_name("group", text(in.name)), .parent = {in.parent}, .origin = w.origin(in.origin)});
    });
}

RestageHandle SceneWriter::Calls::instance(void* ctx, const RestageInstance* given) {
    return guarded(ctx, "instance", [&](SceneWriter& w) -> RestageHandle {
        const RestageInstance in = plugin::sized(*given);
        const std::string name = text(in.name);
        if (!w.known<Mesh>(in.mesh, "instance", name, true) ||
            !w.known<Material>(in.material, "instance", name, true) || !w.known<Group>(in.group, "instance", name) ||
            !w.known<Texture>(in.alpha_texture, "instance", name) || !w.known<Medium>(in.interior, "instance", name) ||
            !w.known<Medium>(in.exterior, "instance", name))
            return 0;
        const glm::dmat4 to_world = matrix(in.object_to_world);
        if (!affine(to_world) || !finite3(in.emission) || !finite(in.alpha)) {
            w.refuse("instance \"" + name + "\"", "its transform, emission or alpha is not finite, or not affine");
            return 0;
        }
        Instance instance{.name = w.unique_name("object", name),
                          .mesh = {in.mesh},
                          .material = {in.material},
                          .group = {in.group},
                          .object_to_world = to_world,
                          .alpha_texture = {in.alpha_texture},
                          .alpha = in.alpha,
                          .reverse_orientation = (in.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) != 0,
                          .hidden = (in.flags & RESTAGE_INSTANCE_HIDDEN) != 0,
                          .origin = w.origin(in.origin),
                          .alpha_mask = (in.flags & RESTAGE_INSTANCE_ALPHA_MASK) != 0};
        if (in.flags & RESTAGE_INSTANCE_EMITS)
            instance.emission = Emission{.radiance = vec3(in.emission),
                                         .two_sided = (in.flags & RESTAGE_INSTANCE_TWO_SIDED) != 0,
                                         .unseen = (in.flags & RESTAGE_INSTANCE_EMITS_UNSEEN) != 0};
        if (in.has_medium_interface) instance.media = MediumInterface{{in.interior}, {in.exterior}};
        return w.push(std::move(instance));
    });
}

} // namespace restage::io
