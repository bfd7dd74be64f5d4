// SPDX-License-Identifier: Apache-2.0
// Tessellations: area, closedness, normals, orientation, uv; and shapes given by their vertices.
#include "mesh.hpp"
#include "pbrt_writer.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

using namespace restage::pbrt;
using restage::pbrt::test::MeshRecord;
using restage::pbrt::test::Recorder;
using std::numbers::pi;

namespace {

Recorder loaded(const std::string& world) {
    Recorder r;
    const int ok = r.load_text("WorldBegin\n" + world);
    INFO(r.error.message);
    REQUIRE(ok == 1);
    return r;
}

Vec3 vec(const std::vector<float>& from, std::size_t i) {
    return {double(from[3 * i]), double(from[3 * i + 1]), double(from[3 * i + 2])};
}

struct Measure {
    double area = 0, volume = 0; // volume: by the divergence theorem, > 0 when the winding is outward
    std::size_t open_edges = 0, against = 0;
};

// Edges are matched by position, since seams have vertices twice.
Measure measure(const MeshRecord& m) {
    Measure out;
    std::map<std::array<long, 3>, int> ids;
    std::vector<int> id;
    for (std::size_t i = 0; i < m.positions.size() / 3; ++i) {
        const Vec3 p = vec(m.positions, i);
        id.push_back(
            ids.emplace(std::array<long, 3>{std::lround(p.x * 1e5), std::lround(p.y * 1e5), std::lround(p.z * 1e5)},
                        int(ids.size()))
                .first->second);
    }
    std::map<std::pair<int, int>, int> edges;
    for (std::size_t t = 0; t < m.indices.size(); t += 3) {
        const Vec3 a = vec(m.positions, m.indices[t]), b = vec(m.positions, m.indices[t + 1]),
                   c = vec(m.positions, m.indices[t + 2]);
        const Vec3 n = cross(b - a, c - a);
        out.area += length(n) / 2;
        out.volume += dot(a, cross(b, c)) / 6;
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[{id[m.indices[t + k]], id[m.indices[t + (k + 1) % 3]]}];
            if (!m.normals.empty() && dot(vec(m.normals, m.indices[t + k]), n) <= 0) ++out.against;
        }
    }
    for (const auto& [edge, count] : edges)
        if (!edges.count({edge.second, edge.first})) ++out.open_edges;
    return out;
}

MeshRecord one(const std::string& shape) {
    const Recorder r = loaded("Shape " + shape);
    REQUIRE(r.meshes.size() == 1);
    return r.meshes[0];
}

} // namespace

TEST_CASE("pbrt shapes: spheres have the exact area, are closed, and face outwards", "[pbrt]") {
    for (const double radius : {1.0, 0.01, 250.0}) {
        const MeshRecord mesh = one("\"sphere\" \"float radius\" " + std::to_string(radius));
        const Measure m = measure(mesh);
        CHECK(m.area == Catch::Approx(4 * pi * radius * radius).epsilon(1e-6));
        CHECK(m.volume == Catch::Approx(4 * pi / 3 * std::pow(radius, 3)).epsilon(2e-3));
        if (radius == 1) CHECK(m.open_edges == 0);
        CHECK(m.against == 0);
        for (std::size_t i = 0; i < mesh.positions.size() / 3; ++i) {
            const Vec3 p = vec(mesh.positions, i), n = vec(mesh.normals, i);
            REQUIRE(length(n) == Catch::Approx(1).epsilon(1e-5));
            REQUIRE(dot(normalize(p), n) > 0.99999);
            // pbrt: u is phi / phimax, v runs from theta at zmin to theta at zmax
            const double v = double(mesh.uvs[2 * i + 1]);
            REQUIRE(std::abs(n.z - -std::cos(v * pi)) < 1e-5);
        }
        CHECK(mesh.primitive.find("sphere \"float radius\" [ ") == 0);
    }
}

