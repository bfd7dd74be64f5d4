// SPDX-License-Identifier: Apache-2.0
// The scatter plugin: copies are distributed uniformly by area in world space, stand on the surface, keep their
// distance, and are the same for the same seed.
#include "document/actions.hpp"
#include "paths.hpp"
#include "scene_room.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>

using namespace restage;
using namespace restage::scene;
using Catch::Approx;
using Catch::Matchers::ContainsSubstring;

namespace {

struct Meadow { // a pin to scatter, and a surface
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log};
    test::Room room;
    Id<Instance> pin, ground;
    document::Session session{registry};
    io::ActionRun run;

    explicit Meadow(MeshData surface, const glm::dmat4& to_world = glm::dmat4(1)) {
        registry.scan(
            std::vector<plugin::SearchPath>{{restage::test::build_dir() / "lib" / "restage" / "plugins", true}});
        MeshData data; // a four-sided pin whose foot is its origin
        data.positions = {{-.1f, -.1f, 1}, {.1f, -.1f, 1}, {.1f, .1f, 1}, {-.1f, .1f, 1}, {0, 0, 0}};
        data.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
        compute_bounds(data);
        compute_bounds(surface);
        const auto shape = room.add(Mesh{.name = "pin", .data = std::make_shared<MeshData>(data)});
        pin = room.add(Instance{.name = "pin", .mesh = shape, .material = room.oak});
        const auto floor = room.add(Mesh{.name = "ground", .data = std::make_shared<MeshData>(std::move(surface))});
        ground =
            room.add(Instance{.name = "ground", .mesh = floor, .material = room.steel, .object_to_world = to_world});
        session.adopt(room.scene);
        run.selection = {pin, ground};
        set("up", Value::choice("z"));
    }
    void set(const char* id, Value value) { run.values.set(id, std::move(value)); }
    Result<document::ActionDone> scatter() { return document::run_action(session, "scatter", run); }
    std::vector<glm::dmat4> copies() {
        const auto done = scatter();
        REQUIRE(done);
        std::vector<glm::dmat4> places;
        for (const Id<Instance> id : done->selection)
            places.push_back(session.scene().instances[id].object_to_world);
        return places;
    }
    std::string refusal() {
        const Version before = session.version();
        const auto done = scatter();
        REQUIRE(!done);
        CHECK(session.version() == before);
        return done.error().message;
    }
};

// The unit square in strips of very different widths, and triangles without area.
MeshData strips() {
    MeshData data;
    const std::uint32_t n = 20;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (const float y : {0.f, 1.f})
            data.positions.push_back({std::pow(float(i) / float(n), 3.f), y, 0});
    for (std::uint32_t i = 0; i < n; ++i) {
        data.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
        data.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
        data.triangles.push_back({2 * i, 2 * i, 2 * i + 1});
    }
    return data;
}

MeshData ball(std::uint32_t rings, std::uint32_t sides) {
    MeshData data;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t k = 0; k < sides; ++k) {
            const double theta = M_PI * i / rings, phi = 2 * M_PI * k / sides;
            data.positions.push_back(
                glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
        }
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t k = 0; k < sides; ++k) {
            const std::uint32_t a = i * sides + k, b = i * sides + (k + 1) % sides;
            data.triangles.push_back({a, a + sides, b});
            data.triangles.push_back({b, a + sides, b + sides});
        }
    return data;
}

// Pearson's statistic, in standard deviations above its mean (which is the degrees of freedom).
double excess(const std::vector<double>& seen, const std::vector<double>& expected) {
    double chi2 = 0;
    for (std::size_t i = 0; i < seen.size(); ++i)
        chi2 += (seen[i] - expected[i]) * (seen[i] - expected[i]) / expected[i];
    const double freedom = double(seen.size()) - 1;
    return (chi2 - freedom) / std::sqrt(2 * freedom);
}

} // namespace

TEST_CASE("scattered copies are uniform over a mirrored, sheared surface", "[action][scatter]") {
    glm::dmat4 to_world = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3));
    to_world = to_world * glm::dmat4(-3, 0.5, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1);
    for (const int seed : {1, 2, 77}) {
        Meadow m(strips(), to_world);
        m.set("count", Value::integer(20000));
        m.set("seed", Value::integer(seed));
        constexpr int cells = 16;
        std::vector<double> seen(cells * cells), expected(cells * cells, 20000.0 / (cells * cells));
        const glm::dmat4 back = glm::inverse(to_world);
        for (const glm::dmat4& place : m.copies()) {
            const glm::dvec4 at = back * place[3];
            REQUIRE(std::abs(at.z) < 1e-9);
            REQUIRE((at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1));
            ++seen[std::size_t(int(at.x * cells) * cells + int(at.y * cells))];
        }
        INFO("seed " << seed);
        CHECK(excess(seen, expected) < 4);
        CHECK(excess(seen, expected) > -4); // nor too regular
    }
}

