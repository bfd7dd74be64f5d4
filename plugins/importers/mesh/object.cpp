// SPDX-License-Identifier: Apache-2.0
#include "object.hpp"

#include "common/baked_colors.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "common/strokes.hpp"
#include "common/textures.hpp"

#include <algorithm>
#include <cmath>

namespace restage::mesh {

namespace fs = std::filesystem;
using namespace importing;

namespace {

Rgb linear(const std::vector<float>& colors, std::size_t i) {
    return {srgb_to_linear(double(colors[3 * i])), srgb_to_linear(double(colors[3 * i + 1])),
            srgb_to_linear(double(colors[3 * i + 2]))};
}

class Maker {
  public:
    Maker(const RestageSceneWriter1& out, Report& report, const fs::path& path, Content content,
          const Placement& placement)
        : out_(out),
          report_(report),
          path_(path),
          name_(path.stem().string()),
          in_(std::move(content)),
          placement_(placement) {}

    Bounds run() {
        repair_normals();
        if (in_.mesh.indices.empty()) thicken();
        if (in_.mesh.indices.empty()) throw ImportError{"the file holds no faces"};
        const bool has_uvs = !in_.corner_uvs.empty() || !in_.mesh.uvs.empty();
        const bool has_colors = !in_.vertex_colors.empty() || !in_.triangle_colors.empty();
        if (has_uvs && !in_.pictures.empty())
            textured(has_colors);
        else
            plain(has_colors);
        for (const std::string& note : in_.notes)
            report_.approximated("mesh", note);
        for (const auto& [what, how_much] : in_.not_read)
            report_.dropped(what, how_much);
        if (!in_.edges.empty() && !thick_)
            report_.dropped("edges", std::to_string(in_.edges.size() / 2) + " lines have no surface");
        if (in_.origin != Vec3{})
            report_.kept("coordinates", "they are large for the mesh's size; it is kept relative to a point of it");
        return bounds_;
    }

  private:
    void repair_normals() { // zero or not finite
        if (in_.mesh.normals.empty()) return;
        std::size_t bad = 0;
        for (std::size_t i = 0; i + 2 < in_.mesh.normals.size(); i += 3) {
            const double n = length({in_.mesh.normals[i], in_.mesh.normals[i + 1], in_.mesh.normals[i + 2]});
            bad += !(n > 1e-12 && std::isfinite(n));
        }
        if (bad == 0) return;
        std::vector<Vec3> sums(in_.mesh.vertex_count(), Vec3{0, 0, 0});
        for (std::size_t i = 0; i + 2 < in_.mesh.indices.size(); i += 3) {
            const std::uint32_t* c = &in_.mesh.indices[i];
            const Vec3 p = in_.mesh.position(c[0]);
            const Vec3 n = cross(in_.mesh.position(c[1]) - p, in_.mesh.position(c[2]) - p);
            for (int k = 0; k < 3; ++k)
                sums[c[k]] = sums[c[k]] + n;
        }
        for (std::size_t v = 0; v < sums.size(); ++v) {
            float* n = &in_.mesh.normals[3 * v];
            const double l = length({n[0], n[1], n[2]});
            if (l > 1e-12 && std::isfinite(l)) continue;
            const Vec3 mean = normalized(sums[v]);
            for (std::size_t c = 0; c < 3; ++c)
                n[c] = static_cast<float>(mean[c]);
        }
        report_.approximated("normals",
                             std::to_string(bad) + " are zero or not finite; the faces' own are used instead");
    }

    // Points or lines only: with a radius, and the colours of their points.
    void thicken() {
        const bool lines = !in_.edges.empty();
        std::vector<std::uint32_t> points(lines ? 0 : in_.mesh.vertex_count());
        for (std::uint32_t i = 0; i < points.size(); ++i)
            points[i] = i;
        Strokes strokes = lines ? thick_lines(in_.mesh.positions, in_.edges) : thick_points(in_.mesh.positions, points);
        thick_ = true;
        const std::string what = lines ? "lines" : "points";
        report_.approximated(
            what, "the file has no faces; its " + std::to_string(lines ? in_.edges.size() / 2 : points.size()) + " " +
                      what + " get a radius of " + std::to_string(strokes.radius) +
                      (strokes.step > 1 ? ", every " + std::to_string(strokes.step) + "th of them" : ""));
        std::vector<float> colors;
        for (std::size_t t = 0; t < strokes.mesh.triangle_count() && !in_.vertex_colors.empty(); ++t) {
            const std::size_t stroke = t / strokes.triangles_each * strokes.step;
            const float* c = &in_.vertex_colors[3 * std::size_t{lines ? in_.edges[2 * stroke] : stroke}];
            colors.insert(colors.end(), c, c + 3);
        }
        in_.mesh = std::move(strokes.mesh);
        in_.vertex_colors.clear();
        in_.triangle_colors = std::move(colors);
    }

    RestageHandle diffuse(const std::string& name, RestageHandle texture, const Rgb& color = {0.5, 0.5, 0.5}) {
        Values values;
        if (texture)
            values.texture("reflectance", RESTAGE_COLOR, texture);
        else
            values.color("reflectance", color);
        const RestageMaterialDesc desc = {
            .name = name.c_str(), .type = "diffuse", .values = values.data(), .value_count = values.size()};
        return out_.material(out_.ctx, &desc);
    }