TEST_CASE("pbrt shapes: parts of quadrics and their area", "[pbrt]") {
    struct {
        const char* line;
        double area;
    } shapes[] = {
        {"\"sphere\" \"float radius\" 2 \"float zmin\" -1 \"float zmax\" 0.5 \"float phimax\" 180", pi * 2 * 1.5},
        {"\"sphere\" \"float zmin\" 0.5 \"float zmax\" -0.5", 2 * pi}, // sorted
        {"\"disk\" \"float radius\" 2", 4 * pi},
        {"\"disk\" \"float radius\" 2 \"float innerradius\" 1 \"float height\" 3 \"float phimax\" 90", 0.75 * pi},
        {"\"cylinder\" \"float radius\" 0.5 \"float zmin\" -1 \"float zmax\" 3", 4 * pi},
        {"\"cone\" \"float radius\" 3 \"float height\" 4", pi * 3 * 5},
        {"\"paraboloid\" \"float radius\" 1 \"float zmin\" 0 \"float zmax\" 1", pi / 6 * (std::pow(5, 1.5) - 1)},
        {"\"hyperboloid\" \"point p1\" [ 1 0 0 ] \"point p2\" [ 1 0 2 ]", 4 * pi}, // a cylinder
    };
    for (const auto& shape : shapes) {
        INFO(shape.line);
        const Measure m = measure(one(shape.line));
        CHECK(m.area == Catch::Approx(shape.area).epsilon(2e-5));
        CHECK(m.against == 0);
    }
    const MeshRecord disk = one("\"disk\" \"float height\" 3");
    for (std::size_t i = 0; i < disk.normals.size() / 3; ++i) {
        CHECK(disk.normals[3 * i + 2] == 1);
        CHECK(disk.positions[3 * i + 2] == 3);
    }
    // Outward, as pbrt's dp/du x dp/dv: the divergence of a side wall is positive.
    CHECK(measure(one("\"cylinder\"")).volume > 0);
    CHECK(measure(one("\"cone\"")).volume > 0);
}

TEST_CASE("pbrt shapes: orientation of instances follows only ReverseOrientation", "[pbrt]") {
    // A triangle in the plane z = 0, wound counter-clockwise from +z, under a mirror. pbrt-v4: ng = cross(e1, e2) in
    // world space, flipped if ReverseOrientation xor handedness swaps. The host: M^-T (cross in object space), flipped
    // by the flag.
    for (const bool mirrored : {false, true})
        for (const bool reversed : {false, true}) {
            const Recorder r =
                loaded(std::string(mirrored ? "Scale -1 1 1 " : "") + (reversed ? "ReverseOrientation " : "") +
                       "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ]");
            const MeshRecord& mesh = r.meshes[0];
            Matrix to_world;
            std::copy(r.instances[0].raw.object_to_world, r.instances[0].raw.object_to_world + 16, to_world.m.begin());
            const auto world = [&](std::size_t i) {
                return transform_point(to_world, vec(mesh.positions, mesh.indices[i]));
            };
            Vec3 pbrt = cross(world(1) - world(0), world(2) - world(0));
            if (reversed != (determinant3(to_world) < 0)) pbrt = pbrt * -1;
            const auto object = [&](std::size_t i) { return vec(mesh.positions, mesh.indices[i]); };
            const Vec3 n = cross(object(1) - object(0), object(2) - object(0));
            const Matrix inv = *inverse(to_world);
            Vec3 ours{inv.at(0, 0) * n.x + inv.at(1, 0) * n.y + inv.at(2, 0) * n.z,
                      inv.at(0, 1) * n.x + inv.at(1, 1) * n.y + inv.at(2, 1) * n.z,
                      inv.at(0, 2) * n.x + inv.at(1, 2) * n.y + inv.at(2, 2) * n.z};
            if (r.instances[0].raw.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) ours = ours * -1;
            CHECK(dot(normalize(pbrt), normalize(ours)) == Catch::Approx(1));
        }
}