TEST_CASE("scattered copies are on triangles in proportion to world-space area, on their outside",
          "[action][scatter]") {
    const bool mirrored = GENERATE(false, true);
    const glm::dmat4 to_world = glm::scale(glm::dmat4(1), glm::dvec3(1, 2, mirrored ? -4 : 4));
    const MeshData mesh = ball(6, 10);
    std::vector<glm::dvec3> normals;
    std::vector<double> areas;
    double whole = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const auto corner = [&](std::uint32_t i) { return glm::dvec3(to_world * glm::dvec4(mesh.positions[i], 1)); };
        const glm::dvec3 n = glm::cross(corner(t.y) - corner(t.x), corner(t.z) - corner(t.x));
        if (glm::length(n) < 1e-6) continue; // at the poles
        const glm::dvec3 middle = corner(t.x) + corner(t.y) + corner(t.z);
        normals.push_back(glm::normalize(glm::dot(n, middle) > 0 ? n : -n)); // outwards: it is convex
        areas.push_back(glm::length(n) / 2), whole += areas.back();
    }
    Meadow m(mesh, to_world);
    m.set("count", Value::integer(20000));
    std::vector<double> seen(areas.size());
    for (const glm::dmat4& place : m.copies()) {
        const glm::dvec3 up = glm::normalize(glm::dvec3(place[2]));
        std::size_t best = 0;
        for (std::size_t i = 1; i < normals.size(); ++i)
            if (glm::dot(up, normals[i]) > glm::dot(up, normals[best])) best = i;
        REQUIRE(glm::dot(up, normals[best]) > 1 - 1e-9);
        ++seen[best];
    }
    // Two triangles of a quad may lie in one plane: their areas are taken together.
    std::vector<double> sums, expected;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        bool first = true;
        for (std::size_t k = 0; k < i; ++k)
            first &= glm::dot(normals[i], normals[k]) < 1 - 1e-9;
        if (!first) continue;
        sums.push_back(0), expected.push_back(0);
        for (std::size_t k = i; k < normals.size(); ++k)
            if (glm::dot(normals[i], normals[k]) >= 1 - 1e-9)
                sums.back() += seen[k], expected.back() += 20000 * areas[k] / whole;
    }
    CHECK(excess(sums, expected) < 4);
}

TEST_CASE("scattered copies keep their distance, and it is reported if no more fit", "[action][scatter]") {
    Meadow m(strips(), glm::scale(glm::dmat4(1), glm::dvec3(10, 10, 1)));
    m.set("distance", Value::number(0.2f));
    m.set("count", Value::integer(500));
    m.set("scale_min", Value::number(1)), m.set("scale_max", Value::number(1));
    const auto places = m.copies();
    CHECK(places.size() == 500);
    double least = 1e9;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            least = std::min(least, glm::distance(glm::dvec3(places[i][3]), glm::dvec3(places[k][3])));
    CHECK(least >= double(0.2f));
    CHECK(least < 0.3);
    m.set("count", Value::integer(10000));
    const auto full = m.scatter();
    REQUIRE(full);
    // Random sequential packing of disks covers 0.547 of the plane (E. Hinrichsen et al. 1986): 1741 of radius 0.1
    // at the limit, and a little more as the border is open.
    CHECK(full->selection.size() > 1400);
    CHECK(full->selection.size() < 1900);
    REQUIRE(full->report.count(io::Fate::approximated) == 1);
    CHECK_THAT(io::to_string(full->report.entries.back()), ContainsSubstring("no more fit"));
}

