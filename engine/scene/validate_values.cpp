// SPDX-License-Identifier: Apache-2.0
// Problems in an item's values, whether set by an importer, an edit builder or a script.
#include "scene/color_temperature.hpp"
#include "scene/development.hpp"
#include "scene/edit.hpp"
#include "scene/tables.hpp"
#include "scene/validate.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::scene {

namespace {

constexpr std::uint32_t longest_film_side = 65536;       // 8 bytes per pixel and side: 32 GiB for one layer
constexpr std::uint64_t most_film_pixels = 1ull << 28;
// Tracers compute in floats, so squared lengths must fit a float. [scene units]
constexpr double largest_length = 1e17;
// [W/(m^2 sr)] and the like; times areas and sample counts it must still fit a float.
constexpr float most_light = 1e18f;

template <class... X>
bool finite(X... x) {
    return (std::isfinite(x) && ...);
}
bool finite(const glm::vec3& v) { return finite(v.x, v.y, v.z); }
bool negative(const glm::vec3& v) { return v.x < 0 || v.y < 0 || v.z < 0; }

template <class T>
std::string called(const T& item) {
    return std::string(kind_name<T>) + " \"" + item.name + "\"";
}

class Found {
  public:
    void error(const char* kind, std::string s) { add(Problem::Severity::error, kind, std::move(s)); }
    void warning(const char* kind, std::string s) { add(Problem::Severity::warning, kind, std::move(s)); }
    std::vector<ValueProblem> take() { return std::move(problems_); }

    void params(const std::string& who, const ParamSet& params) {
        for (const auto& entry : params.entries())
            for (const float x : entry.value.v)
                if (!finite(x)) {
                    error("value", who + ": parameter \"" + entry.id + "\" is not a finite number");
                    break;
                }
    }

    void transform(const std::string& who, const glm::dmat4& m) {
        if (!is_finite(m)) return error("transform", who + ": the transform has a non-finite value");
        if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
            return error("transform", who + ": the transform is projective; only affine ones can be rendered");
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 3; ++r)
                if (std::abs(m[c][r]) > largest_length)
                    return error("transform", fmt::format("{}: the transform has a value of {:g}; the maximum is {:g}",
                                                          who, m[c][r], largest_length));
        const glm::dmat3 linear(m);
        const double volume = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
        if (volume == 0 || std::abs(glm::determinant(linear)) <= 1e-12 * volume)
            warning("flat transform", who + ": the transform flattens space and cannot be inverted");
    }

    // Emitted colour: of a lamp, a sky or a surface.
    void light(const std::string& who, const char* kind, const char* what, const glm::vec3& v) {
        if (!finite(v))
            error(kind, fmt::format("{}: {} has a non-finite value", who, what));
        else if (std::max({v.x, v.y, v.z}) > most_light)
            error(kind,
                  fmt::format("{}: {} of {:g}; the maximum is {:g}", who, what, std::max({v.x, v.y, v.z}), most_light));
        else if (negative(v))
            warning("negative light", fmt::format("{}: {} ({:g}, {:g}, {:g}) is negative", who, what, v.x, v.y, v.z));
    }

  private:
    void add(Problem::Severity severity, const char* kind, std::string s) {
        problems_.push_back({{severity, std::move(s)}, kind});
    }
    std::vector<ValueProblem> problems_;
};

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

std::vector<ValueProblem> value_problems(const Mesh& mesh) {
    Found out;
    const std::string problem = mesh.data ? check_mesh(*mesh.data) : "has no data";
    if (!problem.empty()) out.error("mesh", called(mesh) + ": " + problem);
    return out.take();
}

std::vector<ValueProblem> value_problems(const Image& image) {
    Found out;
    if (!image.data) {
        out.warning("image", called(image) + " has no pixels" +
                                 (image.path.empty() ? std::string() : ": " + image.path + " was not read"));
        return out.take();
    }
    const PixelData& d = *image.data;
    if (d.channels != 1 && d.channels != 3 && d.channels != 4)
        out.error("image", fmt::format("{}: {} channels; must be 1, 3 or 4", called(image), d.channels));
    else if (d.width == 0 || d.height == 0 || d.values.size() != std::size_t{d.width} * d.height * d.channels)
        out.error("image", fmt::format("{}: {} values for {}x{} pixels of {} channels", called(image), d.values.size(),
                                       d.width, d.height, d.channels));
    return out.take();
}

