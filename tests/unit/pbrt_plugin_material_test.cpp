// SPDX-License-Identifier: Apache-2.0
// pbrt files with materials of plugins: pbrt's hair, with all specifications of its colour, and names unknown to
// pbrt. Read, written, reread.
#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/import.hpp"
#include "io/services.hpp"
#include "paths.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Folder, test::Plugins, test::version;

namespace {

struct Reading {
    Plugins plugins;
    Folder folder;
    document::Session session{plugins.registry};

    const Material& read(const std::string& material) {
        const std::string file = folder.file("in.pbrt");
        REQUIRE(write_file_atomic(file, "WorldBegin\nMaterial " + material + "\nShape \"sphere\"\n"));
        REQUIRE(session.open(file));
        const Instance* ball = session.scene().instances.find(Id<Instance>{1});
        REQUIRE(ball);
        return session.scene().materials[ball->material];
    }
    std::string written(const char* as) {
        REQUIRE(session.export_to(folder.file("out.pbrt"), version(as)));
        return read_file(folder.file("out.pbrt")).value();
    }
};

bool near(std::array<float, 3> a, std::array<float, 3> b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 2e-3f;
}

} // namespace

TEST_CASE("pbrt's hair, by its colour, its absorption or its pigments", "[pbrt]") {
    Reading r;
    const Material& m = r.read(R"("hair" "rgb reflectance" [ 0.5 0.3 0.1 ] "float beta_n" 0.4 "float alpha" 3)");
    CHECK(m.type == "hair");
    CHECK(near(m.params.color("color", {}), {0.5f, 0.3f, 0.1f}));
    CHECK(m.params.number("beta_n", 0) == 0.4f);
    CHECK(m.params.number("beta_m", 0.3f) == 0.3f);
    CHECK(m.params.number("alpha", 0) == 3);
    // Chiang et al. 2016, Eq. 9 at beta_n = 0.3: ln(c)^2 / 5.869^2 absorbs
    const double d = 5.969 - 0.215 * 0.3 + 2.532 * 0.09 - 10.73 * 0.027 + 5.574 * 0.0081 + 0.245 * 0.00243;
    const auto color = [&](double sigma) { return static_cast<float>(std::exp(-std::sqrt(sigma) * d)); };
    CHECK(near(r.read(R"("hair" "rgb sigma_a" [ 0.1 0.2 0.4 ])").params.color("color", {}),
               {color(0.1), color(0.2), color(0.4)}));
    CHECK(near(r.read(R"("hair" "float eumelanin" 0.5)").params.color("color", {}),
               {color(0.2095), color(0.3485), color(0.685)}));
    CHECK_THAT(r.written("v4"), ContainsSubstring("\"float eumelanin\" [ 0.5 ]"));
    const auto id = r.session.scene().instances.find(Id<Instance>{1})->material;
    REQUIRE(r.session.set_param(id, "beta_m", Value::number(0.6f)));
    CHECK_THAT(r.written("v4"), ContainsSubstring("\"float beta_m\" [ 0.6 ]") && ContainsSubstring("\"hair\""));
    REQUIRE(r.session.set_param(id, "color", Value::color(0.2f, 0.1f, 0.05f)));
    CHECK_THAT(r.written("v4"),
               ContainsSubstring("\"rgb reflectance\" [ 0.2 0.1 0.05 ]") && !ContainsSubstring("eumelanin"));
    CHECK_THAT(r.written("v3"), ContainsSubstring("color\" [ 0.2 0.1 0.05 ]"));
}

TEST_CASE("pbrt's hair without its plugin keeps its colour, and the report says why", "[pbrt]") {
    const std::filesystem::path all = restage::test::build_dir() / "lib/restage/plugins";
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    registry.scan(std::vector<plugin::SearchPath>{
        {all / "importer-pbrt", true}, {all / "exporter-pbrt", true}, {all / "material-diffuse", true}});
    REQUIRE(registry.find_importer("pbrt"));
    REQUIRE_FALSE(registry.find_material("hair"));
    document::Session session{registry};
    Folder folder;
    const std::string file = folder.file("in.pbrt");
    const std::string fur = R"(Material "hair" "rgb reflectance" [ 0.5 0.3 0.1 ] "float beta_n" 0.4)";
    REQUIRE(write_file_atomic(file, "WorldBegin\n" + fur + "\nShape \"sphere\"\n"));
    REQUIRE(session.open(file));
    const Material& m = session.scene().materials[session.scene().instances.find(Id<Instance>{1})->material];
    CHECK(m.type == "diffuse");
    CHECK(near(m.params.color("reflectance", {}), {0.5f, 0.3f, 0.1f}));
    bool said = false;
    for (const io::ReportEntry& entry : session.report().entries)
        said = said || io::to_string(entry).find("no plugin provides hair") != std::string::npos;
    CHECK(said);
    REQUIRE(session.export_to(folder.file("out.pbrt"), version("v4"))); // and nothing is lost
    const std::string out = read_file(folder.file("out.pbrt")).value();
    CHECK_THAT(out, ContainsSubstring("\"hair\"") && ContainsSubstring("\"float beta_n\" [ 0.4 ]"));
}

TEST_CASE("a plugin's material unknown to pbrt is written back unchanged", "[pbrt]") {
    Reading r;
    const Material& m =
        r.read(R"("principled" "rgb base_color" [ 0.1 0.2 0.3 ] "float roughness" 0.25 "bool thin" true)");
    CHECK(m.type == "principled");
    CHECK(near(m.params.color("base_color", {}), {0.1f, 0.2f, 0.3f}));
    CHECK(m.params.number("roughness", 0) == 0.25f);
    CHECK(m.params.number("thin", 0) == 1);
    CHECK_THAT(r.written("v4"),
               ContainsSubstring("\"principled\"") && ContainsSubstring("\"rgb base_color\" [ 0.1 0.2 0.3 ]"));
}
