// SPDX-License-Identifier: Apache-2.0
// Shapes become a mesh (shared by identical shapes) and an instance; ObjectInstance repeats instances.
#include "builder.hpp"
#include "curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::pbrt {

namespace {

std::string stem_of(const std::string& file) { // "models/cup.ply.gz" -> "cup"
    std::string stem = std::filesystem::path(file).stem().string();
    if (stem.ends_with(".ply")) stem.resize(stem.size() - 4);
    return stem;
}

// The shape as in the file, without the part stored in the instance.
std::string shape_line(const Directive& d, bool v3) {
    std::string line = "Shape " + quote(d.name);
    for (const Param& param : d.params.params) {
        if (param.name == "alpha" || (v3 && is_material_parameter(param.name))) continue;
        (line += ' ') += to_text(param);
        param.used = true;
    }
    return line;
}

// The broken shapes that pbrt skips with a message, or never hits. It stops at others.
bool goes_on_without(const std::string& shape, bool v3) {
    for (const char* quadric : {"sphere", "disk", "cylinder", "cone", "paraboloid", "hyperboloid"})
        if (shape == quadric) return true;
    return shape == "trianglemesh" || shape == "bilinearmesh" || shape == "curve" ||
           (v3 && (shape == "plymesh" || shape == "loopsubdiv"));
}

void set_matrix(double (&to)[16], const Matrix& from) { std::memcpy(to, from.m.data(), sizeof to); }

bool is_affine(const Matrix& m) { return m.at(3, 0) == 0 && m.at(3, 1) == 0 && m.at(3, 2) == 0 && m.at(3, 3) == 1; }

} // namespace

RestageHandle Builder::missing_mesh(const std::string& name, const std::string& line, const std::string& file) {
    RestageHandle& handle = mesh_cache_["missing\n" + line];
    if (handle) return handle;
    // One triangle without area: nothing hits it.
    const float positions[9] = {};
    const std::uint32_t indices[3] = {0, 1, 2};
    const std::string primitive = "missing " + line;
    const RestageMesh out{.name = name.c_str(),
                          .origin = import_.origin(),
                          .vertex_count = 3,
                          .triangle_count = 1,
                          .positions = positions,
                          .normals = nullptr,
                          .uvs = nullptr,
                          .indices = indices,
                          .source_file = file.c_str(),
                          .primitive = primitive.c_str()};
    return handle = import_.out.mesh(import_.out.ctx, &out);
}

void Builder::placeholder(const Directive& d, const std::string& name, const std::string& line,
                          const std::string& file) {
    const Matrix to_world = ctm(d);
    if (!is_affine(to_world) || !(std::abs(determinant3(to_world)) > 0)) return;
    const std::string called = take_name({name});
    RestageInstance instance = instance_of(d, to_world);
    instance.mesh = missing_mesh(called, line, file);
    if (!instance.mesh) return;
    const Mesh none;
    const std::string emitted = state_.area_light && d.verb != Verb::light_source ? emission(d, none, instance) : "";
    place(instance, called, emitted);
}

RestageHandle Builder::ply_mesh(const Directive& d, const std::string& name, const Mesh*& data) {
    const std::string file = d.params.string("filename", "");
    if (file.empty()) throw ImportError{d.at, "Shape \"plymesh\" needs \"string filename\""};
    const std::string path = import_.resolve(file, d.at).string();
    if (d.params.has("displacement") && d.params.find("displacement")) {
        d.params.find("edgelength");
        import_.dropped(d.at, "displacement of " + quote(file), "meshes are not displaced");
    }
    if (const auto known = mesh_cache_.find(path); known != mesh_cache_.end() && !state_.area_light)
        return known->second;
    std::string reason;
    const auto bytes = FileBytes::open(path, reason);
    if (!bytes) {
        import_.lost(d.at, "Shape \"plymesh\" " + quote(file), reason + ": " + path + "; its place is kept");
        if (state_.area_light) data = &(emitter_meshes_[path] = Mesh{});
        return missing_mesh(name, shape_line(d, import_.v3()), path);
    }
    Mesh mesh = read_ply(path, bytes->view(), d.at);
    if (mesh.has_bent_quads)
        import_.approximated(d.at, "Shape \"plymesh\" " + quote(file),
                             "polygons that are not flat are split into triangles");
    if (const std::size_t repaired = repair_normals(mesh))
        import_.approximated(d.at, "Shape \"plymesh\" " + quote(file),
                             std::to_string(repaired) + " normals without a direction are replaced by the faces'");
    RestageHandle& handle = mesh_cache_[path];
    if (handle == 0) {
        const RestageMesh out{.name = name.c_str(),
                              .origin = import_.origin(),
                              .vertex_count = static_cast<std::uint32_t>(mesh.vertex_count()),
                              .triangle_count = static_cast<std::uint32_t>(mesh.triangle_count()),
                              .positions = mesh.positions.data(),
                              .normals = mesh.normals.empty() ? nullptr : mesh.normals.data(),
                              .uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data(),
                              .indices = mesh.indices.data(),
                              .source_file = path.c_str(),
                              .primitive = ""};
        handle = import_.out.mesh(import_.out.ctx, &out);
    }
    if (state_.area_light) data = &(emitter_meshes_[path] = std::move(mesh));
    return handle;
}

