// SPDX-License-Identifier: Apache-2.0
// Looks: what they record and restore, in one undo step; things removed and added since; projects with them.
#include "document/looks.hpp"

#include "document/sky.hpp"
#include "project_room.hpp"
#include "scene/difference.hpp"
#include "scene/validate.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <catch2/matchers/catch_matchers_vector.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::test;
using Catch::Matchers::ContainsSubstring;
using document::Session;

namespace {

Id<Instance> lamp_of(const Session& session) { return session.find<Instance>("Lamp"); }

bool at_look(const Session& session, std::size_t index) {
    return document::look_change(session.scene(), session.looks().list.at(index)).edit.changes.empty();
}

// Changes something of everything that a look records.
void restyle(Session& session) {
    const auto lamp = lamp_of(session);
    const Id<Instance> ids[] = {lamp};
    REQUIRE(session.move(ids, glm::translate(glm::dmat4(1), glm::dvec3(0.5, 0, 0))));
    REQUIRE(session.set_material(ids, session.find<Material>("steel")));
    REQUIRE(session.set_param(session.find<Material>("steel"), "uroughness", Value::number(0.05f)));
    const auto light = Id<Light>{1};
    REQUIRE(session.edit(set_hidden(session.scene(), light, true)));
    REQUIRE(session.edit(set_environment(session.scene(), Environment{.name = "dusk", .scale = {0.1f, 0.1f, 0.2f}})));
    Film film = session.scene().film.value;
    film.exposure = 3;
    REQUIRE(session.edit(set_film(session.scene(), film)));
    const auto camera = session.scene().active_camera.value;
    Camera moved = session.scene().cameras[camera];
    moved.camera_to_world[3].y += 1;
    moved.fov = 25;
    REQUIRE(session.edit(set_camera(session.scene(), camera, moved)));
}

} // namespace

TEST_CASE("Going to a look restores all that it records, in one undo step", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    REQUIRE(document::new_look(session, "Day"));
    const Scene day = session.scene();
    restyle(session);
    const Scene night = session.scene();
    CHECK_FALSE(at_look(session, 0));
    REQUIRE(document::new_look(session)); // named by itself
    CHECK(session.looks().list[1].name == "Look 1");
    CHECK(session.looks().current == 1);
    CHECK(at_look(session, 1));

    const std::size_t steps = session.history().size();
    const auto went = document::go_to_look(session, 0);
    REQUIRE(went);
    CHECK(went->empty());
    CHECK(session.history().size() == steps + 1);
    CHECK(session.history().undo_label() == "Go to look Day");
    CHECK(session.looks().current == 0);
    check_same(session.scene(), day);
    REQUIRE(document::go_to_look(session, 0)); // there already: no step
    CHECK(session.history().size() == steps + 1);

    REQUIRE(session.undo());
    CHECK(session.looks().current == 1);
    check_same(session.scene(), night);
    REQUIRE(session.redo());
    CHECK(session.looks().current == 0);
    check_same(session.scene(), day);
    CHECK_FALSE(document::go_to_look(session, 2));
}

TEST_CASE("The list of looks is changed and undone like the scene", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    const auto names = [&] {
        std::string text;
        for (std::size_t i = 0; i < session.looks().list.size(); ++i)
            text += session.looks().list[i].name + (i == session.looks().current ? "* " : " ");
        return text;
    };
    for (const char* name : {"a", "b", "c"})
        REQUIRE(document::new_look(session, name));
    CHECK(names() == "a b c* ");
    CHECK(session.modified());
    REQUIRE(document::move_look(session, 2, 0));
    CHECK(names() == "c* a b ");
    REQUIRE(document::move_look(session, 1, 2));
    CHECK(names() == "c* b a ");
    REQUIRE(document::duplicate_look(session, 0));
    CHECK(names() == "c* c 2 b a ");
    REQUIRE(document::rename_look(session, 1, "d"));
    REQUIRE(document::rename_look(session, 1, "d")); // the same: no step
    CHECK(names() == "c* d b a ");
    CHECK_THAT(document::rename_look(session, 1, "b").error().message, ContainsSubstring("there is a look \"b\""));
    CHECK_FALSE(document::rename_look(session, 1, ""));
    CHECK_FALSE(document::new_look(session, "a"));
    REQUIRE(document::remove_look(session, 0));
    CHECK(names() == "d b a ");
    CHECK_FALSE(document::remove_look(session, 3));
    CHECK(session.history().size() == 8);
    for (const char* before : {"c* d b a ", "c* c 2 b a ", "c* b a ", "c* a b ", "a b c* ", "a b* ", "a* ", ""}) {
        REQUIRE(session.undo());
        CHECK(names() == before);
    }
    CHECK_FALSE(session.modified());
    const scene::Version version = session.version();
    REQUIRE(session.redo());
    CHECK(session.version() > version); // it is autosaved
    CHECK(names() == "a* ");
}