TEST_CASE("scattered copies obey scale, rotation, tilt, slope, offset, density and groups", "[action][scatter]") {
    Meadow m(ball(24, 48), glm::scale(glm::dmat4(1), glm::dvec3(5)));
    m.set("count", Value::integer(300));
    m.set("scale_min", Value::number(0.5f)), m.set("scale_max", Value::number(2));
    SECTION("upright, rotated, tilted") {
        m.set("align", Value::choice("up"));
        m.set("rotation", Value::number(30));
        m.set("tilt", Value::number(10));
        double least = 9, most = 0, leaning = 1;
        for (const glm::dmat4& place : m.copies()) {
            const double scale = glm::length(glm::dvec3(place[2]));
            least = std::min(least, scale), most = std::max(most, scale);
            CHECK(std::cbrt(glm::determinant(glm::dmat3(place))) == Approx(scale)); // uniform, not mirrored
            leaning = std::min(leaning, place[2].z / scale);
            CHECK(place[0].x / scale > std::cos(glm::radians(42.0)));
        }
        CHECK(least > 0.499);
        CHECK(least < 0.6);
        CHECK(most < 2.001);
        CHECK(most > 1.9);
        CHECK(leaning >= std::cos(glm::radians(10.01)));
        CHECK(leaning < std::cos(glm::radians(9.0)));
    }
    SECTION("none on steep parts, and the same density on the rest") {
        m.set("slope", Value::number(45)); // between two rings of triangles
        m.set("amount", Value::choice("density"));
        m.set("density", Value::number(2));
        const auto places = m.copies();
        for (const glm::dmat4& place : places)
            CHECK(place[2].z / glm::length(glm::dvec3(place[2])) >= std::cos(glm::radians(45.0)));
        // A cap of 45 degrees, of density 2; triangles are a little smaller.
        CHECK(double(places.size()) == Approx(2 * 2 * M_PI * 25 * (1 - std::cos(glm::radians(45.0)))).epsilon(0.02));
    }
    SECTION("on the surface, or above it, by its lowest point") {
        // The source is elsewhere, and its origin is at its centre.
        glm::dmat4 there = glm::translate(glm::dmat4(1), glm::dvec3(100, 50, 7));
        there = glm::scale(there, glm::dvec3(-1, 1, 1));
        REQUIRE(m.session.edit(set_transform(m.session.scene(), m.pin, there)));
        m.set("offset", Value::number(0.25f));
        for (const glm::dmat4& place : m.copies()) {
            const glm::dvec3 foot = place[3];
            CHECK(glm::length(foot) == Approx(5.25).epsilon(0.01)); // chords of the ball are a little inside
            CHECK(glm::determinant(glm::dmat3(place)) < 0);          // mirrored like its original
        }
    }
    SECTION("a new group; a source of several parts stays together") {
        m.run.selection = {m.room.chair, m.room.chair2, m.pin, m.ground};
        const auto done = m.scatter();
        REQUIRE(done);
        const Scene& s = m.session.scene();
        std::map<std::uint32_t, int> parts;
        Id<Group> all;
        for (const Id<Instance> id : done->selection) {
            const Instance& i = s.instances[id];
            const bool chair = i.mesh == m.room.mesh;
            if (chair) ++parts[i.group.value];
            all = chair ? s.groups[i.group].parent : i.group;
            CHECK(s.groups[all].name == "scattered chairs");
        }
        CHECK(parts.size() > 100); // one group per copy of the two chairs
        for (const auto& [group, count] : parts)
            CHECK(count == 2);
        m.set("group", Value::boolean(false));
        m.run.selection = {m.pin, m.ground};
        const auto loose = m.scatter();
        REQUIRE(loose);
        CHECK(!m.session.scene().instances[loose->selection[0]].group);
        REQUIRE(m.session.undo());
        REQUIRE(m.session.undo());
        CHECK(m.session.scene().instances.live() == m.room.scene.instances.live());
    }
}

TEST_CASE("the same seed scatters the same copies, on any machine", "[action][scatter]") {
    const auto bytes = [](int seed) {
        Meadow m(ball(6, 10));
        m.set("count", Value::integer(200));
        m.set("tilt", Value::number(25));
        m.set("seed", Value::integer(seed));
        std::string all;
        for (const glm::dmat4& place : m.copies())
            all.append(reinterpret_cast<const char*>(&place[0][0]), sizeof place);
        return all;
    };
    CHECK(bytes(1) == bytes(1));
    CHECK(bytes(1) != bytes(2));
}

TEST_CASE("scatter reports impossible requests", "[action][scatter]") {
    Meadow m(strips());
    m.run.selection = {m.ground};
    CHECK_THAT(m.refusal(), ContainsSubstring("at least two objects"));
    m.run.selection = {};
    CHECK_THAT(m.refusal(), ContainsSubstring("nothing is selected"));
    m.run.selection = {m.pin, m.ground};
    m.set("amount", Value::choice("density"));
    m.set("density", Value::number(1e6f));
    CHECK_THAT(m.refusal(), ContainsSubstring("lower the density"));
    m.set("amount", Value::choice("count"));
    m.set("side", Value::choice("back"));
    m.set("slope", Value::number(20));
    CHECK_THAT(m.refusal(), ContainsSubstring("faces the other way"));
    Meadow ball_of_pbrt(ball(6, 10));
    REQUIRE(
        ball_of_pbrt.session.edit(modify(ball_of_pbrt.session.scene(), ball_of_pbrt.session.find<Mesh>("ground"),
                                         "change", [](Mesh& mesh) { mesh.primitive = "sphere \"float radius\" 1"; })));
    CHECK_THAT(ball_of_pbrt.refusal(), ContainsSubstring("is a sphere"));
    MeshData flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    flat.triangles = {{0, 1, 2}};
    Meadow line(flat);
    CHECK_THAT(line.refusal(), ContainsSubstring("has no area"));
}
