// SPDX-License-Identifier: Apache-2.0
// Exporters whose format has an importer, in the same bundle or among Restage's own: after a round trip of a scene its
// triangles are where they were. The second and third round trips give the same scene.
#include "check/export_scenes.hpp"
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "io/export.hpp"
#include "io/import.hpp"
#include "io/scene_compare.hpp"
#include "io/services.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::check {

namespace fs = std::filesystem;

namespace {

// The visible geometry of a scene, however it is divided into meshes and objects.
struct Seen {
    std::size_t triangles = 0;
    double area = 0;
    glm::dvec3 lower{1e300}, upper{-1e300}, mean{0}; // mean: of the corners

    explicit Seen(const scene::Scene& scene) {
        scene.instances.each([&](auto, const scene::Instance& instance) {
            const scene::Mesh* mesh = scene.meshes.find(instance.mesh);
            if (!mesh || !mesh->data || instance.hidden) return;
            for (const auto& triangle : mesh->data->triangles) {
                glm::dvec3 p[3];
                for (int k = 0; k < 3; ++k) {
                    const glm::dvec3 corner(mesh->data->positions[triangle[std::size_t(k)]]);
                    p[k] = glm::dvec3(instance.object_to_world * glm::dvec4(corner, 1));
                    lower = glm::min(lower, p[k]), upper = glm::max(upper, p[k]), mean += p[k];
                }
                ++triangles, area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
            }
        });
        mean /= std::max(3.0 * double(triangles), 1.0);
    }
    // "" or what differs.
    std::string difference(const Seen& other) const {
        if (triangles != other.triangles) return fmt::format("{} triangles became {}", triangles, other.triangles);
        const double size = glm::length(upper - lower), tolerance = 1e-5 * size;
        const auto off = [&](glm::dvec3 a, glm::dvec3 b) { return !(glm::length(a - b) <= tolerance); };
        if (off(lower, other.lower) || off(upper, other.upper) || off(mean, other.mean))
            return fmt::format("the mean of the vertices is ({:.6g}, {:.6g}, {:.6g}), and was ({:.6g}, {:.6g}, {:.6g})",
                               other.mean.x, other.mean.y, other.mean.z, mean.x, mean.y, mean.z);
        return std::abs(area - other.area) <= 1e-4 * area
                   ? ""
                   : fmt::format("the area is {:.6g}, and was {:.6g}", other.area, area);
    }
};

bool shares_extension(const model::Importer& in, const model::Exporter& out) {
    return std::any_of(out.extensions.begin(), out.extensions.end(), [&](const std::string& extension) {
        return std::find(in.extensions.begin(), in.extensions.end(), extension) != in.extensions.end();
    });
}

} // namespace

Result<StepResult> check_roundtrip(Subject& s) {
    const model::Exporter& exporter = *s.exporter;
    // The bundle and Restage's own plugins; for equal ids the first is used.
    Log silent([](LogLevel, std::string_view) {});
    plugin::Registry registry(silent, io::with_services());
    std::vector<plugin::SearchPath> paths = plugin::Registry::default_paths();
    std::erase_if(paths, [](const plugin::SearchPath& path) { return !path.own; });
    paths.insert(paths.begin(), {s.folder, true});
    s.doing("init() or query(), with Restage's own plugins loaded");
    registry.scan(paths);
    const auto importers = registry.importers();
    const auto reader = std::find_if(importers.begin(), importers.end(),
                                     [&](const auto& i) { return shares_extension(*i.table, exporter); });
    if (reader == importers.end())
        return StepResult::skip("neither the bundle nor Restage has an importer for its format");

    const TemporaryFolder folder;
    const scene::Scene given = geometry_scene();
    const Seen before(given);
    std::size_t rounds = 0;
    for (const scene::ParamSet& set : option_sets(exporter)) {
        const std::string what = "options " + describe(set);
        io::ExportOptions options{.progress = {}, .format = exporter.format, .values = set};
        io::ImportOptions reading;
        reading.format = reader->table->format;
        scene::Scene scene = given;
        for (int round = 0; round < 3; ++round, ++rounds) {
            const fs::path place = folder.path / "saved", file = place / ("scene." + exporter.extensions[0]);
            std::error_code code;
            fs::remove_all(place, code);
            fs::create_directories(place, code);
            s.doing(fmt::format("save(), {}, round {}", what, round + 1));
            const auto saved = io::export_scene(scene, file.string(), registry, options);
            if (!saved) return StepResult::failed(what + ": " + saved.error().message);
            s.doing(fmt::format("load() of importer {} on the output of save(), {}", reading.format, what));
            auto read = io::import_scene(file.string(), registry, reading);
            s.alive();
            if (!read)
                return StepResult::failed(
                    fmt::format("{}: the importer {} cannot read it: {}", what, reading.format, read.error().message));
            const bool declared = saved->count(io::Fate::dropped) + saved->count(io::Fate::approximated) > 0;
            if (const std::string off = before.difference(Seen(read->scene)); !off.empty() && !declared)
                return StepResult::failed(fmt::format("{}: read back by the importer {}, {}; save() reported no loss",
                                                      what, reading.format, off));
            if (round > 0) // a scene that the format can hold must not change
                if (const auto off = io::structural_differences(scene, read->scene, registry, {.most = 1});
                    !off.empty())
                    return StepResult::failed(what + ": a second round trip changes the scene: " + off[0]);
            scene = std::move(read->scene);
        }
    }
    return StepResult::passed({{"rounds", double(rounds)}}, "read back by the importer " + reader->table->format);
}

} // namespace restage::check
