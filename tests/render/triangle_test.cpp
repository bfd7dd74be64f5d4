// SPDX-License-Identifier: Apache-2.0
// Triangles by solid angle, and lamps sampled by what they send to a surface, against double precision.
#include "kernel_lab.hpp"
#include "render/checks.hpp"
#include "render/light_table.hpp"
#include "render/scene_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

using Corners = std::array<glm::dvec3, 3>;

double solid_angle(const glm::dvec3& p, const Corners& corners) {
    const glm::dvec3 a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
                          la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
}

struct Seen {
    glm::vec3 corner, b, c, p;
    glm::vec2 u;
    glm::dvec3 at(double x, double y) const { return glm::dvec3(corner) + x * glm::dvec3(b) + y * glm::dvec3(c); }
    double part(double x0, double y0, double x1, double y1, double x2, double y2) const {
        return solid_angle(glm::dvec3(p), {at(x0, y0), at(x1, y1), at(x2, y2)});
    }
    double whole() const { return part(0, 0, 1, 0, 0, 1); }
};
struct Answer {
    float solid_angle;
    glm::vec2 place, again;
};

// Triangles of all shapes, sizes and distances.
Seen random_view(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1, 1);
    const auto vector = [&] { return glm::vec3(unit(random), unit(random), unit(random)); };
    Seen s{};
    const float scale = std::pow(10.f, 4 * unit(random));
    s.corner = scale * vector();
    s.b = scale * vector() * std::pow(10.f, unit(random));
    s.c = scale * vector() * std::pow(10.f, unit(random));
    s.p = scale * vector() * std::pow(10.f, unit(random));
    s.u = {0.5f + 0.5f * unit(random), 0.5f + 0.5f * unit(random)};
    return s;
}

bool by_angle(double angle) { return angle >= 1e-2 && angle <= 6.22; }

std::vector<Answer> ask(const std::vector<Seen>& seen) {
    return lab().run<Answer, Seen>(
        "#include \"lib/triangle.glsl\"\nstruct Seen { vec3 corner, b, c, p; vec2 u; };\n"
        "struct Answer { float solid_angle; vec2 place, again; };",
        "Seen", "Answer",
        "TriangleView v = triangle_view(x.corner, x.b, x.c, x.p); result.solid_angle = v.solid_angle;"
        "result.place = triangle_sample(v, x.u); result.again = triangle_invert(v, result.place);",
        seen);
}

double chi_square(const std::vector<double>& count, const std::vector<double>& expected, int& degrees) {
    double chi = 0, rest = 0, rest_count = 0;
    degrees = 0;
    for (std::size_t k = 0; k < count.size(); ++k) {
        rest += expected[k];
        rest_count += count[k];
        if (rest < 20) continue;
        chi += (rest_count - rest) * (rest_count - rest) / rest;
        ++degrees;
        rest = rest_count = 0;
    }
    return chi;
}

} // namespace

TEST_CASE("triangles: the solid angle agrees with double precision, and each point leads back to its numbers") {
    std::mt19937 random(14);
    std::vector<Seen> seen;
    for (int i = 0; i < 40000; ++i)
        seen.push_back(random_view(random));
    const auto answers = ask(seen);
    double worst = 0;
    std::vector<double> away;
    std::size_t outside = 0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const double right = seen[i].whole();
        if (!by_angle(right)) continue;
        const Answer& a = answers[i];
        worst = std::max(worst, std::abs(a.solid_angle - right) / right);
        outside += !(a.place.x >= 0 && a.place.y >= 0 && a.place.x + a.place.y <= 1.000001f);
        away.push_back(double(glm::length(a.again - seen[i].u)));
    }
    REQUIRE(away.size() > 5000);
    std::ranges::sort(away);
    INFO("worst relative error " << worst << ", numbers off by " << away[away.size() / 2] << ", 1 % by more than "
                                 << away[away.size() / 100 * 99]);
    CHECK(worst < 2e-3);
    CHECK(outside == 0);
    CHECK(away[away.size() / 2] < 1e-5);
    CHECK(away[away.size() / 100 * 99] < 2e-3);
}

TEST_CASE("triangles: points are uniform in solid angle") {
    std::mt19937 random(15);
    std::uniform_real_distribution<float> unit(0, 1);
    constexpr int cells = 8, draws = 1 << 15; // rows of triangles along the edges
    double sum = 0;
    int views = 0;
    while (views < 24) {
        const Seen view = random_view(random);
        const double whole = view.whole();
        if (!by_angle(whole)) continue;
        ++views;
        std::vector<Seen> seen(draws, view);
        for (Seen& s : seen)
            s.u = {unit(random), unit(random)};
        std::vector<double> count(2 * cells * cells), expected(count.size());
        for (const Answer& a : ask(seen)) {
            const double x = std::min(double(a.place.x), 0.999999) * cells,
                         y = std::min(double(a.place.y), 0.999999) * cells;
            const bool upper = x - std::floor(x) + y - std::floor(y) > 1;
            ++count[std::size_t((int(y) * cells + int(x)) * 2 + upper)];
        }
        for (int k = 0; k < cells * cells; ++k) {
            const double n = cells, x = k % cells, y = k / cells; // NOLINT(bugprone-integer-division): a row
            const double scale = draws / whole;
            if (x + y < n)
                expected[2 * std::size_t(k)] = scale * view.part(x / n, y / n, (x + 1) / n, y / n, x / n, (y + 1) / n);
            if (x + y + 1 < n)
                expected[2 * std::size_t(k) + 1] =
                    scale * view.part((x + 1) / n, y / n, x / n, (y + 1) / n, (x + 1) / n, (y + 1) / n);
        }
        int degrees = 0;
        const double chi = chi_square(count, expected, degrees);
        INFO("solid angle " << whole << ": chi-square " << chi << " of " << degrees);
        CHECK(chi < degrees + 6 * std::sqrt(2.0 * degrees) + 6);
        sum += (chi - degrees) / std::sqrt(2.0 * degrees);
    }
    CHECK(std::abs(sum) < 4 * std::sqrt(double(views)));
}