RestageHandle Builder::mesh(const Directive& d, const std::string& name, const Mesh*& data) {
    if (d.name == "plymesh") return ply_mesh(d, name, data);
    Mesh mesh;
    std::string key; // the shape's own line, for shapes beyond triangles
    const bool is_triangles = d.name == "trianglemesh";
    const auto is_own = [&](const Param& param) {
        return param.name != "alpha" && param.name != "shadowalpha" &&
               !(import_.v3() && is_material_parameter(param.name));
    };
    const auto line = [&](bool all) { // or of those that are used
        std::string text = d.name;
        for (const Param& param : d.params.params)
            if (is_own(param) && (all || (param.used && !param.misfit))) (text += ' ') += to_text(param);
        return text;
    };
    if (!is_triangles) {
        key = line(true);
        if (const auto known = mesh_cache_.find(key); known != mesh_cache_.end() && !state_.area_light) {
            const auto& odd = odd_parameters_[key];
            for (const Param& param : d.params.params) {
                const auto found = odd.find(param.name);
                param.used = found == odd.end();
                param.misfit = found != odd.end() && found->second;
            }
            return known->second;
        }
    }
    if (auto quadric = make_quadric(import_, d)) {
        mesh = std::move(*quadric);
    } else if (is_triangles) {
        mesh = make_triangle_mesh(import_, d);
    } else if (d.name == "bilinearmesh") {
        mesh = make_bilinear(import_, d);
    } else if (d.name == "loopsubdiv") {
        mesh = make_loop(import_, d);
    } else if (d.name == "heightfield" || d.name == "heightfield2") {
        mesh = make_heightfield(import_, d);
    } else if (d.name == "nurbs") {
        mesh = make_nurbs(import_, d);
    } else {
        import_.lost(d.at, "Shape " + quote(d.name), "there is no such shape in pbrt; its place is kept");
        if (state_.area_light) data = &(emitter_meshes_[key] = Mesh{});
        return missing_mesh(name, shape_line(d, import_.v3()));
    }
    if (const std::size_t repaired = repair_normals(mesh))
        import_.approximated(d.at, "Shape " + quote(d.name),
                             std::to_string(repaired) + " normals without a direction are replaced by the faces'");
    for (const float value : mesh.positions)
        if (!std::isfinite(value))
            throw ImportError{d.at,
                              "Shape " + quote(d.name) + " has a vertex that is not finite; check its parameters"};
    if (mesh.indices.empty()) {
        import_.dropped(d.at, "Shape " + quote(d.name), "it is empty");
        return 0;
    }
    const std::string primitive = is_triangles ? "" : line(false);
    for (const Param& param : d.params.params) // ignored parameters go with the instance
        if (is_own(param) && (!param.used || param.misfit)) odd_parameters_[key][param.name] = param.misfit;
    const RestageMesh out{.name = name.c_str(),
                          .origin = import_.origin(),
                          .vertex_count = static_cast<std::uint32_t>(mesh.vertex_count()),
                          .triangle_count = static_cast<std::uint32_t>(mesh.triangle_count()),
                          .positions = mesh.positions.data(),
                          .normals = mesh.normals.empty() ? nullptr : mesh.normals.data(),
                          .uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data(),
                          .indices = mesh.indices.data(),
                          .source_file = "",
                          .primitive = primitive.c_str()};
    RestageHandle handle = 0;
    if (is_triangles) {
        handle = import_.out.mesh(import_.out.ctx, &out);
    } else {
        RestageHandle& cached = mesh_cache_[key];
        if (cached == 0) cached = import_.out.mesh(import_.out.ctx, &out);
        handle = cached;
    }
    if (state_.area_light) data = &(emitter_meshes_[key] = std::move(mesh));
    return handle;
}