TEST_CASE("pbrt shapes: trianglemesh", "[pbrt]") {
    const Recorder r = loaded(
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] \"integer indices\" [ 0 1 2 2 1 3 ]\n"
        "\"normal N\" [ 0 0 1 0 0 1 0 0 1 0 0 1 ] \"float st\" [ 0 0 1 0 0 1 1 1 ] \"integer faceIndices\" [ 4 5 ] "
        "\"float foo\" 3\n"
        "Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"point2 uv\" [ 0 0 1 0 ] \"float alpha\" 0.25");
    CHECK(r.meshes[0].indices == std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3});
    CHECK(r.meshes[0].normals.size() == 12);
    CHECK(r.meshes[0].uvs == std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1});
    CHECK(r.meshes[0].primitive.empty());
    CHECK(r.reports("\"faceIndices\""));
    CHECK(r.reports("\"float foo\""));
    CHECK(r.instances[0].verbatim == "\"float foo\" [ 3 ]\n");
    CHECK(r.meshes[1].indices == std::vector<std::uint32_t>{0, 1, 2}); // v4: three vertices are a triangle
    CHECK(r.meshes[1].uvs.empty());
    CHECK(r.reports("2 entries for 3 vertices"));
    CHECK(r.instances[1].raw.alpha == 0.25f);
}

TEST_CASE("pbrt shapes: bilinear patches, flat and bent", "[pbrt]") {
    const MeshRecord flat = one("\"bilinearmesh\" \"point3 P\" [ 0 0 0 2 0 0 0 3 0 2 3 0 ]");
    CHECK(flat.indices.size() == 6);
    CHECK(measure(flat).area == Catch::Approx(6));
    CHECK(measure(flat).against == 0);
    CHECK(flat.normals[2] == 1);
    CHECK(flat.uvs == std::vector<float>{0, 0, 1, 0, 0, 1, 1, 1});
    // z = xy over the unit square: area = integral of sqrt(1 + x^2 + y^2) = 1.280789.
    const MeshRecord bent =
        one("\"bilinearmesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 1 1 1 ] \"integer indices\" [ 0 1 2 3 ]");
    CHECK(measure(bent).area == Catch::Approx(1.280789).epsilon(1e-3));
    CHECK(measure(bent).against == 0);
    for (std::size_t i = 0; i < bent.positions.size() / 3; ++i) {
        const Vec3 p = vec(bent.positions, i);
        CHECK(std::abs(p.z - p.x * p.y) < 1e-6);
    }
}

TEST_CASE("pbrt shapes: loop subdivision reaches the limit surface", "[pbrt]") {
    const std::string octahedron =
        "\"point3 P\" [ 1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1 ]\n"
        "\"integer indices\" [ 0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5 ]";
    const MeshRecord mesh = one("\"loopsubdiv\" \"integer levels\" 4 " + octahedron);
    CHECK(mesh.indices.size() / 3 == 8 * 256);
    const Measure m = measure(mesh);
    CHECK(m.open_edges == 0);
    CHECK(m.against == 0); // normals and faces agree,
    CHECK(m.volume < 0); // and point against the input's winding, as pbrt's do
    // A vertex of valence 4 of the octahedron: limit = (1 - 4 g) p, with g = 1 / (4 + 3 / (8 beta)), beta = 3/32.
    const double g = 1.0 / (4 + 3.0 / (8 * 3.0 / 32));
    double top = 0;
    for (std::size_t i = 0; i < mesh.positions.size() / 3; ++i)
        top = std::max(top, double(mesh.positions[3 * i + 2]));
    CHECK(top == Catch::Approx(1 - 4 * g).epsilon(1e-6));
    // Levels do not change the limit: the same vertex after one level.
    const MeshRecord coarse = one("\"loopsubdiv\" \"integer nlevels\" 1 " + octahedron);
    double coarse_top = 0;
    for (std::size_t i = 0; i < coarse.positions.size() / 3; ++i)
        coarse_top = std::max(coarse_top, double(coarse.positions[3 * i + 2]));
    CHECK(coarse_top == Catch::Approx(top).epsilon(1e-6));
    for (std::size_t i = 0; i < mesh.positions.size() / 3; ++i) {
        const Vec3 p = vec(mesh.positions, i), n = vec(mesh.normals, i);
        CHECK(length(n) == Catch::Approx(1).epsilon(1e-4));
        CHECK(dot(normalize(p), n) < -0.9); // smooth and round
    }
    // A flat sheet stays flat, and its straight borders straight.
    const MeshRecord sheet = one(
        "\"loopsubdiv\" \"integer levels\" 3 \"point3 P\" [ 0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0 0 2 0 1 2 0 2 2 0 ]\n"
        "\"integer indices\" [ 0 1 4 0 4 3 1 2 5 1 5 4 3 4 7 3 7 6 4 5 8 4 8 7 ]");
    CHECK(measure(sheet).against == 0);
    for (std::size_t i = 0; i < sheet.positions.size() / 3; ++i)
        CHECK(sheet.positions[3 * i + 2] == 0);
    for (std::size_t i = 0; i < sheet.normals.size() / 3; ++i)
        CHECK(std::abs(sheet.normals[3 * i + 2] + 1) < 1e-5f);
}