TEST_CASE("Objects removed since a look are skipped, those added since are hidden", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    REQUIRE(document::new_look(session, "before"));
    const Id<Instance> lamp[] = {lamp_of(session)};
    const auto copies = session.duplicate(lamp, glm::translate(glm::dmat4(1), glm::dvec3(1, 0, 0)));
    REQUIRE(copies);
    REQUIRE(session.edit(insert(session.scene(), Light{.name = "extra"}, "Add light")));
    REQUIRE(document::new_look(session, "after"));
    REQUIRE(session.remove(lamp));

    const auto went = document::go_to_look(session, 0);
    REQUIRE(went);
    CHECK_THAT(*went, Catch::Matchers::Equals(std::vector<std::string>{"object \"Lamp\""}));
    CHECK(session.scene().instances[copies->front()].hidden);
    CHECK(session.scene().lights[session.find<Light>("extra")].hidden);
    CHECK_FALSE(session.find<Instance>("Lamp"));
    REQUIRE(document::go_to_look(session, 1));
    CHECK_FALSE(session.scene().instances[copies->front()].hidden);
    CHECK_FALSE(session.scene().lights[session.find<Light>("extra")].hidden);

    // Unless they are to be in all of them, as they are now.
    REQUIRE(document::use_in_all_looks(session, *copies));
    REQUIRE(document::go_to_look(session, 0));
    CHECK_FALSE(session.scene().instances[copies->front()].hidden);
    CHECK(session.scene().lights[session.find<Light>("extra")].hidden);
}

TEST_CASE("Materials that only a look uses come back", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    REQUIRE(document::new_look(session, "oak"));
    const auto oak = session.find<Material>("oak");
    std::vector<Id<Instance>> users;
    session.scene().instances.each([&](Id<Instance> id, const Instance& i) {
        if (i.material == oak) users.push_back(id);
    });
    REQUIRE_FALSE(users.empty());
    REQUIRE(session.set_material(users, session.find<Material>("steel")));
    REQUIRE(document::new_look(session, "steel"));
    REQUIRE(session.edit(remove_unused(session.scene())));
    REQUIRE_FALSE(session.find<Material>("oak"));

    const auto through_a_file = GENERATE(false, true);
    Session other(files.registry);
    Session& used = through_a_file ? other : session;
    if (through_a_file) {
        REQUIRE(session.save_project(files.at("kept.restage")));
        REQUIRE(other.open(files.at("kept.restage")));
    }
    const auto went = document::go_to_look(used, 0);
    REQUIRE(went);
    CHECK(went->empty());
    const auto again = used.find<Material>("oak");
    REQUIRE(again);
    CHECK(used.scene().instances[users.front()].material == again);
    CHECK(used.scene().materials[again].params.entries().size() > 0);
    for (const Problem& problem : validate(used.scene()))
        CHECK(problem.severity != Problem::Severity::error);
}

TEST_CASE("A project keeps its looks", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    REQUIRE(document::new_look(session, "Day"));
    const Id<Instance> lamp[] = {lamp_of(session)};
    REQUIRE(session.duplicate(lamp, glm::translate(glm::dmat4(1), glm::dvec3(1, 0, 0))));
    restyle(session);
    REQUIRE(document::new_look(session, "Night"));
    REQUIRE(document::go_to_look(session, 0));
    REQUIRE(session.save_project(files.at("looks.restage")));
    const std::string text = read_file(files.at("looks.restage")).value();
    INFO(text);
    CHECK_THAT(text, ContainsSubstring("\"name\": \"Night\"") && ContainsSubstring("\"exposure\": 3"));

    Session other(files.registry);
    const auto opened = other.open(files.at("looks.restage"));
    INFO((opened ? "" : opened.error().message));
    REQUIRE(opened);
    CHECK_FALSE(other.modified());
    REQUIRE(other.looks().list.size() == 2);
    CHECK(other.looks().current == 0);
    CHECK(at_look(other, 0));
    for (const std::size_t index : {1u, 0u, 1u}) {
        REQUIRE(document::go_to_look(session, index));
        REQUIRE(document::go_to_look(other, index));
        check_same(session.scene(), other.scene());
    }
    // As in the recovery file.
    const auto recovered =
        document::read_project_text(session.recovery_text({}), files.at("autosaved.restage"), files.registry);
    REQUIRE(recovered);
    REQUIRE(recovered->looks);
    CHECK(recovered->looks->list.size() == 2);
    CHECK(recovered->looks->current == 1);
    Session third(files.registry);
    third.adopt_recovered(*recovered);
    REQUIRE(document::go_to_look(third, 0));
    REQUIRE(document::go_to_look(session, 0));
    check_same(session.scene(), third.scene());
    // Saved again from what was read: the same bytes.
    REQUIRE(document::go_to_look(other, 0));
    REQUIRE(other.save_project(files.at("again.restage")));
    CHECK(read_file(files.at("again.restage")).value() == text);
}

