// SPDX-License-Identifier: Apache-2.0
#include "scenes.hpp"

#include "render/scene_builder.hpp"

#include <cmath>

namespace restage::bench {

using namespace scene;
using glm::dmat4;
using glm::dvec3;
using glm::vec3;
using tests::SceneBuilder;

namespace {

class Builder : public SceneBuilder {
  public:
    Builder(std::uint32_t size, std::uint32_t bounces) {
        set_film(size, size);
        scene.settings.value.max_depth = bounces;
    }
    void look(dvec3 eye, dvec3 at, float fov) {
        const dvec3 f = glm::normalize(at - eye), r = glm::normalize(glm::cross(f, dvec3(0, 1, 0)));
        Camera camera{.name = "camera", .fov = fov};
        camera.camera_to_world =
            dmat4(glm::dvec4(r, 0), glm::dvec4(glm::cross(r, f), 0), glm::dvec4(f, 0), glm::dvec4(eye, 1));
        const auto id = scene.cameras.next();
        scene.cameras.set(id, camera, ++scene.clock);
        scene.active_camera = {id, scene.clock};
    }
    // Corner p, edges u and v; the normal is u x v.
    Id<Mesh> rectangle(vec3 p, vec3 u, vec3 v) { return quad(p, p + u, p + u + v, p + v); }
    // A copy whose vertices are transformed.
    Id<Mesh> moved(Id<Mesh> of, const dmat4& transform) {
        MeshData m = *scene.meshes[of].data;
        for (vec3& p : m.positions)
            p = dvec3(transform * glm::dvec4(p, 1));
        return mesh(std::move(m), "sphere");
    }
    // A cube's six faces, cells x cells squares each, pushed onto the unit sphere and displaced. No normals, no uvs.
    Id<Mesh> displaced_sphere(std::uint32_t cells, bool displace) {
        MeshData m;
        for (int face = 0; face < 6; ++face) {
            const int axis = face / 2;
            const float side = face % 2 ? 1.f : -1.f;
            const auto first = std::uint32_t(m.positions.size());
            for (std::uint32_t i = 0; i <= cells; ++i)
                for (std::uint32_t j = 0; j <= cells; ++j) {
                    // equal angles: cells of about equal size
                    const auto angle = [&](std::uint32_t k) {
                        return std::tan((2.f * float(k) / float(cells) - 1.f) * 0.785398163f);
                    };
                    vec3 d;
                    d[axis] = side;
                    d[(axis + 1) % 3] = angle(i);
                    d[(axis + 2) % 3] = side * angle(j);
                    m.positions.push_back(displaced(glm::normalize(d), displace));
                    if (i == cells || j == cells) continue;
                    const std::uint32_t a = first + i * (cells + 1) + j, b = a + cells + 1;
                    m.triangles.emplace_back(a, b, b + 1);
                    m.triangles.emplace_back(a, b + 1, a + 1);
                }
        }
        return mesh(std::move(m), "sphere");
    }

  private:
    // Lumps, ripples and grain: three octaves of products of sines.
    static vec3 displaced(vec3 d, bool displace) {
        if (!displace) return d;
        const auto wave = [&](vec3 f, vec3 phase) {
            return std::sin(f.x * d.x + phase.x) * std::sin(f.y * d.y + phase.y) * std::sin(f.z * d.z + phase.z);
        };
        return d * (1.f + 0.1f * wave({4, 5, 4.5f}, {0.3f, 1, 2}) + 0.02f * wave({19, 17, 21}, vec3(0)) +
                    0.004f * wave({61, 57, 59}, vec3(0)));
    }
};

dmat4 place(dvec3 at, dvec3 scale, double turn = 0) {
    return glm::scale(glm::rotate(glm::translate(dmat4(1), at), turn, dvec3(0, 1, 0)), scale);
}

ParamSet metal(float eta, float k, float alpha) {
    ParamSet p;
    p.set("eta", Value::color(eta, eta, eta));
    p.set("k", Value::color(k, k, k));
    p.set("uroughness", Value::number(alpha));
    p.set("vroughness", Value::number(alpha));
    p.set("remap", Value::choice("none"));
    return p;
}

} // namespace

Scene room(std::uint32_t bounces, bool flat) {
    Builder b(512, bounces);
    b.look({-1.2, 2.9, 3.8}, {0.3, 0.6, -1}, 62);
    const auto white = b.diffuse(.75f, .75f, .75f), black = b.diffuse(0, 0, 0);
    b.instance(b.rectangle({-5, 0, 4}, {10, 0, 0}, {0, 0, -8}), b.diffuse(.45f, .45f, .45f));
    b.instance(b.rectangle({-5, 4, -4}, {10, 0, 0}, {0, 0, 8}), white);
    b.instance(b.rectangle({-5, 0, -4}, {10, 0, 0}, {0, 4, 0}), white);
    b.instance(b.rectangle({5, 0, 4}, {-10, 0, 0}, {0, 4, 0}), white);
    b.instance(b.rectangle({-5, 0, 4}, {0, 0, -8}, {0, 4, 0}), b.diffuse(.65f, .4f, .3f));
    b.instance(b.rectangle({5, 0, -4}, {0, 0, 8}, {0, 4, 0}), b.diffuse(.3f, .4f, .6f));
    const Emission lamp{.radiance = vec3(9)};
    b.instance(b.rectangle({-3.2f, 3.99f, -1.2f}, {1.6f, 0, 0}, {0, 0, 1.6f}), black, dmat4(1), lamp);
    b.instance(b.rectangle({1.6f, 3.99f, -.4f}, {1.6f, 0, 0}, {0, 0, 1.6f}), black, dmat4(1), lamp);

    ParamSet glass;
    glass.set("eta", Value::number(1.5f));
    const Id<Material> look[4] = {b.diffuse(.7f, .4f, .15f), b.material("conductor", metal(2, 4, .2f)),
                                  b.diffuse(.2f, .35f, .6f), b.material("dielectric", glass)};
    const auto sphere = b.displaced_sphere(129, true);
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 4; ++j) {
            const int k = i * 4 + j;
            const double size = .52 + .05 * ((k * 7) % 5);
            const dmat4 at = place({-3.4 + 1.7 * i, size * 1.05, -2.9 + 1.55 * j}, dvec3(size), k * 1.3);
            if (flat)
                b.instance(b.moved(sphere, at), look[(i + j) % 4]);
            else
                b.instance(sphere, look[(i + j) % 4], at);
        }
    return std::move(b.scene);
}