void Builder::shape(const Directive& d) {
    const Matrix to_world = ctm(d);
    const std::string stem = d.name == "plymesh" ? stem_of(d.params.string("filename", "")) : "";
    std::string mesh_name = std::move(next_.mesh);
    const std::string name = shape_name(d, stem);
    if (mesh_name.empty()) mesh_name = stem.empty() ? name : stem;
    if (!is_affine(to_world) || !(std::abs(determinant3(to_world)) > 0)) {
        d.params.mark_all_used();
        import_.dropped(
            d.at, "Shape " + quote(d.name),
            is_affine(to_world) ? "its transformation flattens it to nothing" : "its transformation is not affine");
        return;
    }
    const Mesh* data = nullptr;
    const Mesh none;
    RestageHandle handle = 0;
    try {
        if (d.name == "curve") {
            curve(d, to_world, name, mesh_name);
            return;
        }
        handle = mesh(d, mesh_name, data);
    } catch (const ImportError& error) {
        if (!goes_on_without(d.name, import_.v3()) || (error.stops_pbrt && !import_.v3())) throw;
        import_.lost(error.at, "Shape " + quote(d.name), error.message + "; left out, as pbrt does, its place is kept");
        handle =
            missing_mesh(mesh_name, shape_line(d, import_.v3()),
                         d.name == "plymesh" ? import_.resolve(d.params.string("filename", ""), d.at).string() : "");
        data = &none;
    }
    if (handle == 0) {
        d.params.mark_all_used();
        return;
    }
    RestageInstance instance = instance_of(d, to_world);
    instance.mesh = handle;
    if (hair_.count(instance.material))
        import_.approximated(
            d.at, "Material \"hair\" on Shape " + quote(d.name),
            "pbrt takes the place across the fibre from v; here it follows from the view, as on curves");
    const std::string emitted = state_.area_light && data ? emission(d, *data, instance) : "";
    place(instance, name, import_.keep_unused(d.params, "Shape " + quote(d.name)) + emitted);
}

RestageInstance Builder::instance_of(const Directive& d, const Matrix& to_world) {
    RestageInstance instance{};
    instance.alpha = 1;
    instance.material = material_of_shape(d);
    // pbrt-v3 has it for triangles only, and there any alpha above 0 is opaque (Triangle::Intersect).
    const bool has_alpha = !import_.v3() || d.name == "trianglemesh" || d.name == "plymesh";
    if (d.params.has("alpha") && has_alpha) {
        const Argument alpha = float_argument(d, "alpha", 1);
        instance.alpha_texture = alpha.texture;
        instance.alpha = static_cast<float>(std::clamp(alpha.value.r, 0.0, 1.0));
        if (import_.v3()) instance.flags |= RESTAGE_INSTANCE_ALPHA_MASK;
    }
    if (d.params.has("shadowalpha"))
        import_.approximated(d.at, "\"shadowalpha\" of Shape " + quote(d.name),
                             "shadows use \"alpha\"; written back as it is");
    // The outside. The host transforms the object-space normal by the inverse transpose, which keeps it
    // outside under a mirror, and negates it for REVERSE_ORIENTATION. pbrt takes cross(e1, e2) in world space and flips
    // it if ReverseOrientation xor (the transform swaps handedness); but a world-space cross product has flipped once
    // already when handedness is swapped (cross(M a, M b) = det(M) M^-T cross(a, b)), so the two cancel and
    // ReverseOrientation alone remains. Explicit normals decide the side in both, negated when reversed. For mirrored
    // quadrics pbrt contradicts itself (Sphere::Intersect flips by the xor, Sphere::Sample by ReverseOrientation
    // alone); this is the latter, which also is the side a user sees.
    if (state_.reverse_orientation) instance.flags |= RESTAGE_INSTANCE_REVERSE_ORIENTATION;
    if (!state_.interior.empty() || !state_.exterior.empty()) {
        instance.interior = medium_named(state_.interior, d);
        instance.exterior = medium_named(state_.exterior, d);
        instance.has_medium_interface = 1;
    }
    set_matrix(instance.object_to_world, to_world);
    if (d.ours) instance.flags |= RESTAGE_INSTANCE_HIDDEN;
    instance.group = state_.group;
    return instance;
}

