// SPDX-License-Identifier: Apache-2.0
// Scene: the truth. Plain structs in tables, ids between them; heavy data is shared and immutable, so that a duplicate
// of an object costs one instance. Nothing here knows files, plugins or GPUs. It changes only through edits (edit.hpp).
// Frames: right-handed or mirrored as imported; camera and lights look along +z as in pbrt. Lengths in scene units,
// angles in degrees, colours linear sRGB, radiometry relative as in pbrt.
#pragma once

#include "scene/id.hpp"
#include "scene/light_kinds.hpp"
#include "scene/params.hpp"

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace restage::scene {

// A value before it was reduced to what the scene can hold, in its format's notation.
struct OriginValue {
    std::string id; // of the value; "*": of the whole thing, possibly on several lines
    std::string text;
    bool operator==(const OriginValue&) const = default;
};

// The origin of a thing. The engine reads only the ids: values are valid only until that one, or any ("*"),
// is edited (edits.hpp).
struct Origin {
    std::string verbatim; // not understood by its importer: one "key value" line each, written back verbatim
    std::string format; // "pbrt-v4", ...; "" = created in Restage
    std::vector<OriginValue> values;
    bool operator==(const Origin&) const = default;
};

struct MeshData { // immutable once shared
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; // as many as positions, or none
    std::vector<glm::vec2> uvs; // as many as positions, or none
    std::vector<glm::uvec3> triangles; // indices < positions.size()
    glm::vec3 lower{0}, upper{0}; // bounds of the positions
    std::vector<glm::vec4> tangents; // as many as positions, or none; w: sign of the bitangent (restage/scene_io.h)
    std::vector<glm::vec2> uvs2; // a second set, as many as positions, or none
};

struct Mesh {
    std::string name;
    std::shared_ptr<const MeshData> data;
    std::string source_file; // exporters may refer to it
    std::string primitive; // `sphere "float radius" 1`: what the triangles represent
    Origin origin;
    bool operator==(const Mesh&) const = default; // data compares by identity
};

struct PixelData { // immutable once shared; linear
    std::uint32_t width = 0, height = 0, channels = 0; // 1, 3 or 4; row 0 is the top
    std::vector<float> values; // width * height * channels
};

// How values of an 8-bit file are linearized; float files are linear.
enum class Encoding : std::uint8_t { linear, srgb, gamma };

struct Image {
    std::string name;
    std::string path; // absolute; "" = only in memory
    Encoding encoding = Encoding::srgb;
    float gamma = 2.2f;
    std::shared_ptr<const PixelData> data; // null = the file could not be read (reported); shades as `missing`
    Origin origin;
    bool operator==(const Image&) const = default;
};

struct Texture { // types and values: restage/scene_io.h
    std::string name;
    std::string type;
    bool is_float = false;
    Id<Image> image;
    ParamSet params;
    Origin origin;
    bool operator==(const Texture&) const = default;
};

struct Material {
    std::string name;
    std::string type; // of a material plugin; an unknown type shades as a placeholder and is kept
    ParamSet params;
    Origin origin;
    bool operator==(const Material&) const = default;
};

struct Medium { // homogeneous; absorption is rendered, scattering is kept and reported
    std::string name;
    glm::vec3 sigma_a{0}, sigma_s{0}; // [1/unit]
    float g = 0;
    Origin origin;
    bool operator==(const Medium&) const = default;
};

struct Group {
    std::string name;
    Id<Group> parent;
    Origin origin;
    bool operator==(const Group&) const = default;
};

struct Emission {
    glm::vec3 radiance{0}; // [W/(m^2 sr)]
    bool two_sided = false;
    bool unseen = false; // emits even where alpha lets rays pass: lights, but is invisible there
    bool operator==(const Emission&) const = default;
};

struct MediumInterface {
    Id<Medium> interior, exterior; // none = vacuum
    bool operator==(const MediumInterface&) const = default;
};

struct Instance {
    std::string name;
    Id<Mesh> mesh;
    Id<Material> material;
    Id<Group> group;
    glm::dmat4 object_to_world{1}; // affine
    std::optional<Emission> emission;
    std::optional<MediumInterface> media;
    Id<Texture> alpha_texture; // scalar; replaces alpha
    float alpha = 1;
    bool reverse_orientation = false;
    bool hidden = false;
    Origin origin;
    bool alpha_mask = false; // alpha above 0 stops every ray; else it is the fraction stopped
    bool catcher = false; // not seen, but shadows on it are (render/catcher.hpp)
    bool operator==(const Instance&) const = default;
};

struct Light { // without a surface
    std::string name;
    LightKind kind = LightKind::point;
    glm::vec3 value{1}; // [light_kinds.hpp: unit]
    glm::dmat4 light_to_world{1};
    float cone_angle = 30, cone_delta = 5; // [deg]
    Origin origin;
    Falloff falloff = Falloff::smooth; // of a spot's edge
    bool hidden = false; // switched off
    bool operator==(const Light&) const = default;
};

inline Cone cone_of(const Light& light) {
    const auto cosine = [](float degrees) { return std::cos(glm::radians(double(degrees))); };
    return {cosine(light.cone_angle), cosine(light.cone_angle - light.cone_delta), light.falloff};
}

enum class Mapping : std::uint8_t {
    equirect, // z up, u = phi/2pi, v = theta/pi, row 0 = +z: pbrt-v3
    octahedral // equal-area, Clarberg 2008: pbrt-v4
};

struct Environment {
    std::string name;
    Id<Image> image; // none = constant
    Mapping mapping = Mapping::equirect;
    glm::vec3 scale{1};
    glm::dmat4 light_to_world{1};
    bool hidden_from_camera = false; // it lights; camera rays that leave the scene see black
    Origin origin;
    std::string sky; // type of the sky plugin that made the image; "" = none
    ParamSet sky_params; // its parameters
    bool operator==(const Environment&) const = default;
};

// How a camera maps directions to the film, and which members of Camera it uses.
enum class Projection : std::uint8_t {
    perspective,
    orthographic, // parallel to +z; the screen window is in camera-space units, fov is unused
    spherical, // all directions, +y up: u = phi/2pi from +x over +z, v = theta/pi from +y; no window, no lens
    spherical_equal_area // likewise by Clarberg's octahedral map, as in pbrt-v4
};

struct Camera {
    std::string name;
    glm::dmat4 camera_to_world{1};
    float fov = 45; // [deg], of the shorter side
    std::optional<glm::vec4> screen_window; // x0 x1 y0 y1
    float lens_radius = 0, focal_distance = 1; // 0 = pinhole
    float frame_aspect = 0; // 0 = width/height
    Origin origin;
    Projection projection = Projection::perspective;
    float fit_aspect = 0; // > 0: fov is of a frame of this aspect, which is always fully visible (projection.hpp)
    bool operator==(const Camera&) const = default;
};

enum class FilterKind { box, triangle, gaussian, mitchell, sinc };
struct Filter {
    FilterKind kind = FilterKind::box;
    glm::vec2 radius{0.5f}; // [pixel]
    glm::vec2 params{0.f}; // gaussian: sigma | mitchell: B, C | sinc: tau
    bool operator==(const Filter&) const = default;
};

enum class ToneCurve : std::uint8_t { // view/develop.hpp
    srgb, // clipped
    filmic,
    agx,
    neutral,
};
enum class Backdrop : std::uint8_t { // behind the picture, where camera rays meet neither a surface nor a visible sky
    black,
    color,
    transparent,
};
inline constexpr float most_tint = 150;
// How radiance becomes the 8 bits of a screen, .png or .jpg. Files of floats keep the radiance.
struct Development {
    ToneCurve tone = ToneCurve::srgb;
    float temperature = 6504; // [K] of the light that is shown as white: white_balance() of color_temperature.hpp
    float tint = 0; // of that light: > 0 greenish, < 0 pinkish; to most_tint
    float vignette = 0; // to 1: squared tangent of the angle from which light reaches the corners, dimmed by cos^4
    float bloom = 0; // to 1: the fraction of all light that lens and eye scatter
    Backdrop backdrop = Backdrop::black;
    glm::vec3 backdrop_color{1}; // as shown, linear sRGB in [0,1]: no tone curve changes it
    bool operator==(const Development&) const = default;
};

struct Film {
    std::uint32_t width = 640, height = 360;
    glm::vec4 crop{0, 1, 0, 1}; // x0 x1 y0 y1
    Filter filter;
    float exposure = 1;
    Development development;
    std::string filename;
    bool operator==(const Film&) const = default;
};

// Of a technique that does not pay in every scene.
enum class Technique : std::uint8_t {
    automatic, // where it pays
    on,
    off,
};
// What affects the image but is not an item of the scene.
struct Settings {
    std::uint32_t max_depth = 8; // pbrt's maxdepth
    std::uint32_t samples = 64;
    bool russian_roulette = true;
    bool spectral = false; // paths carry four wavelengths instead of RGB
    bool adaptive = false; // more samples where the picture is noisier
    Technique guiding = Technique::automatic; // directions are chosen by what earlier samples found
    Technique caustics = Technique::automatic; // light through glass and off mirrors by photon maps; biased, consistent
    float clamp_direct = 0, clamp_indirect = 0; // biased; 0 = off
    float ray_epsilon = 0; // 0 = error-bounded offsets; else an offset in scene units
    Id<Medium> camera_medium;
    Origin origin; // integrator, sampler, options
    bool operator==(const Settings&) const = default;
};
// Without what is biased: limits of contributions, a ray offset other than by error bounds, and photon maps.
inline Settings for_reference(Settings s) {
    s.clamp_direct = s.clamp_indirect = s.ray_epsilon = 0;
    s.caustics = Technique::off;
    return s;
}

struct Scene {
    Table<Mesh> meshes;
    Table<Image> images;
    Table<Texture> textures;
    Table<Material> materials;
    Table<Medium> media;
    Table<Group> groups;
    Table<Instance> instances;
    Table<Light> lights;
    Table<Camera> cameras;

    // Single items with a version each.
    template <class T>
    struct One {
        T value{};
        Version version = 0;
    };
    One<std::optional<Environment>> environment;
    One<Id<Camera>> active_camera;
    One<Film> film;
    One<Settings> settings;

    Version clock = 0; // of the latest change
    std::string format; // what it was imported from: "pbrt-v3", "pbrt-v4", "gltf", ...
};

} // namespace restage::scene
