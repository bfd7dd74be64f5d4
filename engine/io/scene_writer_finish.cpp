// SPDX-License-Identifier: Apache-2.0
// After the importer has pushed everything: pixels, a camera if there is none, and the final check.
#include "io/image_file.hpp"
#include "io/material_tables.hpp"
#include "io/scene_writer.hpp"
#include "scene/bounds.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

namespace restage::io {

using namespace scene;

void SceneWriter::read_images(Jobs& jobs, Version newer_than) {
    struct Job {
        Id<Image> id;
        Image image;
        std::string problem, warning;
    };
    std::vector<Job> work;
    scene.images.each_changed(newer_than, [&](Id<Image> id, const Image* image) {
        if (image && !image->data && !image->path.empty()) work.push_back({id, *image, {}, {}});
    });
    jobs.parallel_for(work.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            Job& job = work[i];
            auto pixels = read_image(job.image.path, job.image.encoding, job.image.gamma, &job.warning);
            if (pixels)
                job.image.data = std::make_shared<const PixelData>(std::move(*pixels));
            else
                job.problem = pixels.error().message;
        }
    });
    for (Job& job : work) {
        const std::string who = "image \"" + job.image.name + "\"";
        // The importer may have named the place that refers to it.
        const bool told = std::ranges::any_of(report.entries, [&](const ReportEntry& entry) {
            return entry.fate == Fate::dropped && entry.note.ends_with(": " + job.image.path);
        });
        if (!job.problem.empty() && !told)
            report.add(Fate::dropped, who, job.problem, job.image.path);
        else if (!job.warning.empty())
            report.add(Fate::approximated, who, job.warning, job.image.path);
        scene.images.set(job.id, std::move(job.image), scene.clock);
    }
}

// In front of everything, looking along -z, the default of most modellers.
void SceneWriter::add_camera() {
    const Bounds bounds = world_bounds(scene);
    const double radius = bounds.empty() ? 1 : std::max(bounds.radius(), 1e-6);
    const glm::dvec3 center = bounds.empty() ? glm::dvec3(0) : bounds.center();
    Camera camera{.name = unique_name("camera", "camera"), .fov = 45};
    camera.camera_to_world = glm::translate(glm::dmat4(1), center + glm::dvec3(0, 0, 2.7 * radius));
    camera.camera_to_world[0] = {-1, 0, 0, 0}; // +z of the camera looks along -z of the world; y stays up
    camera.camera_to_world[2] = {0, 0, -1, 0};
    camera.focal_distance = static_cast<float>(2.7 * radius);
    const Id<Camera> id = scene.cameras.next();
    scene.cameras.set(id, std::move(camera), scene.clock);
    scene.active_camera = {id, scene.clock};
    report.add(Fate::approximated, "camera", "the file has none; one was added in front of everything");
}

Result<> SceneWriter::finish(Jobs& jobs, bool with_images) {
    if (!scene.active_camera.value) add_camera();
    if (with_images) {
        read_images(jobs);
        report_tables(scene, registry_, report);
    }
    for (const Problem& problem : validate(scene))
        if (problem.severity == Problem::Severity::error) return fail(problem.sentence);
    scene.film.version = scene.settings.version = scene.environment.version = scene.clock;
    return {};
}

} // namespace restage::io
