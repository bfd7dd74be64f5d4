// SPDX-License-Identifier: Apache-2.0
// Curves as triangles: their paths, widths and grouping.
#include "pbrt_writer.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>

using Catch::Approx;
using restage::pbrt::test::MeshRecord;
using restage::pbrt::test::Recorder;

namespace {

Recorder loaded(const std::string& text) {
    Recorder r;
    const int ok = r.load_text("Film \"rgb\"\nWorldBegin\n" + text);
    INFO(r.error.message << " line " << r.error.line);
    REQUIRE(ok == 1);
    return r;
}

struct V {
    double x, y, z;
};
V at(const std::vector<float>& v, std::size_t i) {
    return {double(v[3 * i]), double(v[3 * i + 1]), double(v[3 * i + 2])};
}
V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
V cross(V a, V b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

struct Figures {
    double area = 0;
    std::size_t against = 0; // triangles wound against their normals
};
Figures measure(const MeshRecord& m) {
    Figures f;
    for (std::size_t t = 0; t < m.indices.size(); t += 3) {
        const V a = at(m.positions, m.indices[t]);
        const V n = cross(at(m.positions, m.indices[t + 1]) - a, at(m.positions, m.indices[t + 2]) - a);
        f.area += std::sqrt(dot(n, n)) / 2;
        for (std::size_t k = 0; k < 3; ++k)
            f.against += dot(n, at(m.normals, m.indices[t + k])) < 0;
    }
    return f;
}

} // namespace

TEST_CASE("pbrt curves: a straight tube has the silhouette of its width", "[pbrt]") {
    for (const char* type : {"flat", "cylinder"}) {
        const Recorder r = loaded(
            "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 2 0 0 3 0 0 ] \"float width0\" 0.2 \"float "
            "width1\" 0.1 \"string type\" \"" +
            std::string(type) + "\"");
        REQUIRE(r.meshes.size() == 1);
        const Figures f = measure(r.meshes[0]);
        // Cauchy: the mean projected area of a convex body is a quarter of its surface; along the axis the mean width
        // is the perimeter over pi. So the surface is pi * width * length, except for the slant of the taper.
        CHECK(f.area == Approx(std::numbers::pi * 0.15 * 3).epsilon(1e-3));
        CHECK(f.against == 0);
        CHECK(r.meshes[0].indices.size() == 3 * 2 * 8); // straight: one piece
        CHECK(r.reports("Shape \"curve\": made into strips and tubes of 8 sides"));
    }
}

TEST_CASE("pbrt curves: every representation of a parabola gives the same strip", "[pbrt]") {
    // y = x^2 over [0, 1]: as quadratic and cubic Bezier, and as B-spline whose one segment it is.
    const std::string ribbon = " \"string type\" \"ribbon\" \"float width\" 0.1 \"normal N\" [ 0 0 1 0 0 1 ]\n";
    const std::string forms[] = {
        "\"integer degree\" 2 \"point3 P\" [ 0 0 0 .5 0 0 1 1 0 ]",
        "\"point3 P\" [ 0 0 0 .333333333333 0 0 .666666666667 .333333333333 0 1 1 0 ]",
        "\"integer degree\" 2 \"string basis\" \"bspline\" \"point3 P\" [ -.5 0 0 .5 0 0 1.5 2 0 ]",
        // cubic blossoms of (x, x^2) at (-2,-1,0) ... (1,2,3)
        "\"string basis\" \"bspline\" \"point3 P\" [ -1 .6666666666667 0 0 -.3333333333333 0 1 .6666666666667 0 2 "
        "3.6666666666667 0 ]"};
    for (const std::string& form : forms) {
        INFO(form);
        const Recorder r = loaded("Shape \"curve\" " + form + ribbon);
        REQUIRE(r.meshes.size() == 1);
        const MeshRecord& m = r.meshes[0];
        for (std::size_t i = 0; i + 1 < m.positions.size() / 3; i += 2) {
            const V a = at(m.positions, i), b = at(m.positions, i + 1);
            const double x = (a.x + b.x) / 2, y = (a.y + b.y) / 2;
            CHECK(y == Approx(x * x).margin(1e-6));
            CHECK(std::sqrt(dot(a - b, a - b)) == Approx(0.1).epsilon(1e-4));
            CHECK(a.z == Approx(0).margin(1e-7));
        }
        CHECK(at(m.positions, 0).x + at(m.positions, 1).x == Approx(0).margin(1e-6));
        const Figures f = measure(m);
        CHECK(f.against == 0);
        // Arc length of the parabola: (2 sqrt5 + asinh 2) / 4.
        CHECK(f.area == Approx(0.1 * (2 * std::sqrt(5.0) + std::asinh(2.0)) / 4).epsilon(2e-3));
    }
}

TEST_CASE("pbrt curves: those of one state become one object", "[pbrt]") {
    const std::string one = "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]\n";
    Recorder r = loaded("AttributeBegin\n" + one + "AttributeEnd\nAttributeBegin\nRotate 30 1 2 3\nScale 2 2 -2\n" +
                        one + "AttributeEnd\nAttributeBegin\nScale 1 2 1\n" + one +
                        "AttributeEnd\nMaterial \"conductor\"\n" + one + "ReverseOrientation\n" + one);
    REQUIRE(r.instances.size() == 4); // a different shear, material, orientation
    CHECK(r.meshes[0].indices.size() == 2 * r.meshes[1].indices.size());
    // Of two segments, in an object: twice the pieces, placed twice.
    r = loaded("ObjectBegin \"tuft\"\n" + one + one + "ObjectEnd\n" + one +
               "ObjectInstance \"tuft\"\nObjectInstance \"tuft\"\n");
    CHECK(r.instances.size() == 3);
    CHECK(r.meshes.size() == 2);
    CHECK(r.instances[0].name == "tuft");
    Recorder many;
    std::string text = "Film \"rgb\"\nWorldBegin\n";
    for (int i = 0; i < 20000; ++i)
        text +=
            "Shape \"curve\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 " + std::to_string(i) + " ] \"float width\" 0.001\n";
    REQUIRE(many.load_text(text) == 1);
    CHECK(many.meshes.size() == 1);
    CHECK(many.reports("of 3 sides, at most 100 % of their width off"));
}

TEST_CASE("pbrt curves: errors have their place", "[pbrt]") {
    const char* wrong[][2] = {
        {"\"point3 P\" [ 0 0 0 1 1 1 ]", "2 points"},
        {"\"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 0 0 0 ]", "5 points"},
        {"\"integer degree\" 4 \"point3 P\" [ 0 0 0 ]", "must be 2 or 3"},
        {"\"string type\" \"ribbon\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]", "0 normals"},
        {"\"float width\" -1 \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]", "widths"},
    };
    for (const auto& [params, message] : wrong) {
        Recorder r;
        // pbrt skips it and continues
        CHECK(r.load_text("Film \"rgb\"\nWorldBegin\nShape \"curve\" " + std::string(params)) == 1);
        INFO(r.all_reports());
        CHECK(r.reports(message));
        CHECK(r.lines.at(1).line == 3);
        REQUIRE(r.meshes.size() == 1);
        CHECK(r.meshes[0].primitive.starts_with("missing Shape \"curve\""));
    }
    const Recorder hairy = loaded("Shape \"curve\" \"string type\" \"hairy\" \"point3 P\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]");
    CHECK(hairy.reports("there is no type \"hairy\" of curves; cylinder is taken"));
    CHECK(hairy.meshes.size() == 1);
    // All points in one place: invisible, and no crash.
    CHECK(loaded("Shape \"curve\" \"point3 P\" [ 1 1 1 1 1 1 1 1 1 1 1 1 ]").meshes.size() == 1);
}