std::vector<ValueProblem> value_problems(const Texture& t) {
    Found out;
    out.params(called(t), t.params);
    return out.take();
}

std::vector<ValueProblem> value_problems(const Material& m) {
    Found out;
    out.params(called(m), m.params);
    return out.take();
}

std::vector<ValueProblem> value_problems(const Medium& m) {
    Found out;
    if (!finite(m.sigma_a) || !finite(m.sigma_s) || !finite(m.g))
        out.error("medium", called(m) + " has a non-finite value");
    else if (negative(m.sigma_a) || negative(m.sigma_s))
        out.error("medium", called(m) + " has a negative coefficient");
    return out.take();
}

std::vector<ValueProblem> value_problems(const Group&) { return {}; }

std::vector<ValueProblem> value_problems(const Instance& i) {
    Found out;
    out.transform(called(i), i.object_to_world);
    if (!finite(i.alpha)) out.error("instance", called(i) + ": alpha is not a finite number");
    if (i.emission) out.light(called(i), "emission", "an emission", i.emission->radiance);
    return out.take();
}

std::vector<ValueProblem> value_problems(const Light& light) {
    Found out;
    out.transform(called(light), light.light_to_world);
    out.light(called(light), "light", "a value", light.value);
    if (!finite(light.cone_angle, light.cone_delta))
        out.error("light", called(light) + " has a non-finite value");
    else if (light_row(light.kind).cone &&
             !(light.cone_angle > 0 && light.cone_angle <= 180 && light.cone_delta >= 0 && light.cone_delta <= 180))
        out.warning("cone",
                    fmt::format("{}: a cone of {:g} degrees with an edge of {:g}; they must be above 0, and 0 or more, "
                                "and at most 180",
                                called(light), light.cone_angle, light.cone_delta));
    return out.take();
}

std::vector<ValueProblem> value_problems(const Camera& c) {
    Found out;
    out.transform(called(c), c.camera_to_world);
    if (c.projection == scene::Projection::perspective && !(c.fov > 0 && c.fov < 180))
        out.error("camera",
                  fmt::format("{}: a field of view of {:g} degrees; it must be between 0 and 180", called(c), c.fov));
    if (!(c.lens_radius >= 0 && c.lens_radius <= largest_length))
        out.error("camera", fmt::format("{}: a lens radius of {:g}; it must be 0 (a pinhole) or more, and a number",
                                        called(c), c.lens_radius));
    if (!(c.focal_distance > 0) || !finite(c.focal_distance))
        out.error("camera", fmt::format("{}: a focal distance of {:g}; it must be a number above 0", called(c),
                                        c.focal_distance));
    if (!(c.frame_aspect >= 0) || !finite(c.frame_aspect))
        out.error("camera", fmt::format("{}: a frame aspect of {:g}; it must be a number above 0, or 0 for the film's",
                                        called(c), c.frame_aspect));
    if (!(c.fit_aspect >= 0) || !finite(c.fit_aspect))
        out.error("camera", fmt::format("{}: a frame to fit of aspect {:g}; it must be a number above 0, or 0 for none",
                                        called(c), c.fit_aspect));
    if (c.screen_window) {
        const glm::vec4& w = *c.screen_window;
        if (!(w.x < w.y && w.z < w.w) || !finite(w.x, w.y, w.z, w.w))
            out.error("camera", called(c) + ": the screen window is empty or has a non-finite value");
    }
    return out.take();
}

std::vector<ValueProblem> value_problems(const Environment& e) {
    Found out;
    out.transform("the environment", e.light_to_world);
    out.light("the environment", "environment", "a scale", e.scale);
    out.params("the environment", e.sky_params);
    return out.take();
}

