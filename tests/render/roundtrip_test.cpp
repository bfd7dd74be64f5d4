// SPDX-License-Identifier: Apache-2.0
// Edit -> picture -> file -> picture: a scene edited by the Session, exported and reimported is the same
// scene and the same picture; undone to the start, the export has the same bytes.
#include "base/file.hpp"
#include "document/session.hpp"
#include "io/scene_compare.hpp"
#include "paths.hpp"
#include "render/agreement.hpp"
#include "temporary_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

scene::Scene small(scene::Scene scene) {
    scene.film.value.width = 64;
    scene.film.value.height = 36;
    scene.film.version = ++scene.clock;
    return scene;
}

std::string all_files(const std::filesystem::path& folder) { // names and bytes, in order
    std::vector<std::filesystem::path> files;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder))
        if (e.is_regular_file()) files.push_back(e.path());
    std::sort(files.begin(), files.end());
    std::string all;
    for (const auto& f : files)
        all += std::filesystem::relative(f, folder).string() + "\n" + read_file(f).value();
    return all;
}

} // namespace

TEST_CASE("edits of the bundled scene survive export and import, in structure and in the picture") {
    document::Session session(plugins().registry);
    const auto opened = session.open(restage::test::source_dir().string() + "/scenes/demo/demo.pbrt");
    REQUIRE(opened.has_value());
    const test::TemporaryFolder temporary;
    const auto& folder = temporary.path();
    std::filesystem::create_directories(folder / "start");
    std::filesystem::create_directories(folder / "edited");
    std::filesystem::create_directories(folder / "undone");
    REQUIRE(session.export_to((folder / "start/scene.pbrt").string()).has_value());

    std::vector<scene::Id<scene::Instance>> ids;
    session.scene().instances.each([&](auto id, const scene::Instance&) { ids.push_back(id); });
    REQUIRE(ids.size() > 8);
    const auto biggest = std::vector{*std::max_element(ids.begin(), ids.end(), [&](auto a, auto b) {
        const auto n = [&](auto id) {
            return session.scene().meshes[session.scene().instances[id].mesh].data->triangles.size();
        };
        return n(a) < n(b);
    })};
    const auto before = trace_scene("embree", small(session.scene()), 16, 1);

    REQUIRE(session.duplicate(biggest, glm::translate(glm::dmat4(1), glm::dvec3(0.3, -0.6, 0.2))).has_value());
    REQUIRE(session.move(std::vector{ids[2]}, glm::rotate(glm::dmat4(1), 0.2, glm::dvec3(0, 0, 1))).has_value());
    REQUIRE(session.remove(std::vector{ids[5]}).has_value());
    const auto metal = session.add_material("Gold leaf", "conductor");
    REQUIRE(metal.has_value());
    REQUIRE(session.set_param(*metal, "uroughness", scene::Value::number(0.2f)).has_value());
    REQUIRE(session.set_material(std::vector{ids[0]}, *metal).has_value());

    for (const char* version : {"v4", "v3"}) {
        INFO("pbrt " << version);
        io::ExportOptions options;
        options.values.set("version", scene::Value::choice(version));
        const auto file = (folder / "edited" / (std::string(version) + ".pbrt")).string();
        const auto exported = session.export_to(file, options);
        if (!exported) FAIL(exported.error().message);
        const auto again = io::import_scene(file, plugins().registry);
        if (!again) FAIL(again.error().message);
        if (std::string(version) == "v3")
            continue; // v3 cannot express all of v4: losses are in the report; it only has to load
        for (const auto& line : io::structural_differences(session.scene(), again->scene, plugins().registry))
            FAIL_CHECK(line);
        const auto here = trace_scene("embree", small(session.scene()), 64, 1);
        const auto there = trace_scene("embree", small(again->scene), 64, 2);
        check_independent(here.image, there.image);
        CHECK(share_alike(before.image, here.image) < 0.9); // the edits are visible
    }
    while (session.undo()) {
    }
    CHECK_FALSE(session.modified());
    REQUIRE(session.export_to((folder / "undone/scene.pbrt").string()).has_value());
    CHECK(all_files(folder / "start") == all_files(folder / "undone"));
    std::filesystem::remove_all(folder);
}
