// SPDX-License-Identifier: Apache-2.0
// Scenes and statistics shared by several tests of rendering.
#pragma once

#include "render/fixture.hpp"
#include "render/scene_builder.hpp"

#include <algorithm>

namespace restage::tests {

// Within 3 standard errors, and `relative` for the rounding of floats; and known to 2 %, else the first is meaningless.
inline void check_mean(const render::FilmImage& image, double expected, double relative = 2e-4) {
    const Mean m = mean_luminance(image);
    INFO("mean " << m.value << " +- " << m.std_error << ", expected " << expected << ", z "
                 << (m.value - expected) / std::max(m.std_error, 1e-12));
    CHECK(std::abs(m.value - expected) <= 3 * m.std_error + relative * std::abs(expected));
    CHECK(m.std_error < 0.02 * std::abs(expected) + 1e-9);
}
inline void check_same_mean(const render::FilmImage& a, const render::FilmImage& b) {
    const Mean x = mean_luminance(a), y = mean_luminance(b);
    const double error = std::hypot(x.std_error, y.std_error);
    INFO("means " << x.value << " +- " << x.std_error << " and " << y.value << " +- " << y.std_error << ", z "
                  << (x.value - y.value) / std::max(error, 1e-12));
    CHECK(std::abs(x.value - y.value) <= 3 * error + 2e-4 * std::abs(x.value));
    CHECK(error < 0.04 * std::abs(x.value) + 1e-9);
}

// A camera high above the origin that sees a tiny patch of the plane z = 0.
inline void look_down(SceneBuilder& b, glm::dvec3 eye = {0, 0, 10}) {
    b.set_film(16, 16);
    b.set_camera(eye, {0, 0, 0}, {0, 1, 0}, 0.05f);
}
inline scene::Id<scene::Instance> ground(SceneBuilder& b, float albedo) {
    return b.instance(b.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}),
                      b.diffuse(albedo, albedo, albedo));
}

// [-1,1]^3, normals outwards.
inline scene::Id<scene::Mesh> cube(SceneBuilder& b) {
    scene::MeshData m;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.f, 1.f}) {
            const auto first = std::uint32_t(m.positions.size());
            for (int k = 0; k < 4; ++k) {
                glm::vec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = k == 1 || k == 2 ? side : -side;
                p[(axis + 2) % 3] = k >= 2 ? 1.f : -1.f;
                m.positions.push_back(p);
                m.uvs.emplace_back(k == 1 || k == 2, k >= 2);
            }
            m.triangles.emplace_back(first, first + 1, first + 2);
            m.triangles.emplace_back(first, first + 2, first + 3);
        }
    return b.mesh(std::move(m), "cube");
}

inline glm::dmat4 placed(glm::dvec3 at, double scale = 1) {
    return glm::scale(glm::translate(glm::dmat4(1), at), glm::dvec3(scale));
}

template <class Change>
void edit_instance(SceneBuilder& b, scene::Id<scene::Instance> id, Change&& change) {
    auto instance = b.scene.instances[id];
    change(instance);
    b.scene.instances.set(id, instance, ++b.scene.clock);
}

inline scene::ParamSet numbers(std::initializer_list<std::pair<const char*, float>> values) {
    scene::ParamSet p;
    for (const auto& [id, v] : values)
        p.set(id, scene::Value::number(v));
    return p;
}

} // namespace restage::tests