void Builder::place(RestageInstance instance, const std::string& name, const std::string& verbatim) {
    instance.name = name.c_str();
    instance.origin = import_.origin(verbatim);
    if (open_object_.empty()) {
        import_.out.instance(import_.out.ctx, &instance);
        return;
    }
    Object& object = objects_[open_object_];
    instance.name = object.names.emplace_back(name).c_str(); // its origin is valid during the import
    object.instances.push_back(instance);
    object.named_by_itself = own_name_;
}

void Builder::end_object() {
    if (open_object_.empty()) return;
    flush_curves();
    Object& object = objects_[open_object_];
    if (object.instances.size() == 1 && !object.named_by_itself && !is_generic_name(open_object_))
        object.instances[0].name = object.names.emplace_back(open_object_).c_str();
    open_object_.clear();
}

// Returns the verbatim line of its light before it became RGB.
std::string Builder::emission(const Directive& shape, const Mesh& mesh, RestageInstance& instance) {
    const Directive& d = *state_.area_light;
    const auto no_light = [&](const std::string& what, const char* why) {
        import_.dropped(d.at, what, why);
        d.params.mark_all_used();
        return std::string();
    };
    if (!open_object_.empty())
        return no_light("AreaLightSource in ObjectBegin", "pbrt's instanced objects do not emit");
    if (!import_.v3() && interfaces_.count(instance.material))
        return no_light("AreaLightSource on an interface", "pbrt's surfaces without a material do not emit");
    if (d.name != "diffuse" && d.name != "area")
        return no_light("AreaLightSource " + quote(d.name), "there is no such area light in pbrt");
    Rgb radiance = import_.color(d.params, "L", Role::light, {1, 1, 1});
    double scale = light_scale(d, radiance);
    const bool two_sided = d.params.boolean("twosided", false);
    const double power = d.params.number("power", -1); // v4: of each light, and each triangle is one
    const bool has_area = mesh.triangle_count() > 0;
    if (power > 0 && has_area) {
        Matrix to_world;
        std::memcpy(to_world.m.data(), instance.object_to_world, sizeof instance.object_to_world);
        const bool by_triangle = shape.name == "trianglemesh" || shape.name == "plymesh" || shape.name == "loopsubdiv";
        const double lights = by_triangle ? static_cast<double>(mesh.triangle_count()) : 1;
        scale *= power * lights / ((two_sided ? 2 : 1) * area(mesh, to_world) * 3.14159265358979323846);
        if (lights > 2)
            import_.approximated(d.at, "\"power\" of an AreaLightSource",
                                 "pbrt gives it to each triangle; it is spread evenly");
    }
    if (power > 0 && !has_area) scale = 1; // goes with the power
    radiance = radiance * scale;
    for (const char* name : {"samples", "nsamples"})
        d.params.find(name); // affects sampling only
    Matrix placed;
    std::memcpy(placed.m.data(), instance.object_to_world, sizeof instance.object_to_world);
    const std::optional<double> grown = similarity(placed);
    const bool quadric = shape.name == "sphere" || shape.name == "disk" || shape.name == "cylinder";
    if (quadric && !(grown && std::abs(*grown - 1) < 1e-3))
        import_.approximated(shape.at, "AreaLightSource on a scaled " + quote(shape.name),
                             "it emits by its size in the world; pbrt samples such a light as if unscaled, "
                             "and warns that its picture may have errors");
    // Invisible lamps: v3's emit for any alpha (DiffuseAreaLight ignores it), v4's for alpha 0.
    const bool holes = instance.alpha_texture != 0 || instance.alpha < 1;
    const bool gone =
        instance.alpha_texture != 0 ? zero_textures_.contains(instance.alpha_texture) : instance.alpha == 0;
    if (import_.v3() ? holes : gone) instance.flags |= RESTAGE_INSTANCE_EMITS_UNSEEN;
    // DiffuseAreaLight::L applies alpha after the primitive has; only SampleLi applies it once.
    if (!import_.v3() && holes && !gone)
        import_.approximated(
            shape.at, "AreaLightSource on a Shape with alpha",
            "where it is visible, alpha counts once, as where it is sampled; pbrt counts it twice there, "
            "and shows a lamp of alpha 0.5 at a quarter");
    instance.flags |= RESTAGE_INSTANCE_EMITS | (two_sided ? std::uint32_t(RESTAGE_INSTANCE_TWO_SIDED) : 0u);
    instance.emission[0] = static_cast<float>(radiance.r);
    instance.emission[1] = static_cast<float>(radiance.g);
    instance.emission[2] = static_cast<float>(radiance.b);
    std::string exact = exact_light(d, "emission", "L", instance.emission, scale);
    const bool picture = d.params.find("filename") != nullptr;
    if (picture) {
        import_.approximated(d.at, "AreaLightSource with a picture",
                             "emits evenly, with the strength of a white picture; written back as it is");
        missing_files_of(d, "AreaLightSource");
    }
    if (picture || (power > 0 && !has_area)) { // the whole line, valid while the colour is unchanged
        exact = "=emission";
        for (const float x : instance.emission)
            exact += " " + shortest(static_cast<double>(x));
        for (const Param& param : d.params.params)
            if (param.name != "twosided" && !(param.name == "L" && (param.type == "rgb" || param.type == "color")))
                exact += " " + to_text(param); // an RGB colour is written from the scene
        exact += "\n";
    }
    import_.keep_unused(d.params, "AreaLightSource " + quote(d.name));
    d.params.mark_all_used(); // reported once
    return exact;
}

