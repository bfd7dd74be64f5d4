// SPDX-License-Identifier: Apache-2.0
// One mesh, one grey object, a camera and a studio.
#include "load.hpp"

#include "common/error.hpp"
#include "common/file.hpp"
#include "common/stage.hpp"
#include "common/values.hpp"
#include "stl.hpp"

#include <algorithm>
#include <mesh.hpp> // of the pbrt importer: read_ply
#include <source.hpp>
#include <string_view>

namespace restage::mesh {

namespace fs = std::filesystem;
using namespace importing;

namespace {

MeshBuffer from_ply(const std::string& path, std::string_view bytes, Report& report) {
    pbrt::Mesh ply;
    try {
        ply = pbrt::read_ply(path, bytes, {});
    } catch (const pbrt::ImportError& error) {
        std::string message = error.message; // it begins with the path
        if (message.starts_with(path + ": ")) message.erase(0, path.size() + 2);
        if (constexpr std::string_view tail = " or remove the shape"; message.ends_with(tail)) // there is no other
            message.resize(message.size() - tail.size());
        throw ImportError{message};
    }
    if (const std::size_t repaired = pbrt::repair_normals(ply))
        report.approximated("normals",
                            std::to_string(repaired) + " are zero or not finite; the faces' own stand for them");
    return {std::move(ply.positions), std::move(ply.normals), std::move(ply.uvs), std::move(ply.indices)};
}

void load_mesh(const fs::path& path, const RestageSceneWriter1& out) {
    Report report(out, path.string());
    std::string reason;
    const auto file = pbrt::FileBytes::open(path, reason); // inflates gzip
    if (!file) throw ImportError{"the file cannot be read: " + reason};
    const std::string_view bytes = file->view();
    if (!out.progress(out.ctx, 0.1f, "reading the mesh")) throw Cancelled{};
    const bool ply = bytes.starts_with("ply") || lower(path.string()).find(".ply") != std::string::npos;
    const MeshBuffer mesh = ply ? from_ply(path.string(), bytes, report) : read_stl(bytes);
    if (mesh.indices.empty()) throw ImportError{"the file holds no faces"};
    if (!out.progress(out.ctx, 0.9f, "making the object")) throw Cancelled{};

    const std::string name = path.stem().string();
    Values values;
    values.color("reflectance", {0.5, 0.5, 0.5});
    const RestageMaterialDesc grey = {
        .text = {"grey", "", ""}, .type = "diffuse", .values = values.data(), .value_count = values.size()};
    RestageInstance instance{};
    instance.text = {name.c_str(), "", ""};
    instance.mesh = mesh.push(out, name, ply ? path.string() : "");
    instance.material = out.material(out.ctx, &grey);
    instance.alpha = 1;
    std::copy_n(Matrix().m.begin(), 16, instance.object_to_world);
    if (!instance.mesh || !out.instance(out.ctx, &instance)) throw ImportError{"the mesh cannot be used"};
    report.kept("mesh", std::to_string(mesh.triangle_count()) + " triangles, " + std::to_string(mesh.vertex_count()) +
                            " vertices; the format has no material: it is grey");
    const Up up = ply ? Up::y : Up::z;
    add_camera(out, report, mesh.bounds(), up);
    add_film(out);
    add_studio(out, report, up);
}

} // namespace

int probe(const char* path, const void* head, std::size_t head_size) {
    const std::string_view text(static_cast<const char*>(head), head ? head_size : 0);
    if (text.starts_with("ply\n") || text.starts_with("ply\r")) return 100;
    for (const char* extension : {"ply", "ply.gz", "stl"})
        if (has_extension(path, extension)) return 90;
    return is_ascii_stl(text) ? 70 : 0;
}

int load(const char* path, const RestageSceneWriter1* out) {
    if (!path || !out) return 0;
    return guarded_load(path, *out, [&] {
        std::error_code code;
        const fs::path full = fs::weakly_canonical(path, code);
        load_mesh(code ? fs::path(path) : full, *out);
    });
}

} // namespace restage::mesh
