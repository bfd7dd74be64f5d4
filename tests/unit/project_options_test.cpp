// SPDX-License-Identifier: Apache-2.0
// Options of importers in project files: opened and inserted scenes are reread with the same options; options that are
// no longer valid are reported and kept.
#include "document/clipboard.hpp"
#include "project_room.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>
#include <nlohmann/json.hpp>

using namespace restage;
using namespace restage::test;
using Catch::Matchers::ContainsSubstring;

namespace {

// Two objects of one material: merged they are one mesh, which does not exist without the option.
constexpr const char* obj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no a\nf 1 3 2\no b\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

struct Files : Fixture {
    Files() { REQUIRE(write_file_atomic(at("scenes/t.obj"), obj)); }
    ParamSet options(std::initializer_list<std::pair<const char*, Value>> list) const {
        ParamSet set;
        for (const auto& [id, value] : list)
            set.set(id, value);
        return set;
    }
    void open(document::Session& session, const char* file, const document::ReadOptions& options = {}) const {
        const auto done = session.open(at(file), options);
        INFO((done ? "" : done.error().message));
        REQUIRE(done);
    }
    nlohmann::json json(const char* file) const { return nlohmann::json::parse(read_file(at(file)).value()); }
    void write(const char* file, const nlohmann::json& j) const { REQUIRE(write_file_atomic(at(file), j.dump())); }
    // t.obj with `merge` and the given unit, in a project.
    void project(document::Session& session, const char* unit = "mm") const {
        open(session, "scenes/t.obj",
             {.import_options = options({{"units", Value::choice(unit)}, {"merge", Value::boolean(true)}})});
        REQUIRE(session.save_project(at("p.restage")));
    }
};

std::vector<std::string> lines(const document::Session& session, const char* what) {
    std::vector<std::string> found;
    for (const io::ReportEntry& entry : session.report().entries)
        if (entry.what.find(what) != std::string::npos) found.push_back(io::to_string(entry));
    return found;
}

} // namespace

TEST_CASE("a project keeps the options that its scene was read with", "[project][options]") {
    const Files files;
    document::Session session(files.registry), plain(files.registry), again(files.registry);
    files.open(plain, "scenes/t.obj");
    CHECK(plain.scene().instances.live() == 2);
    files.project(session);
    CHECK(session.scene().instances.live() == 1);
    CHECK(files.json("p.restage")["base"]["options"].size() == 2);

    files.open(again, "p.restage");
    check_same(session.scene(), again.scene());
    CHECK(again.base().options == session.base().options);
    CHECK_FALSE(again.modified());
    REQUIRE(again.save_project(files.at("again.restage")));
    CHECK(files.json("again.restage") == files.json("p.restage"));

    REQUIRE(plain.save_project(files.at("plain.restage"))); // no report if nothing was set
    CHECK_FALSE(files.json("plain.restage")["base"].contains("options"));
    document::Session old(files.registry); // and such a project, like older ones, reads it with the defaults
    files.open(old, "plain.restage");
    CHECK(old.scene().instances.live() == 2);
}

TEST_CASE("a project can be opened with other options, and is then modified", "[project][options]") {
    const Files files;
    document::Session session(files.registry), other(files.registry);
    files.project(session);
    files.open(other, "p.restage",
               {.import_options = files.options({{"units", Value{.type = ParamType::text, .text = "cm"}}})});
    CHECK(other.scene().instances.live() == 2);
    CHECK(other.base().options == files.options({{"units", Value::choice("cm")}})); // typed
    CHECK(other.modified());
    const double size = world_bounds(other.scene()).size().z;
    CHECK(std::abs(size - 0.03) < 1e-9);
    REQUIRE(other.save_project(files.at("p.restage")));
    CHECK_FALSE(other.modified());
    document::Session same(files.registry);
    files.open(same, "p.restage", {.import_options = other.base().options});
    CHECK_FALSE(same.modified());
    check_same(other.scene(), same.scene());
    // Unknown options are refused with the same message as for a file.
    document::Session wrong(files.registry);
    const auto refused = wrong.open(files.at("p.restage"), {.import_options = files.options({{"height", Value()}})});
    REQUIRE(!refused);
    CHECK_THAT(refused.error().message, ContainsSubstring("there is no option \"height\"; known: units="));
}

TEST_CASE("a file inserted twice with different options is stored as two in a project", "[project][options]") {
    const Files files;
    document::Session session(files.registry);
    files.opened(session);
    const std::size_t before = session.scene().instances.live();
    REQUIRE(
        session.insert_file(files.at("scenes/t.obj"), {.values = files.options({{"merge", Value::boolean(true)}})}));
    CHECK(session.scene().instances.live() == before + 1);
    REQUIRE(session.insert_file(files.at("scenes/t.obj")));
    CHECK(session.scene().instances.live() == before + 3);
    REQUIRE(session.save_project(files.at("two.restage")));
    CHECK_THAT(read_file(files.at("two.restage")).value(), !ContainsSubstring("positions"));

    document::Session again(files.registry);
    files.open(again, "two.restage");
    check_same(session.scene(), again.scene());
    REQUIRE(again.save_project(files.at("again.restage")));
    CHECK(files.json("again.restage") == files.json("two.restage"));
    // The clipboard also refers to files if their contents are too large for it.
    document::DataSources sources = again.sources();
    std::size_t merged = 0;
    again.scene().meshes.each([&](auto, const Mesh& mesh) {
        const document::DataSource* source = sources.find(mesh.data.get());
        merged += source && source->options.find("merge");
    });
    CHECK(merged == 1);
}

TEST_CASE("options that are no longer valid are reported and kept, and another format's are dropped",
          "[project][options]") {
    const Files files;
    document::Session session(files.registry);
    files.project(session);
    nlohmann::json j = files.json("p.restage");
    j["base"]["options"]["smoothing"] = 0.5; // of an importer that is newer, or older
    j["base"]["options"]["up"] = "x";
    files.write("p.restage", j);
    document::Session again(files.registry);
    files.open(again, "p.restage");
    CHECK(again.scene().instances.live() == 1); // merged: what fits is used
    CHECK(lines(again, "import option").size() == 2);
    CHECK_THAT(lines(again, "smoothing").at(0), ContainsSubstring("there is no option"));
    CHECK_THAT(lines(again, "\"up\"").at(0), ContainsSubstring("cannot be \"x\"; as_is|y|z are possible"));
    REQUIRE(again.save_project(files.at("kept.restage")));
    CHECK(files.json("kept.restage")["base"]["options"] == j["base"]["options"]);

    // Its scene is replaced by one of another format.
    document::Session replaced(files.registry);
    files.open(replaced, "p.restage", {.base = files.at("scenes/room.pbrt"), .drop_lost = true});
    CHECK(replaced.base().options.entries().empty());
    CHECK(lines(replaced, "import option").size() == 4);
    // By a copy of it elsewhere: the same scene.
    j["base"]["options"].erase("smoothing"), j["base"]["options"].erase("up");
    files.write("p.restage", j);
    fs::rename(files.at("scenes/t.obj"), files.at("moved.obj"));
    document::Session moved(files.registry);
    files.open(moved, "p.restage", {.base = files.at("moved.obj")});
    check_same(session.scene(), moved.scene());

    j["base"]["options"] = 7;
    files.write("p.restage", j);
    document::Session damaged(files.registry);
    const auto refused = damaged.open(files.at("p.restage"), {.base = files.at("moved.obj")});
    REQUIRE(!refused);
    CHECK_THAT(refused.error().message, ContainsSubstring("base: options: expected values by name"));
}