std::vector<ValueProblem> value_problems(const Film& film) {
    Found out;
    if (film.width == 0 || film.height == 0 || film.width > longest_film_side || film.height > longest_film_side ||
        std::uint64_t{film.width} * film.height > most_film_pixels)
        out.error("film", fmt::format("the film has {}x{} pixels; it must be 1x1 to {} per side and 2^28 in total",
                                      film.width, film.height, longest_film_side));
    const glm::vec4& crop = film.crop;
    if (!(crop.x >= 0 && crop.x < crop.y && crop.y <= 1 && crop.z >= 0 && crop.z < crop.w && crop.w <= 1))
        out.error("film", "the crop window of the film is empty or outside of it");
    const Filter& f = film.filter;
    if (!(f.radius.x > 0 && f.radius.y > 0 && f.radius.x <= 64 && f.radius.y <= 64))
        out.error("film", "the pixel filter has a radius of zero, of more than 64 pixels, or none at all");
    if (!finite(f.params.x, f.params.y))
        out.error("film", "the pixel filter has a parameter that is not a finite number");
    else if ((f.kind == FilterKind::gaussian || f.kind == FilterKind::sinc) && !(f.params.x > 0))
        out.error("film", fmt::format("the pixel filter's {} is {:g}; it must be above 0",
                                      f.kind == FilterKind::gaussian ? "sigma" : "tau", f.params.x));
    if (!finite(film.exposure) || film.exposure <= 0 || film.exposure > most_light)
        out.error("film", fmt::format("an exposure of {:g}; it must be a number above 0", film.exposure));
    const Development& d = film.development;
    const auto in = [&](const char* what, float value, double least, double most) {
        if (double(value) >= least && double(value) <= most) return;
        out.error("film", fmt::format("a {} of {:g}; it must be from {:g} to {:g}", what, value, least, most));
    };
    in("white balance", d.temperature, least_kelvin, most_kelvin);
    in("tint", d.tint, -double(most_tint), double(most_tint));
    in("vignette", d.vignette, 0, 1);
    in("bloom", d.bloom, 0, 1);
    const glm::vec3& behind = d.backdrop_color;
    if (!(std::min({behind.x, behind.y, behind.z}) >= 0 && std::max({behind.x, behind.y, behind.z}) <= 1))
        out.error("film", "a colour of the backdrop that is not from 0 to 1");
    if (std::size_t(d.tone) >= tone_names.size()) out.error("film", "a tone curve that does not exist");
    return out.take();
}

std::vector<ValueProblem> value_problems(const Settings& s) {
    Found out;
    if (!(s.clamp_direct >= 0) || !(s.clamp_indirect >= 0) || !(s.ray_epsilon >= 0) ||
        !finite(s.clamp_direct, s.clamp_indirect, s.ray_epsilon))
        out.error("settings", "a clamp or the ray epsilon is negative or not a finite number");
    return out.take();
}

namespace {

std::vector<ValueProblem> problems_in(const std::optional<Environment>& e) {
    return e ? value_problems(*e) : std::vector<ValueProblem>{};
}
std::vector<ValueProblem> problems_in(const Id<Camera>&) { return {}; }
template <class T>
std::vector<ValueProblem> problems_in(const T& thing) {
    return value_problems(thing);
}
template <class T>
std::vector<ValueProblem> problems_in(const std::optional<T>& thing) {
    return thing ? value_problems(*thing) : std::vector<ValueProblem>{};
}

// Large data is checked only when new.
template <class C>
bool same_data(const C& c) {
    if constexpr (std::is_same_v<C, Change<Mesh>> || std::is_same_v<C, Change<Image>>)
        return c.before && c.after && c.before->data == c.after->data;
    else
        return false;
}

} // namespace

Result<> check_edit(const Edit& edit, Problem::Severity least) {
    for (const AnyChange& change : edit.changes) {
        std::string refused;
        std::visit(
            [&](const auto& c) {
                if (same_data(c)) return;
                for (const ValueProblem& p : problems_in(c.after)) {
                    if (p.severity < least ||
                        (p.severity == Problem::Severity::warning && std::string_view(p.kind) == "image"))
                        continue;
                    const auto before = problems_in(c.before);
                    const bool was_so = std::ranges::any_of(
                        before, [&](const ValueProblem& b) { return std::string_view(b.kind) == p.kind; });
                    if (!was_so && refused.empty()) refused = p.sentence;
                }
            },
            change);
        if (!refused.empty()) return fail(std::move(refused));
    }
    return {};
}

} // namespace restage::scene