    // `source`: the file an exporter may refer to instead, while the mesh equals its contents.
    void object(const MeshBuffer& mesh, const std::string& name, RestageHandle material, const std::string& source) {
        const Matrix to_world = placement_.of(translation(in_.origin));
        RestageInstance instance{};
        instance.name = name.c_str();
        instance.mesh = mesh.push(out_, name, source);
        instance.material = material;
        instance.alpha = 1;
        std::copy_n(to_world.m.begin(), 16, instance.object_to_world);
        if (!instance.mesh || !out_.instance(out_.ctx, &instance)) throw ImportError{"the mesh cannot be used"};
        bounds_.add(mesh.bounds(), to_world);
    }

    std::string counts() const {
        return std::to_string(in_.mesh.triangle_count()) + " triangles, " + std::to_string(in_.mesh.vertex_count()) +
               " vertices";
    }

    void plain(bool has_colors) {
        if (!in_.pictures.empty())
            report_.dropped("texture files",
                            std::to_string(in_.pictures.size()) + " are named, but there are no texture coordinates");
        const std::string what = counts();
        if (has_colors) {
            const bool faces = !in_.triangle_colors.empty();
            const auto& colors = faces ? in_.triangle_colors : in_.vertex_colors;
            const std::vector<std::uint32_t> corners = faces ? std::vector<std::uint32_t>() : in_.mesh.indices;
            const RestageHandle image = bake_colors(
                out_, name_ + " colours", in_.mesh,
                [&](std::size_t t, std::size_t c) { return linear(colors, faces ? t : corners[3 * t + c]); });
            if (faces && !in_.vertex_colors.empty())
                report_.dropped("vertex colours", "the faces have colours, which are shown");
            if (image) {
                object(in_.mesh, name_,
                       diffuse("colours", add_imagemap(out_, name_ + " colours", image, false, Mapping{})), "");
                report_.kept("mesh",
                             what + "; the colours of its " + (faces ? "faces" : "vertices") + " are a texture");
                return;
            }
            Rgb mean{};
            for (std::size_t i = 0; i < colors.size() / 3; ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    mean[c] += linear(colors, i)[c] / static_cast<double>(colors.size() / 3);
            object(in_.mesh, name_, diffuse("mean colour", 0, mean), source());
            report_.approximated("colours", "too many triangles for a picture of them: their mean is shown");
            return;
        }
        object(in_.mesh, name_, diffuse("grey", 0), source());
        report_.kept("mesh", what + "; the file has no material: it is grey");
    }

    std::string source() const {
        return thick_ || in_.origin != Vec3{} || lower(path_.string()).find(".ply") == std::string::npos
                   ? ""
                   : path_.string();
    }

    void textured(bool has_colors) {
        if (has_colors) report_.dropped("colours of vertices or faces", "the mesh has textures, which are shown");
        const std::string what = counts();
        const bool whole = in_.corner_uvs.empty() && in_.triangle_pictures.empty();
        if (!in_.corner_uvs.empty()) {
            unshare_corners(in_.mesh);
            in_.mesh.uvs = std::move(in_.corner_uvs);
        }
        std::vector<RestageHandle> materials;
        for (const std::string& picture : in_.pictures) {
            const std::string file = find_file(path_.parent_path(), picture).string();
            materials.push_back(diffuse(
                picture, add_imagemap(out_, picture, add_image_file(out_, file, RESTAGE_SRGB), false, Mapping{})));
        }
        std::size_t without = 0;
        for (std::size_t p = 0; p < materials.size(); ++p) {
            MeshBuffer part = in_.mesh;
            if (!in_.triangle_pictures.empty()) {
                part.indices.clear();
                for (std::size_t t = 0; t < in_.triangle_pictures.size(); ++t) {
                    const std::size_t wanted = std::min<std::size_t>(in_.triangle_pictures[t], materials.size() - 1);
                    without += p == 0 && wanted != in_.triangle_pictures[t];
                    if (wanted == p)
                        part.indices.insert(part.indices.end(), &in_.mesh.indices[3 * t], &in_.mesh.indices[3 * t] + 3);
                }
            } else if (p > 0) {
                report_.dropped("texture " + quote(in_.pictures[p]), "no face uses it");
                continue;
            }
            if (part.indices.empty()) continue;
            drop_unused(part);
            object(part, materials.size() > 1 ? name_ + " " + in_.pictures[p] : name_, materials[p],
                   whole ? source() : "");
        }
        if (without) report_.approximated("textures", std::to_string(without) + " triangles name a missing one");
        report_.kept("mesh", what + ", textured");
    }

    static void drop_unused(MeshBuffer& mesh) { // vertices
        std::vector<std::uint32_t> place(mesh.vertex_count(), 0xffffffffu);
        MeshBuffer out;
        for (const std::uint32_t i : mesh.indices) {
            if (place[i] == 0xffffffffu) {
                place[i] = out.vertex_count();
                const auto take = [i](std::vector<float>& to, const std::vector<float>& from, std::size_t width) {
                    for (std::size_t c = 0; c < width && !from.empty(); ++c)
                        to.push_back(from[i * width + c]);
                };
                take(out.normals, mesh.normals, 3);
                take(out.uvs, mesh.uvs, 2);
                take(out.positions, mesh.positions, 3);
            }
            out.indices.push_back(place[i]);
        }
        mesh = std::move(out);
    }

    const RestageSceneWriter1& out_;
    Report& report_;
    const fs::path& path_;
    std::string name_;
    Content in_;
    const Placement& placement_;
    Bounds bounds_;
    bool thick_ = false;
};

} // namespace

Bounds add_objects(const RestageSceneWriter1& out, Report& report, const fs::path& path, Content content,
                   const Placement& placement) {
    return Maker(out, report, path, std::move(content), placement).run();
}

} // namespace restage::mesh