TEST_CASE("A look of a project whose scene lost things opens without them", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    const Id<Instance> lamp[] = {lamp_of(session)};
    REQUIRE(session.move(lamp, glm::translate(glm::dmat4(1), glm::dvec3(0.5, 0, 0))));
    REQUIRE(document::new_look(session, "moved"));
    REQUIRE(session.undo());
    REQUIRE(session.undo());
    REQUIRE(document::new_look(session, "first"));
    REQUIRE(session.redo() == false);
    REQUIRE(session.move(lamp, glm::translate(glm::dmat4(1), glm::dvec3(1, 0, 0))));
    REQUIRE(document::new_look(session, "second"));
    REQUIRE(document::go_to_look(session, 0));
    REQUIRE(session.save_project(files.at("lost.restage")));
    std::string scene = room;
    scene.replace(scene.find("# name: Lamp"), 12, "# name: Bulb");
    REQUIRE(write_file_atomic(files.at("scenes/room.pbrt"), scene));

    Session other(files.registry);
    const auto opened = other.open(files.at("lost.restage"));
    INFO((opened ? "" : opened.error().message));
    REQUIRE(opened);
    CHECK(other.looks().list.size() == 2);
    bool said = false;
    for (const io::ReportEntry& entry : other.report().entries)
        said |= entry.what == "instance \"Lamp\"" && entry.note.find("look \"second\"") != std::string::npos;
    CHECK(said);
    REQUIRE(document::go_to_look(other, 1));
}

TEST_CASE("A plugin's sky of a look is made again", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    const glm::dvec3 up(0, 1, 0);
    const auto sky = [&](double elevation) {
        ParamSet values;
        values.set("elevation", Value::number(float(elevation)));
        REQUIRE(session.edit(document::plugin_sky(session.scene(), files.registry, "sunsky", values, up)));
    };
    sky(60);
    REQUIRE(document::new_look(session, "noon"));
    const auto image = session.scene().environment.value->image;
    const auto noon = session.scene().images[image].data;
    sky(5);
    REQUIRE(document::new_look(session, "evening"));
    const auto evening = session.scene().images[image].data;
    REQUIRE(noon != evening);
    REQUIRE(document::go_to_look(session, 0));
    CHECK(session.scene().images[image].data == noon);
    REQUIRE(session.save_project(files.at("sky.restage")));
    Session other(files.registry);
    REQUIRE(other.open(files.at("sky.restage")));
    REQUIRE(document::go_to_look(other, 1));
    const Image& made = other.scene().images[other.scene().environment.value->image];
    CHECK(same_data(made.data, evening));
}

TEST_CASE("Damaged looks are refused with the place", "[looks]") {
    const Fixture files;
    const auto opens = [&](const std::string& looks) {
        const auto read = document::read_project_text(R"({"restage": 1, "looks": )" + looks + "}",
                                                      files.at("x.restage"), files.registry);
        return read ? std::string() : read.error().message;
    };
    CHECK(opens("[]").empty());
    CHECK_THAT(opens("7"), ContainsSubstring("looks: expected a list"));
    CHECK_THAT(opens("[{}]"), ContainsSubstring("looks: number 1 has no name"));
    CHECK_THAT(opens(R"([{"name": "a"}, {"name": "a"}])"), ContainsSubstring("two are called \"a\""));
    CHECK_THAT(opens(R"([{"name": "a", "instances": 3}])"),
               ContainsSubstring("looks: a: instances: expected an object"));
    CHECK_THAT(opens(R"([{"name": "a", "film": {"exposure": "x"}}])"),
               ContainsSubstring("looks: a: exposure: expected a number"));
    CHECK(opens(R"([{"name": "a", "current": 5, "lights": {"#9 gone": {}}}])").empty());
}

TEST_CASE("The difference of two states of a document leads from one to the other", "[looks]") {
    const Fixture files;
    Session session(files.registry);
    files.opened(session);
    const Scene before = session.scene();
    CHECK(difference(before, before, "").changes.empty());
    const Id<Instance> lamp[] = {lamp_of(session)};
    REQUIRE(session.duplicate(lamp, glm::translate(glm::dmat4(1), glm::dvec3(1, 0, 0))));
    restyle(session);
    REQUIRE(session.remove(lamp));
    const Scene after = session.scene();
    REQUIRE(session.edit(difference(after, before, "Back")));
    check_same(session.scene(), before);
    CHECK(session.find<Instance>("Lamp") == lamp[0]);
    CHECK(session.history().undo_label() == "Back");
    REQUIRE(session.undo());
    check_same(session.scene(), after);
}