namespace {

struct Ask {
    glm::vec3 p;
    std::uint32_t normal; // receiver_bits
    glm::uvec2 bits;
    std::uint32_t pick;
};
struct Drawn {
    glm::vec3 wi;
    float dist, pdf;
    float again; // lamp_density of that point
};

// A lamp of its own, two-sided.
class Lamp {
  public:
    Lamp(std::vector<glm::vec3> positions, std::vector<glm::uvec3> triangles)
        : positions_(positions), triangles_(triangles) {
        scene::MeshData mesh;
        mesh.positions = std::move(positions);
        mesh.triangles = std::move(triangles);
        SceneBuilder b;
        b.instance(b.mesh(std::move(mesh)), b.diffuse(0, 0, 0), glm::dmat4(1), scene::Emission{glm::vec3(1), true});
        table_ = render::make_light_table(
            b.scene, glm::dvec3(0), glm::vec3(0), [&](scene::Id<scene::Instance>) -> std::optional<render::Emitter> {
                return render::Emitter{.radiance = glm::vec3(1), .two_sided = true, .mean = {}};
            });
        lights_ = upload<shared::LightData>(table_.lights);
        cdf_ = upload<shared::CdfEntry>(table_.cdf);
        nodes_ = upload<shared::LightNode>(table_.nodes);
    }
    const render::LightTable& table() const { return table_; }
    const std::vector<glm::vec3>& positions() const { return positions_; }

    std::vector<Drawn> draw(const std::vector<Ask>& asks) const {
        return lab().run<Drawn, Ask>(
            "#include \"lib/light.glsl\"\nstruct Ask { vec3 p; uint normal; uvec2 bits; uint pick; };\n"
            "struct Drawn { vec3 wi; float dist, pdf, again; };",
            "Ask", "Drawn",
            fmt::format(
                "SceneData scene; scene.lights = {}ul; scene.light_cdf = {}ul; scene.light_nodes = {}ul;"
                "Receiver to = receiver_at(x.p, x.normal); LightSample s = light_sample(scene, to, x.pick, x.bits);"
                "result.wi = s.wi; result.dist = s.dist; result.pdf = s.pdf; LightData l = load_light(scene.lights, "
                "0u);"
                "result.again = lamp_density(l, to, x.p + s.wi * s.dist, s.dist,"
                " abs(dot(s.wi, normalize(cross(l.b, l.c)))));",
                lights_.address(), cdf_.address(), nodes_.address()),
            asks);
    }
    // Irradiance with nothing between, of a radiance of 1. All corners must be above the horizon. Lambert 1760
    double irradiance(const glm::dvec3& p, const glm::dvec3& n) const {
        double sum = 0;
        for (const glm::uvec3& t : triangles_) {
            double one = 0;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 a = glm::normalize(glm::dvec3(positions_[t[k]]) - p);
                const glm::dvec3 b = glm::normalize(glm::dvec3(positions_[t[(k + 1) % 3]]) - p);
                const glm::dvec3 across = glm::cross(a, b);
                const double sine = glm::length(across);
                if (sine > 0) one += std::atan2(sine, glm::dot(a, b)) / sine * glm::dot(n, across);
            }
            sum += 0.5 * std::abs(one);
        }
        return sum;
    }

  private:
    template <class T>
    static gpu::Buffer upload(std::span<const T> values) {
        auto buffer = lab().device().create_buffer_of<T>(values, "test data");
        REQUIRE(buffer);
        return std::move(*buffer);
    }
    std::vector<glm::vec3> positions_;
    std::vector<glm::uvec3> triangles_;
    render::LightTable table_;
    gpu::Buffer lights_, cdf_, nodes_;
};

std::vector<Lamp> lamps(float size) {
    const glm::vec3 o(0.3f, -0.2f, 0.4f), u(1.1f, 0.2f, -0.1f), w(-0.4f, 0.9f, 0.6f);
    const glm::vec3 v = 0.7f * glm::normalize(glm::cross(u, w)); // at a right angle to u
    std::vector<Lamp> all;
    all.push_back({{size * o, size * (o + u), size * (o + w)}, {{0, 1, 2}}});
    all.push_back({{size * o, size * (o + u), size * (o + u + v), size * (o + v)}, {{0, 1, 2}, {0, 2, 3}}});
    all.push_back(
        {{size * o, size * (o + u), size * (o + w), size * (o + v)}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 2, 3}}});
    return all;
}