TEST_CASE("pbrt shapes: unknown shapes keep their place, flat ones are dropped", "[pbrt]") {
    const Recorder r = loaded(
        "Shape \"teapot\"\nScale 1 0 1 Shape "
        "\"sphere\"\nIdentity Shape \"sphere\"");
    CHECK(r.instances.size() == 2);
    CHECK(r.meshes.at(0).primitive == "missing Shape \"teapot\"");
    CHECK(r.reports("Shape \"teapot\": there is no such shape"));
    CHECK(r.reports("flattens it to nothing"));
    const Recorder h =
        loaded("Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" [ 0 1 2 3 4 5 ]\nWorldEnd");
    CHECK(h.meshes.at(0).indices.size() == 12);
    CHECK(h.meshes[0].positions[3 * 5 + 2] == 5);
}

TEST_CASE("pbrt shapes: nurbs", "[pbrt]") {
    // A quarter of a cylinder of radius 1 about z, exact with weights; v runs along z.
    const Recorder r = loaded(
        "Shape \"nurbs\" \"integer nu\" 3 \"integer uorder\" 3 \"float uknots\" [ 0 0 0 1 1 1 ]\n"
        "\"integer nv\" 2 \"integer vorder\" 2 \"float vknots\" [ 0 0 1 1 ]\n"
        "\"float Pw\" [ 1 0 0 1 1 1 0 1 0 2 0 2   1 0 3 1 1 1 3 1 0 2 6 2 ]\nWorldEnd");
    const auto& m = r.meshes.at(0);
    REQUIRE(m.positions.size() == 3 * 900);
    CHECK(m.indices.size() == 6 * 29 * 29);
    for (std::size_t i = 0; i < 900; ++i) {
        const float* p = &m.positions[3 * i];
        const float* n = &m.normals[3 * i];
        CHECK(std::abs(std::hypot(p[0], p[1]) - 1) < 1e-5f);
        CHECK(std::abs(n[0] - p[0]) + std::abs(n[1] - p[1]) + std::abs(n[2]) < 1e-5f); // du x dv: outward
    }
    CHECK(m.positions[3 * 899 + 1] == 1);
    CHECK(m.positions[3 * 899 + 2] == 3);
    CHECK(measure(m).against == 0);
    Recorder broken;
    CHECK(broken.load_text("Film \"image\"\nWorldBegin\nShape \"nurbs\" \"integer nu\" 3 \"integer uorder\" "
                           "4\nWorldEnd") == 0);
    CHECK(broken.error.message.find("uorder") != std::string::npos);
}
