// SPDX-License-Identifier: Apache-2.0
// Project files: all edits are restored exactly, by any path; a base that moved, changed or vanished is reported in one
// sentence; unknown contents are kept.
#include "io/scene_compare.hpp"
#include "project_monkey.hpp"

#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <catch2/generators/catch_generators_range.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

using namespace restage;
using namespace restage::test;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("All edits are restored exactly from a project file", "[project]") {
    const Fixture files;
    const unsigned seed = GENERATE(Catch::Generators::range(1u, 41u));
    INFO("seed " << seed);
    document::Session session(files.registry);
    const bool based = seed % 4 != 0; // or made in the program
    if (based) files.opened(session);
    Monkey monkey(files, seed);
    for (int i = 0; i < 60; ++i)
        monkey.edit(session);
    const auto saved = session.save_project(files.at("edited.restage"));
    INFO((saved ? "" : saved.error().message));
    REQUIRE(saved);
    CHECK_FALSE(session.modified());

    document::Session other(files.registry);
    const auto opened = other.open(files.at("edited.restage"));
    INFO((opened ? "" : opened.error().message));
    INFO(read_file(files.at("edited.restage")).value());
    REQUIRE(opened);
    check_same(session.scene(), other.scene());
    CHECK(io::structural_differences(session.scene(), other.scene(), files.registry) == std::vector<std::string>{});
    CHECK_FALSE(other.modified());
    // Saved again, the bytes are identical, also after moving to another folder and back.
    fs::create_directories(files.folder / "else");
    REQUIRE(other.save_project(files.at("else/again.restage")));
    document::Session third(files.registry);
    REQUIRE(third.open(files.at("else/again.restage")));
    REQUIRE(third.save_project(files.at("back.restage")));
    CHECK(read_file(files.at("back.restage")).value() == read_file(files.at("edited.restage")).value());
}

TEST_CASE("A scene that has no camera yet is saved and opened", "[project]") {
    const Fixture files;
    document::Session session(files.registry), other(files.registry);
    Edit edit{"Paint", {}};
    edit.changes.push_back(
        Change<Material>{session.scene().materials.next(), std::nullopt, Material{.name = "red", .type = "diffuse"}});
    const auto edited = session.edit(std::move(edit));
    REQUIRE(edited);
    CHECK(*edited);
    REQUIRE(session.save_project(files.at("bare.restage")));
    const auto opened = other.open(files.at("bare.restage"));
    INFO((opened ? "" : opened.error().message));
    REQUIRE(opened);
    check_same(session.scene(), other.scene());
}

TEST_CASE("A project contains only the changes", "[project]") {
    const Fixture files;
    document::Session session(files.registry);
    files.opened(session);
    const auto steel = session.find<Material>("steel");
    REQUIRE(session.set_param(steel, "uroughness", Value::number(0.1f)));
    REQUIRE(session.save_project(files.at("one.restage")));
    const std::string text = read_file(files.at("one.restage")).value();
    CHECK_THAT(text, ContainsSubstring("\"file\": \"scenes/room.pbrt\""));
    CHECK_THAT(text, ContainsSubstring("steel\": {\n        \"params\": {\n          \"uroughness\": 0.1\n"));
    CHECK_THAT(text, !ContainsSubstring("oak") && !ContainsSubstring("instances\": {") && !ContainsSubstring("film"));
}

TEST_CASE("Undo and redo continue across a save", "[project]") {
    const Fixture files;
    document::Session session(files.registry);
    files.opened(session);
    const Scene before = session.scene();
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.1f)));
    REQUIRE(session.save_project(files.at("p.restage")));
    CHECK_FALSE(session.modified());
    REQUIRE(session.undo());
    CHECK(session.modified());
    check_same(session.scene(), before);
    REQUIRE(session.redo());
    CHECK_FALSE(session.modified());
}