Scene cornell() {
    Builder b(512, 5);
    b.look({0, 0, 3.9}, {0, 0, 0}, 39.3f);
    const auto white = b.diffuse(.7f, .7f, .7f);
    b.instance(b.rectangle({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}), white);
    b.instance(b.rectangle({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}), white);
    b.instance(b.rectangle({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), white);
    b.instance(b.rectangle({-1, -1, 1}, {0, 0, -2}, {0, 2, 0}), b.diffuse(.6f, .15f, .12f));
    b.instance(b.rectangle({1, -1, -1}, {0, 0, 2}, {0, 2, 0}), b.diffuse(.15f, .5f, .12f));
    b.instance(b.rectangle({-.25f, .995f, -.25f}, {.5f, 0, 0}, {0, 0, .5f}), b.diffuse(0, 0, 0), dmat4(1),
               Emission{.radiance = vec3(16)});
    MeshData box;
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.f, 1.f}) {
            vec3 n(0), u(0);
            n[axis] = side;
            u[(axis + 1) % 3] = 1;
            const vec3 v = glm::cross(n, u);
            const auto first = std::uint32_t(box.positions.size());
            for (const vec3& p : {n - u - v, n + u - v, n + u + v, n - u + v})
                box.positions.push_back(p);
            box.triangles.emplace_back(first, first + 1, first + 2);
            box.triangles.emplace_back(first, first + 2, first + 3);
        }
    const auto cube = b.mesh(std::move(box), "box");
    b.instance(cube, white, place({.335, -.7, .38}, dvec3(.3), -.3));
    b.instance(cube, white, place({-.33, -.39, -.28}, {.3, .61, .3}, .32));
    return std::move(b.scene);
}

Scene crowd(std::uint32_t count, std::uint32_t cells, std::vector<Id<Instance>>& spheres) {
    Builder b(512, 5);
    const int side = int(std::ceil(std::sqrt(double(count))));
    b.look({0, side * 0.6, side * 0.9}, {0, 0, 0}, 50);
    b.environment(vec3(0.5f));
    const float half = float(side) * 0.6f;
    b.instance(b.rectangle({-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}), b.diffuse(.5f, .5f, .5f));
    b.instance(b.rectangle({-1, half, -1}, {2, 0, 0}, {0, 0, 2}), b.diffuse(0, 0, 0), dmat4(1),
               Emission{.radiance = vec3(50)});
    ParamSet glass;
    glass.set("eta", Value::number(1.5f));
    const Id<Material> look[4] = {b.diffuse(.7f, .4f, .15f), b.material("conductor", metal(2, 4, .2f)),
                                  b.diffuse(.2f, .35f, .6f), b.material("dielectric", glass)};
    const auto sphere = b.displaced_sphere(cells, true);
    for (std::uint32_t k = 0; k < count; ++k)
        spheres.push_back(b.instance(
            sphere, look[k % 4],
            place({double(int(k) % side) - side * .5, .4, double(int(k) / side) - side * .5}, dvec3(.35), k)));
    return std::move(b.scene);
}

Scene lamp_field(std::uint32_t count, std::vector<Id<Instance>>& lamps) {
    Builder b(64, 3);
    const int side = int(std::ceil(std::sqrt(double(count))));
    b.look({0, side * 0.3, side * 0.6}, {0, 0, 0}, 50);
    const float half = float(side) * 0.6f;
    b.instance(b.rectangle({-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}), b.diffuse(.5f, .5f, .5f));
    const auto lamp = b.rectangle({-.05f, 0, -.05f}, {.1f, 0, 0}, {0, 0, .1f});
    const auto black = b.diffuse(0, 0, 0);
    for (std::uint32_t k = 0; k < count; ++k)
        lamps.push_back(
            b.instance(lamp, black,
                       glm::translate(dmat4(1), dvec3(int(k) % side - side * .5, 1 + k % 5, int(k) / side - side * .5)),
                       Emission{.radiance = vec3(float(1 + k % 7))}));
    return std::move(b.scene);
}

} // namespace restage::bench
