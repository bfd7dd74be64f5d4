// SPDX-License-Identifier: Apache-2.0
// Materials that pbrt can only approximate: the file contains the approximation, and the exact form for our importer.
// They are restored with all their values, or as the approximation if their plugin is missing.
#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/import.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <sstream>

using namespace restage;
using namespace restage::scene;
using test::Everything, test::Folder, test::Plugins, test::version;

namespace {

const Material* named(const Scene& scene, const std::string& name) {
    const Material* found = nullptr;
    scene.materials.each([&](auto, const Material& m) {
        if (m.name == name) found = &m;
    });
    return found;
}

std::string material_lines(const std::string& file, const std::string& name) {
    std::istringstream text(read_file(file).value());
    std::string found;
    for (std::string line; std::getline(text, line);)
        if (line.find("MakeNamedMaterial \"" + name + "\"") != line.npos) found += line + "\n";
    return found;
}

struct Case {
    const char *name, *type;
    std::vector<std::pair<const char*, Value>> values;
};

} // namespace

TEST_CASE("materials that pbrt lacks survive it with all their values", "[pbrt]") {
    const std::string as = GENERATE("v4", "v3");
    const std::vector<Case> cases = {
        {"theatre curtain",
         "velvet",
         {{"reflectance", Value::color(0.1f, 0.25f, 0.3f)}, {"roughness", Value::number(0.7f)}}},
        {"beetle",
         "principled",
         {{"base_color", Value::color(0.2f, 0.4f, 0.8f)},
          {"iridescence", Value::number(0.75f)},
          {"iridescence_thickness", Value::number(312.5f)},
          {"sheen_color", Value::color(0.5f, 0.25f, 0.125f)},
          {"sheen_roughness", Value::number(0.6f)},
          {"anisotropy", Value::number(0.3f)},
          {"clearcoat", Value::number(0.9f)},
          {"clearcoat_roughness", Value::number(0.2f)},
          {"thin", Value::boolean(true)}}},
        {"rough metal",
         "conductor",
         {{"multiscatter", Value::boolean(true)},
          {"distribution", Value::choice("beckmann")},
          {"uroughness", Value::number(0.4f)}}},
        {"leather", "coatedconductor", {{"max_depth", Value::integer(7)}, {"thickness", Value::number(0.3f)}}},
    };
    Plugins plugins;
    Folder folder;
    Everything all(as == "v4");
    for (const Case& c : cases)
        all.instance(c.name, Id<Mesh>{1}, all.material(c.name, c.type, c.values), 1, 0);
    const auto report = io::export_scene(all.scene, folder.file("out.pbrt"), plugins.registry, version(as.c_str()));
    REQUIRE(report);
    const auto read = io::import_scene(folder.file("out.pbrt"), plugins.registry);
    REQUIRE(read);
    for (const Case& c : cases) {
        INFO(as << " " << c.name);
        const Material *was = named(all.scene, c.name), *is = named(read->scene, c.name);
        REQUIRE(is);
        CHECK(is->type == was->type);
        for (const auto& [id, value] : c.values) {
            INFO(id);
            const Value* back = is->params.find(id);
            REQUIRE(back);
            CHECK(*back == value);
        }
    }
    CHECK(read->scene.materials.size() == all.scene.materials.size()); // replacements do not count
    REQUIRE(io::export_scene(read->scene, folder.file("again.pbrt"), plugins.registry, version(as.c_str())));
    for (const Case& c : cases)
        CHECK(material_lines(folder.file("again.pbrt"), c.name) == material_lines(folder.file("out.pbrt"), c.name));
}

TEST_CASE("without the plugin pbrt's nearest material is read", "[pbrt]") {
    Plugins plugins;
    Folder folder;
    REQUIRE(write_file_atomic(folder.file("in.pbrt"), R"(WorldBegin
#restage MakeNamedMaterial "lost" "string plugin" "no such plugin" "float fuzz" [ 0.5 ]
MakeNamedMaterial "lost" "string type" "diffuse" "rgb reflectance" [ 0.25 0.5 0.75 ]
NamedMaterial "lost"
Shape "sphere"
)"));
    const auto read = io::import_scene(folder.file("in.pbrt"), plugins.registry);
    REQUIRE(read);
    const Material* m = named(read->scene, "lost");
    REQUIRE(m);
    CHECK(m->type == "diffuse");
    CHECK(m->params.color("reflectance", {})[2] == 0.75f);
}
