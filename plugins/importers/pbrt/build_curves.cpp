// SPDX-License-Identifier: Apache-2.0
// Curves with the same graphics state become one instance: hair of 1e5 curves is one thing to select, and one mesh to
// trace.
#include "builder.hpp"

#include <cmath>
#include <cstring>

namespace restage::pbrt {

void Builder::curve(const Directive& d, const Matrix& to_world, const std::string& name, const std::string& mesh_name) {
    if (const std::string type = d.params.string("type", "flat");
        type != "flat" && type != "cylinder" && type != "ribbon") {
        import_.warned(d.at, "Shape \"curve\"", "there is no type " + quote(type) + " of curves; cylinder is taken");
        Directive cylinder = d;
        for (Param& param : cylinder.params.params)
            if (param.name == "type") param.strings = {"cylinder"};
        curve(cylinder, to_world, name, mesh_name);
        return;
    }
    if (state_.area_light) import_.dropped(d.at, "AreaLightSource on a curve", "pbrt lets curves not emit");
    const RestageInstance instance = instance_of(d, to_world);
    static const char* const shape_params[] = {"P",      "N",      "degree",     "basis", "type",       "width",
                                               "width0", "width1", "splitdepth", "alpha", "shadowalpha"};
    for (const char* param : shape_params)
        d.params.find(param);
    const std::string verbatim = import_.keep_unused(d.params, "Shape \"curve\"");
    std::string key = name + '\n' + verbatim;
    for (const std::uint32_t part : {instance.material, instance.alpha_texture, instance.interior, instance.exterior,
                                     instance.has_medium_interface, instance.flags, instance.group})
        (key += '\n') += std::to_string(part);
    (key += '\n') += shortest(static_cast<double>(instance.alpha));

    const auto [first, last] = curves_by_state_.equal_range(key);
    CurveGroup* group = nullptr;
    Matrix to_batch;
    for (auto it = first; it != last && !group; ++it) {
        if (it->second->to_world == to_world) {
            group = it->second;
            to_batch = Matrix{};
        } else if (const Matrix relative = it->second->to_object * to_world; similarity(relative)) {
            group = it->second;
            to_batch = relative;
        }
    }
    const bool is_new = group == nullptr;
    if (!group) {
        group = &curves_.emplace_back();
        curves_by_state_.emplace(key, group);
        group->instance = instance;
        group->to_world = to_world;
        group->to_object = inverse(to_world).value_or(Matrix{});
        group->name = name;
        group->mesh_name = mesh_name;
        group->verbatim = verbatim;
        group->at = d.at;
    }
    try {
        group->batch.add(d, to_batch);
    } catch (const ImportError&) {
        if (is_new) { // it is empty
            std::erase_if(curves_by_state_, [&](const auto& entry) { return entry.second == group; });
            curves_.pop_back();
        }
        throw;
    }
}

void Builder::flush_curves() {
    for (CurveGroup& group : curves_) {
        int sides = 0;
        double error = 0;
        const Mesh mesh = group.batch.tessellate(sides, error);
        std::string note = "made into strips and tubes of " + std::to_string(sides) + " sides, at most " +
                           shortest(error * 100) + " % of their width off";
        note += group.batch.text().empty() ? "; too many to be written back as curves" : "; written back as curves";
        if (const std::size_t n = group.batch.coincident())
            note += "; " + std::to_string(n) + " that lie exactly on others are not traced";
        import_.approximated(group.at, "Shape \"curve\"", note);
        const RestageMesh out{.name = group.mesh_name.c_str(),
                              .origin = import_.origin(),
                              .vertex_count = static_cast<std::uint32_t>(mesh.vertex_count()),
                              .triangle_count = static_cast<std::uint32_t>(mesh.triangle_count()),
                              .positions = mesh.positions.data(),
                              .normals = mesh.normals.data(),
                              .uvs = mesh.uvs.data(),
                              .indices = mesh.indices.data(),
                              .source_file = "",
                              .primitive = group.batch.text().c_str()};
        group.instance.mesh = import_.out.mesh(import_.out.ctx, &out);
        if (group.instance.mesh) place(group.instance, group.name, group.verbatim);
    }
    curves_by_state_.clear();
    curves_.clear();
}

} // namespace restage::pbrt