TEST_CASE("What is inserted stands on floors, hangs from ceilings and, if it is flat, on walls", "[project]") {
    const Fixture files;
    // 0.8 wide, 0.05 deep, 0.6 high; the origin is at its back, and its front looks towards -y.
    REQUIRE(write_file_atomic(files.at("scenes/frame.pbrt"),
                              "WorldBegin\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
                              "\"point3 P\" [-0.4 -0.05 -0.3  0.4 0 -0.3  0.4 -0.05 0.3  -0.4 0 0.3]\n"));
    const auto frame = io::import_scene(files.at("scenes/frame.pbrt"), files.registry);
    REQUIRE(frame);
    const glm::dvec3 at(3, 4, 1.5);
    const auto placed = [&](glm::dvec3 normal) {
        document::Session session(files.registry);
        files.opened(session);
        const auto made =
            session.insert(*frame, files.at("scenes/frame.pbrt"), {{.at = at, .up = {0, 0, 1}, .normal = normal}});
        REQUIRE(made);
        return world_bounds(session.scene(), made->instances.at(0));
    };
    const auto is = [](const Bounds& b, glm::dvec3 lower, glm::dvec3 upper) {
        return glm::length(b.lower - lower) < 1e-6 && glm::length(b.upper - upper) < 1e-6;
    };
    CHECK(is(placed({0, 0, 1}), {2.6, 3.975, 1.5}, {3.4, 4.025, 2.1}));
    CHECK(is(placed({0, 0, 0}), {2.6, 3.975, 1.5}, {3.4, 4.025, 2.1}));
    CHECK(is(placed({0, 0, -1}), {2.6, 3.975, 0.9}, {3.4, 4.025, 1.5}));
    CHECK(is(placed({0, -1, 0}), {2.6, 3.95, 1.2}, {3.4, 4, 1.8}));
    CHECK(is(placed({0, 1, 0}), {2.6, 4, 1.2}, {3.4, 4.05, 1.8}));
    CHECK(is(placed({1, 0, 0}), {3, 3.6, 1.2}, {3.05, 4.4, 1.8}));
    CHECK(is(placed({-1, 0, 0}), {2.95, 3.6, 1.2}, {3, 4.4, 1.8}));
}

TEST_CASE("Insertions from a file are stored by reference, with a placeholder if it vanishes", "[project]") {
    const Fixture files;
    document::Session session(files.registry);
    files.opened(session);
    REQUIRE(write_file_atomic(files.at("scenes/lamp.pbrt"),
                              "WorldBegin\nShape \"sphere\" \"float radius\" 0.2\n"
                              "Shape \"disk\" \"float radius\" 0.3\n"));
    const auto lamp = io::import_scene(files.at("scenes/lamp.pbrt"), files.registry);
    REQUIRE(lamp);
    const auto merged =
        session.insert(*lamp, files.at("scenes/lamp.pbrt"), document::Session::Stand{.at = {0, 1, 0}, .up = {0, 1, 0}});
    REQUIRE(merged);
    const auto& made = merged->instances;
    REQUIRE(made.size() == 2);
    CHECK(session.scene().groups[session.scene().instances[made[0]].group].name == "lamp");
    Bounds bounds = world_bounds(session.scene(), made[0]);
    bounds.add(world_bounds(session.scene(), made[1]));
    CHECK(std::abs(bounds.lower.y - 1) < 1e-6);
    CHECK(session.history().size() == 1); // one step
    REQUIRE(session.save_project(files.at("lamp.restage")));
    const std::string text = read_file(files.at("lamp.restage")).value();
    CHECK_THAT(text, ContainsSubstring("\"file\": \"scenes/lamp.pbrt\"") && !ContainsSubstring("positions"));
    document::Session other(files.registry);
    REQUIRE(other.open(files.at("lamp.restage")));
    check_same(session.scene(), other.scene());

    fs::rename(files.at("scenes/lamp.pbrt"), files.at("scenes/elsewhere.pbrt"));
    document::Session without(files.registry);
    REQUIRE(without.open(files.at("lamp.restage")));
    CHECK(without.report().count(io::Fate::dropped) == 3); // the file, and two meshes of it
    CHECK(without.scene().instances.live() == session.scene().instances.live());
    REQUIRE(without.save_project(files.at("lamp2.restage")));
    CHECK(read_file(files.at("lamp2.restage")).value() == text); // and nothing is lost
}

