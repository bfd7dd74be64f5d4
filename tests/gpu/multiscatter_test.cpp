// SPDX-License-Identifier: Apache-2.0
// Energy compensation: the reflectance of a rough white surface with and without it, by integrating its samples, and
// the accuracy of the loss and its fitted mean (shaders/restage/v1/multiscatter.glsl) over the whole range of
// roughness.
#include "gpu/bench.hpp"

#include <catch2/catch_test_macros.hpp>

#include <algorithm>
#include <map>
#include <sstream>

using namespace restage;
using namespace restage::test;
using scene::Value;

namespace {

// Directional albedo (power, so 1/eta^2 undone) of each set seen under each cosine.
std::vector<double> furnace(const char* type, std::span<const scene::ParamSet> configs,
                            std::span<const float> cosines) {
    Bench& bench = Bench::get();
    BsdfLab lab(bench, bench.material(type));
    constexpr int side = 64;
    Engine e(21);
    std::vector<double> out;
    for (const scene::ParamSet& config : configs)
        for (const float z : cosines) {
            std::vector<BsdfJob> jobs;
            const Vec3 wo = direction(z, uniform(e, 0, 6.3f));
            for (int i = 0; i < side * side; ++i)
                jobs.push_back({.wo = wo,
                                .u = {(static_cast<float>(i % side) + unit(e)) / side,
                                      (static_cast<float>(i / side) + unit(e)) / side, unit(e)}});
            double sum = 0;
            for (const BsdfAnswer& a : lab.run({&config, 1}, jobs))
                if (a.flags != 0) sum += static_cast<double>(a.weight[1]) * a.eta * a.eta;
            out.push_back(sum / (side * side));
        }
    return out;
}

struct Case {
    const char* type;
    std::map<std::string, Value> values;
    double tolerance; // of the furnace
};

} // namespace

// A perfectly reflecting body under white fibres: the sheen's fitted albedo (shaders/restage/v1/sheen.glsl) says how
// much of the body is left. Energy is lost where the two directions' shares differ, as in KHR_materials_sheen.
TEST_CASE("sheen: a white body under white fibres neither gains nor loses much", "[materials][multiscatter]") {
    std::vector<scene::ParamSet> configs;
    const float roughness[] = {0.f, 0.3f, 0.6f, 1.f}, cosines[] = {1.f, 0.6f, 0.25f, 0.06f};
    for (const float r : roughness) {
        scene::ParamSet set;
        for (const char* id : {"base_color", "sheen_color"})
            set.set(id, Value::color(1, 1, 1));
        set.set("specular", Value::number(0));
        set.set("sheen_roughness", Value::number(r));
        configs.push_back(set);
    }
    const auto a = furnace("principled", configs, cosines);
    for (std::size_t i = 0; i < a.size(); ++i) {
        INFO("roughness " << roughness[i / 4] << " cos " << cosines[i % 4] << ": " << a[i]);
        CHECK(a[i] < 1.01);
        CHECK(a[i] > 0.8);
    }
}

TEST_CASE("multiple scattering: the white furnace is white at every roughness", "[materials][multiscatter]") {
    const Value off = Value::choice("none"), full = Value::color(0, 0, 0);
    const Value beckmann = Value::choice("beckmann");
    // An index of 20i reflects everything.
    const Case cases[] = {
        {"conductor", {{"remap", off}, {"eta", full}, {"k", Value::color(20, 20, 20)}}, 0.02},
        {"conductor",
         {{"remap", off}, {"eta", full}, {"k", Value::color(20, 20, 20)}, {"distribution", beckmann}},
         0.06},
        {"principled", {{"base_color", Value::color(1, 1, 1)}, {"metallic", Value::number(1)}}, 0.02},
        {"principled", {{"base_color", Value::color(1, 1, 1)}, {"transmission", Value::number(1)}}, 0.03},
        {"principled",
         {{"base_color", Value::color(1, 1, 1)}, {"transmission", Value::number(1)}, {"thin", Value::boolean(true)}},
         0.03},
        {"dielectric", {{"remap", off}, {"eta", Value::number(1.5f)}}, 0.03},
        {"dielectric", {{"remap", off}, {"eta", Value::number(2.2f)}, {"distribution", beckmann}}, 0.06},
    };
    for (const auto& m : Bench::get().materials())
        for (std::uint32_t i = 0; i < m.table->params.size(); ++i)
            if (std::string_view(m.table->params[i].id) == "multiscatter") {
                INFO(m.table->type << " has multiscatter, and no furnace here");
                CHECK(std::ranges::any_of(cases,
                                          [&](const Case& c) { return std::string_view(c.type) == m.table->type; }));
            }
    const float above[] = {1.f, 0.7f, 0.4f, 0.15f}, both[] = {0.9f, 0.15f, -0.15f, -0.5f};
    for (const Case& c : cases) {
        const bool glass = std::string_view(c.type) == "dielectric" || c.values.contains("transmission");
        std::vector<scene::ParamSet> on, without;
        const float roughness[] = {0.1f, 0.5f, 1.f};
        for (const float r : roughness) {
            scene::ParamSet set;
            for (const auto& [id, v] : c.values)
                set.set(id, v);
            for (const char* id : {"uroughness", "vroughness"})
                set.set(id, Value::number(r));
            set.set("roughness", Value::number(std::sqrt(r))); // principled's is the root of alpha
            without.push_back(set);
            set.set("multiscatter", Value::boolean(true));
            on.push_back(set);
        }
        const std::span<const float> views = glass ? std::span<const float>(both) : std::span<const float>(above);
        const auto a = furnace(c.type, on, views), b = furnace(c.type, without, views);
        double worst = 0, loss = 0;
        std::ostringstream rows;
        for (std::size_t i = 0; i < a.size(); ++i) {
            worst = std::max(worst, std::abs(a[i] - 1));
            loss = std::max(loss, 1 - b[i]);
            rows << "alpha " << roughness[i / views.size()] << " cos " << views[i % views.size()] << ": " << b[i]
                 << " -> " << a[i] << '\n';
        }
        INFO(c.type << (c.values.contains("distribution") ? " beckmann" : "") << ", worst " << worst << '\n'
                    << rows.str());
        CHECK(worst < c.tolerance);
        CHECK(loss > 0.2); // there was a loss to restore
    }
}
