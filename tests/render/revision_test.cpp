// SPDX-License-Identifier: Apache-2.0
// A second revision of the material interface (tests/plugins_bad/material2.h), in addition to the first: one adapter
// reads it, and from there to the picture no other code sees the difference.
#include "../plugins_bad/material2.h"
#include "base/file.hpp"
#include "fixture.hpp"
#include "plugin/adapters.hpp"
#include "plugin/library.hpp"
#include "scene_builder.hpp"
#include "temporary_folder.hpp"

#include <cstdio>

using namespace restage;
using namespace restage::tests;
namespace fs = std::filesystem;

namespace {

// Everything a program must add for it.
Result<model::Material> read_material2(const void* table) {
    const auto& in = *static_cast<const TestMaterial2*>(table);
    const std::string file = in.code, type = file.substr(0, file.find('.'));
    model::Material out{.type = type, .label = in.title, .prefix = type, .glsl_file = file};
    for (const std::string& word : plugin::split_words(in.colors)) {
        model::Param p{.id = word.substr(0, word.find('=')), .label = "Colour", .type = model::ParamType::color};
        if (std::sscanf(word.c_str() + p.id.size() + 1, "%f %f %f", &p.def[0], &p.def[1], &p.def[2]) != 3)
            return fail("a colour of three numbers was expected: " + word);
        p.max = 1, p.texturable = true;
        out.params.push_back(p);
    }
    return out;
}
const plugin::MaterialAdapter both[] = {{TEST_MATERIAL2, read_material2}, {RESTAGE_MATERIAL1, plugin::read_material1}};

struct Cloth { // a folder with tests/plugins_bad/second.c
    test::TemporaryFolder temporary;
    std::vector<std::string> lines;
    Log log{[this](LogLevel, std::string_view line) { lines.emplace_back(line); }};

    explicit Cloth(const char* provides) {
        const fs::path folder = temporary.path() / "cloth";
        fs::create_directories(folder);
        const std::string library = std::string("second") + plugin::Library::extension();
        fs::copy_file(restage::test::build_dir() / "tests" / "plugins_bad" / library, folder / library);
        REQUIRE(write_file_atomic(folder / "plugin.json",
                                  std::string(R"({"id": "org.example.cloth", "version": "1.0.0", "licence": "MIT", )") +
                                      R"("needs": {"host": ">=0.2"}, "library": "second", "provides": [)" + provides +
                                      "]}"));
        const auto lambert = read_file(restage::test::source_dir() / "engine/sdk/templates/material/common/NAME.glsl");
        REQUIRE(lambert);
        for (const std::string name : {"velvet", "silk"}) {
            std::string text = *lambert;
            for (std::size_t at = 0; (at = text.find("@NAME@", at)) != std::string::npos;)
                text.replace(at, 6, name);
            REQUIRE(write_file_atomic(folder / (name + ".glsl"), text));
        }
    }
    void scan(plugin::Registry& registry) const {
        registry.scan(std::vector<plugin::SearchPath>{{temporary.path(), true},
                                                      {restage::test::build_dir() / "lib/restage/plugins", true}});
    }
    render::FilmImage picture(const plugin::Registry& registry, const char* material) {
        SceneBuilder b;
        b.set_film(32, 24);
        b.environment(glm::vec3(1));
        b.instance(b.quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}), b.material(material));
        b.set_camera({0, -2, 2}, {0, 0, 0}, {0, 0, 1}, 50);
        render::RendererOptions options{.strategy = render::Strategy::bsdf_only}; // without noise
        options.shader_dir = restage::test::source_dir() / "shaders";
        auto made = render::Renderer::create(options, render::material_lookup(registry), log);
        if (!made) FAIL(made.error().message);
        return render_image(**made, b.scene, 2);
    }
};

} // namespace

TEST_CASE("a second revision of an interface is one adapter", "[revision]") {
    Cloth cloth(R"("restage.material/1", "restage.material/2")");
    plugin::Registry registry(cloth.log, {.material_adapters = both});
    cloth.scan(registry);
    const auto velvet = registry.find_material("velvet"), silk = registry.find_material("silk");
    for (const auto& line : cloth.lines)
        UNSCOPED_INFO(line);
    REQUIRE(velvet);
    REQUIRE(silk);
    CHECK(velvet->table->label == "Velvet of the second"); // the newest revision supported by both
    CHECK(registry.find_material("diffuse")); // of the first, beside it
    // The current program uses the parts of the same bundle that it supports.
    plugin::Registry today(cloth.log);
    cloth.scan(today);
    REQUIRE(today.find_material("velvet"));
    CHECK(today.find_material("velvet")->table->label == "Velvet of the first");
    CHECK_FALSE(today.find_material("silk"));
    const auto second = cloth.picture(registry, "silk"), first = cloth.picture(today, "velvet");
    CHECK(second.color == first.color);
    const auto center = second.color[12 * 32 + 16];
    CHECK(std::abs(center.x - 0.8f) < 1e-4f); // white light, and the tint of the table
    CHECK(std::abs(center.z - 0.2f) < 1e-4f);
}

TEST_CASE("a bundle of only the second revision needs a program that supports it", "[revision]") {
    Cloth cloth(R"("restage.material/2")");
    plugin::Registry registry(cloth.log, {.material_adapters = both});
    cloth.scan(registry);
    CHECK(registry.find_material("silk"));
    plugin::Registry today(cloth.log);
    cloth.scan(today);
    CHECK_FALSE(today.find_material("silk"));
    REQUIRE(today.entries()[0]->state == plugin::State::refused);
    CHECK(today.entries()[0]->reason.find("provides restage.material/2, which this program cannot use: the plugin is "
                                          "too new") != std::string::npos);
}