TEST_CASE("A base that moved or changed is reported, and can be replaced", "[project]") {
    const Fixture files;
    document::Session session(files.registry);
    files.opened(session);
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.1f)));
    Id<Instance> disk;
    session.scene().instances.each([&](Id<Instance> id, const Instance& i) {
        if (i.emission) disk = id;
    });
    const std::string lamp_name = session.scene().instances[disk].name;
    REQUIRE(session.remove(std::array{disk}));
    REQUIRE(session.save_project(files.at("p.restage")));

    document::BaseProblem problem{};
    const auto open = [&](document::ReadOptions options) {
        problem = {};
        options.problem = &problem;
        return document::read_document(files.at("p.restage"), files.registry, options);
    };
    SECTION("moved") {
        fs::rename(files.at("scenes/room.pbrt"), files.at("scenes/moved.pbrt"));
        const auto gone = open({});
        REQUIRE_FALSE(gone);
        CHECK(problem == document::BaseProblem::missing);
        CHECK_THAT(gone.error().message, ContainsSubstring("p.restage") && ContainsSubstring("scenes/room.pbrt") &&
                                             ContainsSubstring("put it back"));
        auto found = open({.base = files.at("scenes/moved.pbrt")});
        REQUIRE(found);
        document::Session other(files.registry);
        other.adopt(std::move(*found));
        check_same(session.scene(), other.scene());
    }
    SECTION("with more in it, so that ids have moved") {
        std::string more = room;
        more.insert(more.find("AttributeBegin"),
                    "MakeNamedMaterial \"brass\" \"string type\" \"conductor\"\n"
                    "NamedMaterial \"brass\"\nShape \"sphere\"\n");
        more.insert(more.find("MakeNamedMaterial"), "MakeNamedMaterial \"clay\" \"string type\" \"diffuse\"\n");
        REQUIRE(write_file_atomic(files.at("scenes/room.pbrt"), more));
        auto found = open({});
        INFO((found ? "" : found.error().message));
        REQUIRE(found);
        CHECK(found->report.count(io::Fate::approximated) >= 1);
        document::Session other(files.registry);
        other.adopt(std::move(*found));
        CHECK(other.scene().materials[other.find<Material>("steel")].params.number("uroughness", 0) == 0.1f);
        CHECK(other.scene().instances.live() == session.scene().instances.live() + 1);
    }
    SECTION("without what was changed") {
        std::string less = room;
        for (std::size_t at; (at = less.find("steel")) != std::string::npos;)
            less.replace(at, 5, "lead");
        REQUIRE(write_file_atomic(files.at("scenes/room.pbrt"), less));
        const auto lost = open({});
        REQUIRE_FALSE(lost);
        CHECK(problem == document::BaseProblem::changed);
        CHECK_THAT(lost.error().message, ContainsSubstring("material \"steel\"") && ContainsSubstring("room.pbrt"));
        auto part = open({.drop_lost = true});
        REQUIRE(part);
        CHECK(part->report.count(io::Fate::dropped) == 1);
        document::Session other(files.registry);
        other.adopt(std::move(*part));
        CHECK_FALSE(other.find<Instance>(lamp_name)); // that change still applies
    }
}

TEST_CASE("A newer project keeps unknown contents", "[project]") {
    const Fixture files;
    document::Session session(files.registry);
    files.opened(session);
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.1f)));
    REQUIRE(session.save_project(files.at("p.restage")));
    auto j = document::json::parse(read_file(files.at("p.restage")).value());
    j["storyboard"] = {{"frames", 12}};
    j["materials"]["changed"].begin().value()["aging"] = {{"years", 30}};
    REQUIRE(write_file_atomic(files.at("p.restage"), j.dump(1)));
    document::Session other(files.registry);
    REQUIRE(other.open(files.at("p.restage")));
    REQUIRE(other.set_param(other.find<Material>("steel"), "uroughness", Value::number(0.2f)));
    REQUIRE(other.save_project(files.at("p.restage")));
    const std::string text = read_file(files.at("p.restage")).value();
    CHECK_THAT(text,
               ContainsSubstring("\"frames\": 12") && ContainsSubstring("\"years\": 30") && ContainsSubstring("0.2"));
    // Its dependency is gone: so it is dropped, and nothing else.
    REQUIRE(other.set_param(other.find<Material>("steel"), "uroughness", Value::number(0.3f)));
    REQUIRE(other.save_project(files.at("p.restage")));
    const std::string same = read_file(files.at("p.restage")).value();
    CHECK_THAT(same, ContainsSubstring("storyboard") && !ContainsSubstring("years"));
}

TEST_CASE("Damaged projects are refused with the place", "[project]") {
    const Fixture files;
    const auto message = [&](const std::string& text) {
        REQUIRE(write_file_atomic(files.at("bad.restage"), text));
        document::Session session(files.registry);
        const auto opened = session.open(files.at("bad.restage"));
        REQUIRE_FALSE(opened);
        return opened.error().message;
    };
    CHECK_THAT(message("{\n  \"restage\": 1,\n  oops\n}"), ContainsSubstring("bad.restage:3:3"));
    CHECK_THAT(message("[1, 2]"), ContainsSubstring("not a Restage project"));
    CHECK_THAT(message("{\"restage\": 99}"), ContainsSubstring("newer"));
    const std::string head = "{\"restage\": 1, \"base\": {\"file\": \"scenes/room.pbrt\"}, ";
    CHECK_THAT(message(head + "\"materials\": {\"changed\": {\"steel\": {}}}}"), ContainsSubstring("#17 oak"));
    CHECK_THAT(message(head + "\"instances\": {\"added\": {\"#77 x\": {}}}}"), ContainsSubstring("#77 x"));
    CHECK_THAT(message(head + "\"film\": {\"width\": \"wide\"}}"),
               ContainsSubstring("film: width: expected a whole number"));
    CHECK_THAT(message(head + "\"film\": 7}"), ContainsSubstring("film"));
    CHECK_THAT(message(head + "\"meshes\": 7, \"cameras\": {\"added\": []}, \"active_camera\": \"#9 none\"}"),
               ContainsSubstring("bad.restage"));
}