std::uint32_t packed(const glm::dvec3& n) { return glm::packSnorm4x8(glm::vec4(glm::vec3(n), 0)); }

} // namespace

TEST_CASE("light table: triangles of lamps that have few are sampled by solid angle") {
    const auto small = lamps(1);
    CHECK((small[0].table().lights[0].kind & LIGHT_BY_ANGLE) != 0);
    CHECK((small[1].table().lights[0].kind & LIGHT_BY_ANGLE) == 0);
    CHECK((small[2].table().lights[3].kind & LIGHT_BY_ANGLE) != 0);
    CHECK(small[0].table().kinds == (LIGHTS_SURFACES | LIGHTS_TRIANGLES));
    CHECK(small[1].table().kinds == (LIGHTS_SURFACES | LIGHTS_RECTANGLES));
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < 9; ++i) {
        for (int k = 0; k < 3; ++k)
            positions.emplace_back(float(i) + (k == 1 ? 0.5f : 0), k == 2 ? 1 : 0, float(i * i));
        triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    const Lamp many(positions, triangles);
    CHECK(many.table().kinds == (LIGHTS_SURFACES | LIGHTS_MESHES));
}

TEST_CASE("lamps: irradiance is that of the closed form, from samples that differ little") {
    std::mt19937 random(16);
    std::uniform_real_distribution<double> unit(-1, 1);
    constexpr int draws = 1 << 13;
    const std::vector<Lamp> all = lamps(1);
    const double most[] = {0.03, 0.04, 0.3}; // relative variance of one sample
    for (std::size_t which = 0; which < all.size(); ++which) {
        const Lamp& lamp = all[which];
        double sum2 = 0, spread = 0;
        int views = 0;
        while (views < 16) {
            const glm::dvec3 p = 1.5 * glm::dvec3(unit(random), unit(random), unit(random));
            const glm::dvec3 n = glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
            if (std::ranges::any_of(lamp.positions(), [&](const glm::vec3& c) {
                    return glm::dot(n, glm::normalize(glm::dvec3(c) - p)) < 0.02;
                }))
                continue;
            ++views;
            std::vector<Ask> asks;
            for (int i = 0; i < draws; ++i)
                asks.push_back({p, packed(n), {random(), random()}, std::uint32_t(random())});
            double sum = 0, squares = 0;
            for (const Drawn& d : lamp.draw(asks)) {
                REQUIRE(d.pdf > 0);
                const double f = glm::dot(n, glm::dvec3(d.wi)) / double(d.pdf);
                sum += f;
                squares += f * f;
            }
            const double mean = sum / draws, variance = (squares / draws - mean * mean) / draws;
            const double right = lamp.irradiance(glm::dvec3(glm::vec3(p)), n);
            const double z = (mean - right) / std::sqrt(variance + 1e-12 * right * right);
            INFO("irradiance " << mean << ", closed form " << right << ", z " << z);
            CHECK(std::abs(z) < 4.5);
            sum2 += z * z;
            spread += (squares / draws - mean * mean) / (mean * mean);
        }
        CHECK(sum2 < views + 4 * std::sqrt(2.0 * views));
        INFO("relative variance " << spread / views);
        CHECK(spread / views < most[which]);
    }
}

TEST_CASE("lamps: the density of a point is that with which it is drawn") {
    // Also of tiny and huge ones, seen from far away, from close to them, and from almost their own plane.
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (const float size : {1e-3f, 1.f, 1e3f})
        for (std::size_t which = 0; which < 2; ++which) {
            const Lamp lamp = std::move(lamps(size)[which]);
            const glm::dvec3 a(lamp.positions()[0]), b = glm::dvec3(lamp.positions()[1]) - a,
                                                     c = glm::dvec3(lamp.positions().back()) - a,
                                                     n = glm::normalize(glm::cross(b, c));
            std::vector<Ask> asks;
            for (int i = 0; i < 20000; ++i) {
                const double height = double(size) * std::pow(10.0, -2 + 2.5 * unit(random)) * (i % 2 ? 1 : -1);
                const glm::dvec3 p = a + 2 * unit(random) * b + 2 * unit(random) * c + height * n;
                const glm::dvec3 normal(unit(random), unit(random), unit(random));
                asks.push_back({p, packed(normal), {random(), random()}, std::uint32_t(random())});
            }
            std::size_t nothing = 0, off = 0;
            double worst = 0;
            for (const Drawn& d : lamp.draw(asks)) {
                nothing += !(d.pdf > 0 && std::isfinite(d.pdf));
                const double error = std::abs(double(d.again) / double(d.pdf) - 1);
                worst = std::max(worst, error);
                off += !(error < 1e-2);
            }
            INFO("size " << size << ", lamp " << which << ": " << nothing << " without density, " << off
                         << " off by 1 %, worst " << worst);
            CHECK(nothing == 0);
            CHECK(off <= asks.size() / 1000);
        }
}
