// SPDX-License-Identifier: Apache-2.0
// One mesh, one object with its colours, its pictures or grey, a camera and a studio.
#include "load.hpp"

#include "common/bytes.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "common/options.hpp"
#include "common/stage.hpp"
#include "common/values.hpp"
#include "object.hpp"
#include "stl.hpp"

#include <string_view>

namespace restage::mesh {

namespace fs = std::filesystem;
using namespace importing;

namespace {

Content from_ply(std::string_view bytes) {
    try {
        PlyMesh ply = read_ply(bytes, {.colors = true, .recentre = true});
        Content content;
        content.mesh = {std::move(ply.positions), std::move(ply.normals), std::move(ply.uvs), std::move(ply.indices)};
        content.origin = ply.origin;
        content.vertex_colors = std::move(ply.colors);
        content.triangle_colors = std::move(ply.triangle_colors);
        content.corner_uvs = std::move(ply.corner_uvs);
        content.triangle_pictures = std::move(ply.triangle_textures);
        content.pictures = std::move(ply.textures);
        content.edges = std::move(ply.edges);
        for (const auto& [what, count] : ply.not_read)
            content.not_read.emplace_back(what, std::to_string(count) + " values are not read");
        if (ply.has_bent_polygons)
            content.notes.emplace_back("some polygons are not flat; they are cut in projection along their normal");
        return content;
    } catch (const PlyProblem& problem) {
        if (problem.line > 0) throw ImportError{problem.what, problem.line, 1, {}};
        throw ImportError{problem.sentence() + "; export the mesh again"};
    }
}

Content from_stl(std::string_view bytes) {
    Stl stl = read_stl(bytes);
    Content content;
    content.mesh = std::move(stl.mesh);
    content.origin = stl.origin;
    content.triangle_colors = std::move(stl.colors);
    content.notes = std::move(stl.notes);
    return content;
}

void load_mesh(const fs::path& path, const RestageSceneWriter1& out) {
    Report report(out, path.string());
    std::string reason;
    const auto file = FileBytes::open(path, reason); // inflates gzip
    if (!file) throw ImportError{"the file cannot be read: " + reason};
    const std::string_view bytes = file->view();
    if (!out.progress(out.ctx, 0.1f, "reading the mesh")) throw Cancelled{};
    const bool ply = bytes.starts_with("ply") || lower(path.string()).find(".ply") != std::string::npos;
    Content content = ply ? from_ply(bytes) : from_stl(bytes);
    if (!out.progress(out.ctx, 0.9f, "making the object")) throw Cancelled{};
    const Placement placement(out, ply ? Up::y : Up::z);
    const Up up = placement.up;
    const Bounds bounds = add_objects(out, report, path, std::move(content), placement);
    add_camera(out, report, bounds, up);
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
