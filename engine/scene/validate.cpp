// SPDX-License-Identifier: Apache-2.0
#include "scene/validate.hpp"

#include "scene/tables.hpp"
#include "scene/uses.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace restage::scene {

namespace {

constexpr std::size_t listed_of_a_kind = 8;
constexpr std::uint32_t longest_film_side = 65536;       // 8 bytes a pixel and side: 32 GiB for one layer
constexpr std::uint64_t most_film_pixels = 1ull << 28;

class Findings {
  public:
    // `kind` counts alike problems together.
    void add(Problem::Severity severity, const std::string& kind, std::string sentence) {
        auto& [seen, worst] = counts_[kind];
        worst = std::max(worst, severity);
        if (++seen <= listed_of_a_kind) problems_.push_back({severity, std::move(sentence)});
    }
    void error(const std::string& kind, std::string s) { add(Problem::Severity::error, kind, std::move(s)); }
    void warning(const std::string& kind, std::string s) { add(Problem::Severity::warning, kind, std::move(s)); }

    std::vector<Problem> take() {
        for (const auto& [kind, count] : counts_)
            if (count.seen > listed_of_a_kind)
                problems_.push_back(
                    {count.worst, std::to_string(count.seen - listed_of_a_kind) + " more of this kind: " + kind});
        return std::move(problems_);
    }