void Builder::object_instance(const Directive& d) {
    if (!in_world(d)) return;
    if (!open_object_.empty() && import_.v3()) { // api.cpp, pbrtObjectInstance
        import_.lost(d.at, "ObjectInstance " + quote(d.name), "inside ObjectBegin; left out, as pbrt does");
        return;
    }
    if (!open_object_.empty())
        throw ImportError{d.at, "ObjectInstance inside ObjectBegin; pbrt does not nest objects: move it out"};
    const auto found = objects_.find(d.name.empty() ? " " : d.name);
    if (found == objects_.end() && later_objects_.count(d.name)) { // v4 resolves names after reading the file
        late_instances_.push_back({&d, state_, next_});
        return;
    }
    if (found == objects_.end()) {
        import_.lost(d.at, "ObjectInstance " + quote(d.name), "no ObjectBegin has that name; its place is kept");
        placeholder(d, d.name, "ObjectInstance " + quote(d.name));
        return;
    }
    const Matrix placed = ctm(d);
    const auto& members = found->second.instances;
    const std::vector<std::string> names = std::move(next_.members);
    const bool alone = next_.alone && members.size() == 1;
    const std::string name = take_name({std::string(next_.label), d.name, state_.label, "object"});
    RestageHandle handle = state_.group;
    if (!alone) {
        const RestageGroup group{.name = name.c_str(), .origin = import_.origin(), .parent = state_.group};
        handle = import_.out.group(import_.out.ctx, &group);
    }
    for (std::size_t i = 0; i < members.size(); ++i) {
        RestageInstance instance = members[i];
        if (alone)
            instance.name = name.c_str();
        else if (names.size() == members.size())
            instance.name = names[i].c_str();
        Matrix own;
        std::memcpy(own.m.data(), instance.object_to_world, sizeof instance.object_to_world);
        const Matrix to_world = placed * own;
        if (!is_affine(to_world) || !(std::abs(determinant3(to_world)) > 0)) {
            import_.dropped(d.at, "ObjectInstance " + quote(d.name), "its transformation flattens it to nothing");
            return;
        }
        set_matrix(instance.object_to_world, to_world);
        instance.group = handle;
        if (d.ours) instance.flags |= RESTAGE_INSTANCE_HIDDEN;
        import_.out.instance(import_.out.ctx, &instance);
    }
}

} // namespace restage::pbrt