  private:
    struct Count {
        std::size_t seen = 0;
        Problem::Severity worst = Problem::Severity::warning;
    };
    std::vector<Problem> problems_;
    std::map<std::string, Count> counts_;
};

bool finite(glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(float x) { return std::isfinite(x); }

template <class T>
std::string called(const T& item) {
    return std::string(kind_name<T>) + " \"" + item.name + "\"";
}

void check_references(const Scene& scene, Findings& out) {
    for_each_reference(scene, [&]<class X>(Id<X> target, const std::string& who) {
        if (!table<X>(scene).find(target))
            out.error("reference to nothing",
                      who + ": " + kind_name<X> + " " + std::to_string(target.value) + " does not exist");
    });
}

// Things that refer to things of their own kind must not do so in a circle. Iterative depth-first search, three
// colours.
template <class T, class Next>
void check_cycles(const Scene& scene, Findings& out, Next&& next) {
    const Table<T>& slots = table<T>(scene);
    enum Color : char { white, gray, black };
    std::vector<Color> color(slots.size() + 1, white);
    struct Frame {
        Id<T> id;
        std::vector<Id<T>> children;
        std::size_t visited = 0;
    };
    const auto frame = [&](Id<T> id) { return Frame{id, next(slots[id])}; };
    slots.each([&](Id<T> root, const T&) {
        if (color[root.value] != white) return;
        std::vector<Frame> path{frame(root)};
        color[root.value] = gray;
        while (!path.empty()) {
            Frame& top = path.back();
            if (top.visited == top.children.size()) {
                color[top.id.value] = black;
                path.pop_back();
                continue;
            }
            const Id<T> child = top.children[top.visited++];
            if (!slots.find(child) || color[child.value] == black) continue;
            if (color[child.value] == gray) {
                out.error("circle", called(slots[top.id]) + " contains itself through " + called(slots[child]));
                continue;
            }
            color[child.value] = gray;
            path.push_back(frame(child));
        }
    });
}

template <class T>
std::vector<Id<T>> params_of_kind(const ParamSet& params) {
    std::vector<Id<T>> result;
    visit_references(params, [&]<class X>(Id<X> id) {
        if constexpr (std::is_same_v<X, T>) result.push_back(id);
    });
    return result;
}

void check_params(const std::string& who, const ParamSet& params, Findings& out) {
    for (const auto& entry : params.entries())
        for (const float x : entry.value.v)
            if (!finite(x)) {
                out.error("value", who + ": parameter \"" + entry.id + "\" is not a finite number");
                break;
            }
}

void check_transform(const std::string& who, const glm::dmat4& m, Findings& out) {
    if (!is_finite(m)) return out.error("transform", who + ": the transform holds a value that is not a finite number");
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
        return out.error("transform", who + ": the transform is projective; only affine ones can be rendered");
    const glm::dmat3 linear(m);
    const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    if (volume == 0 || std::abs(glm::determinant(linear)) <= 1e-12 * volume)
        out.warning("flat transform", who + ": the transform flattens space and cannot be inverted");
}

void check_images(const Scene& scene, Findings& out) {
    scene.images.each([&](auto, const Image& image) {
        if (!image.data)
            return out.warning("image", called(image) + " has no pixels" +
                                            (image.path.empty() ? std::string() : ": " + image.path + " was not read"));
        const PixelData& d = *image.data;
        if (d.channels != 1 && d.channels != 3 && d.channels != 4)
            out.error("image", called(image) + ": " + std::to_string(d.channels) + " channels; 1, 3 or 4 are possible");
        else if (d.width == 0 || d.height == 0 || d.values.size() != std::size_t{d.width} * d.height * d.channels)
            out.error("image", called(image) + ": " + std::to_string(d.values.size()) + " values for " +
                                   std::to_string(d.width) + "x" + std::to_string(d.height) + " pixels of " +
                                   std::to_string(d.channels) + " channels");
    });
}

void check_things(const Scene& scene, Findings& out) {
    scene.meshes.each([&](auto, const Mesh& mesh) {
        const std::string problem = mesh.data ? check_mesh(*mesh.data) : "has no data";
        if (!problem.empty()) out.error("mesh", called(mesh) + ": " + problem);
    });
    check_images(scene, out);
    scene.textures.each([&](auto, const Texture& t) { check_params(called(t), t.params, out); });
    scene.materials.each([&](auto, const Material& m) { check_params(called(m), m.params, out); });
    scene.media.each([&](auto, const Medium& m) {
        if (!finite(m.sigma_a) || !finite(m.sigma_s) || !finite(m.g))
            out.error("medium", called(m) + " holds a value that is not a finite number");
        else if (glm::any(glm::lessThan(glm::min(m.sigma_a, m.sigma_s), glm::vec3(0))))
            out.error("medium", called(m) + " has a negative coefficient");
    });
    scene.instances.each([&](auto, const Instance& i) {
        if (!i.mesh) out.error("instance", called(i) + " has no mesh");
        if (!i.material) out.error("instance", called(i) + " has no material");
        check_transform(called(i), i.object_to_world, out);
        if (!finite(i.alpha) || (i.emission && !finite(i.emission->radiance)))
            out.error("instance", called(i) + ": alpha or emission is not a finite number");
        else if (i.emission && glm::any(glm::lessThan(i.emission->radiance, glm::vec3(0))))
            out.warning("negative emission", called(i) + " emits less than nothing");
    });
    scene.lights.each([&](auto, const Light& light) {
        check_transform(called(light), light.light_to_world, out);
        if (!finite(light.value) || !finite(light.cone_angle) || !finite(light.cone_delta))
            out.error("light", called(light) + " holds a value that is not a finite number");
    });
    scene.cameras.each([&](auto, const Camera& c) {
        check_transform(called(c), c.camera_to_world, out);
        if (c.projection == RESTAGE_PERSPECTIVE && !(c.fov > 0 && c.fov < 180))
            out.error("camera", called(c) + fmt::format(": a field of view of {:f}", c.fov) +
                                    " degrees; it must be between 0 and 180");
        if (!(c.lens_radius >= 0) || !finite(c.lens_radius) || !(c.focal_distance > 0) || !(c.frame_aspect >= 0))
            out.error("camera", called(c) + ": lens radius, focal distance or aspect is out of range");
        if (c.screen_window) {
            const glm::vec4& w = *c.screen_window;
            if (!(w.x < w.y && w.z < w.w)) out.error("camera", called(c) + ": the screen window is empty");
        }
    });
}

void check_rest(const Scene& scene, Findings& out) {
    if (scene.environment.value) {
        check_transform("the environment", scene.environment.value->light_to_world, out);
        if (!finite(scene.environment.value->scale))
            out.error("environment", "the environment's scale is not a finite number");
    }
    if (!scene.active_camera.value) out.error("camera", no_camera);
    const Film& film = scene.film.value;
    if (film.width == 0 || film.height == 0 || film.width > longest_film_side || film.height > longest_film_side ||
        std::uint64_t{film.width} * film.height > most_film_pixels)
        out.error("film", "the film has " + std::to_string(film.width) + "x" + std::to_string(film.height) +
                              " pixels; 1x1 to " + std::to_string(longest_film_side) +
                              " a side and 2^28 in all are possible");
    const glm::vec4& crop = film.crop;
    if (!(crop.x >= 0 && crop.x < crop.y && crop.y <= 1 && crop.z >= 0 && crop.z < crop.w && crop.w <= 1))
        out.error("film", "the crop window of the film is empty or outside of it");
    if (!(film.filter.radius.x > 0 && film.filter.radius.y > 0 && film.filter.radius.x <= 64 &&
          film.filter.radius.y <= 64))
        out.error("film", "the pixel filter has a radius of zero, of more than 64 pixels, or none at all");
    if (!finite(film.exposure) || film.exposure <= 0)
        out.error("film", "the exposure of the film is not a positive number");
    const Settings& s = scene.settings.value;
    if (!(s.clamp_direct >= 0) || !(s.clamp_indirect >= 0) || !(s.ray_epsilon >= 0))
        out.error("settings", "a clamp or the ray epsilon is negative or no number");
}

} // namespace

bool is_finite(const glm::dmat4& m) {
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

std::string check_mesh(const MeshData& data) {
    const std::size_t vertices = data.positions.size();
    if (vertices == 0 || data.triangles.empty()) return "has no triangles";
    if (!data.normals.empty() && data.normals.size() != vertices)
        return std::to_string(data.normals.size()) + " normals for " + std::to_string(vertices) + " vertices";
    if (!data.uvs.empty() && data.uvs.size() != vertices)
        return std::to_string(data.uvs.size()) + " texture coordinates for " + std::to_string(vertices) + " vertices";
    if (!data.uvs2.empty() && data.uvs2.size() != vertices)
        return std::to_string(data.uvs2.size()) + " texture coordinates of the second set for " +
               std::to_string(vertices) + " vertices";
    if (!data.tangents.empty() && data.tangents.size() != vertices)
        return std::to_string(data.tangents.size()) + " tangents for " + std::to_string(vertices) + " vertices";
    for (std::size_t i = 0; i < vertices; ++i)
        if (!finite(data.positions[i]))
            return "the position of vertex " + std::to_string(i) + " is not a finite number";
    for (std::size_t i = 0; i < data.normals.size(); ++i)
        if (!finite(data.normals[i])) return "the normal of vertex " + std::to_string(i) + " is not a finite number";
    for (std::size_t i = 0; i < data.uvs.size(); ++i)
        if (!finite(data.uvs[i].x) || !finite(data.uvs[i].y))
            return "the texture coordinates of vertex " + std::to_string(i) + " are not finite numbers";
    for (std::size_t i = 0; i < data.uvs2.size(); ++i)
        if (!finite(data.uvs2[i].x) || !finite(data.uvs2[i].y))
            return "the second texture coordinates of vertex " + std::to_string(i) + " are not finite numbers";
    for (std::size_t i = 0; i < data.tangents.size(); ++i)
        if (!finite(glm::vec3(data.tangents[i])) || !finite(data.tangents[i].w))
            return "the tangent of vertex " + std::to_string(i) + " is not a finite number";
    for (std::size_t i = 0; i < data.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k)
            if (data.triangles[i][k] >= vertices)
                return "triangle " + std::to_string(i) + " refers to vertex " + std::to_string(data.triangles[i][k]) +
                       " of " + std::to_string(vertices);
    return "";
}

std::vector<Problem> validate(const Scene& scene) {
    Findings out;
    check_references(scene, out);
    check_cycles<Texture>(scene, out, [](const Texture& t) { return params_of_kind<Texture>(t.params); });
    check_cycles<Material>(scene, out, [](const Material& m) { return params_of_kind<Material>(m.params); });
    check_cycles<Group>(scene, out, [](const Group& g) { return std::vector<Id<Group>>{g.parent}; });
    check_things(scene, out);
    check_rest(scene, out);
    return out.take();
}

} // namespace restage::scene
