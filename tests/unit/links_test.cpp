// SPDX-License-Identifier: Apache-2.0
// Linked files: shown in place, moved as a whole, stored as a path and a place, read again.
#include "scene/links.hpp"
#include "base/file.hpp"
#include "document/linking.hpp"
#include "document/looks.hpp"
#include "document/pack.hpp"
#include "document/session.hpp"
#include "model_files.hpp"
#include "scene/placeholder.hpp"

#include <glm/gtc/matrix_transform.hpp>

using namespace restage;
using namespace restage::tests;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;

namespace {

constexpr const char* corners = "v 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n";

struct Shop : ModelFiles {
    document::Session session{registry};
    Merged made;
    Shop() {
        write("room.pbrt",
              "LookAt 0 1 -5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\nLightSource \"infinite\"\n"
              "MakeNamedMaterial \"red\" \"string type\" \"diffuse\"\nNamedMaterial \"red\"\nShape \"sphere\"\n");
        write("pair.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
        write_pair("o left\nusemtl red\nf 1 2 3\no right\nusemtl blue\nf 1 2 3\n");
        REQUIRE(session.open(path("room.pbrt")));
        auto linked = document::link(session, load("pair.obj"), path("pair.obj"));
        if (!linked) FAIL(linked.error().message);
        made = std::move(*linked);
    }
    void write_pair(const std::string& objects) const {
        write("pair.obj", std::string("mtllib pair.mtl\n") + corners + objects);
    }
    const Scene& scene() const { return session.scene(); }
    const Instance& object(std::size_t i) const { return scene().instances[made.instances[i]]; }
    void move(const glm::dmat4& by) { REQUIRE(session.move(made.instances, by)); }
    std::string save() {
        REQUIRE(session.save_project(path("shop.restage")));
        auto text = read_file(path("shop.restage"));
        REQUIRE(text);
        return std::move(*text);
    }
    document::Session reopened() {
        document::Session again(registry);
        const auto opened = again.open(path("shop.restage"));
        if (!opened) FAIL(opened.error().message);
        return again;
    }
};

const glm::dmat4 aside = glm::rotate(glm::translate(glm::dmat4(1), {3, 1, 0.25}), 0.7, {0, 1, 0});

} // namespace

TEST_CASE("a link is one group, moved, hidden, copied and deleted as a whole", "[links]") {
    Shop shop;
    REQUIRE(all_links(shop.scene()).size() == 1);
    CHECK(all_links(shop.scene())[0] == shop.made.group);
    CHECK(link_source(shop.scene().groups[shop.made.group])->file == shop.path("pair.obj"));
    CHECK(shop.scene().groups[shop.made.group].name == "pair");
    const std::vector<Id<Instance>> one{shop.made.instances[0]}, both = shop.made.instances;

    const auto part = shop.session.move(one, aside);
    REQUIRE_FALSE(part);
    CHECK_THAT(part.error().message, ContainsSubstring("\"pair\" is linked from pair.obj"));
    CHECK(shop.session.move(both, aside));
    CHECK_FALSE(shop.session.remove(one));
    CHECK_FALSE(shop.session.edit(set_hidden(shop.scene(), one, true)));
    CHECK(shop.session.edit(set_hidden(shop.scene(), both, true)));
    CHECK(shop.session.edit(set_hidden(shop.scene(), both, false)));
    CHECK_FALSE(shop.session.set_material(both, shop.session.find<Material>("red")));
    CHECK_FALSE(shop.session.set_param(shop.object(1).material, "reflectance", Value::color(1, 1, 1)));
    CHECK(shop.session.set_param(shop.session.find<Material>("red"), "reflectance", Value::color(1, 1, 1)));
    CHECK(shop.session.edit(rename(shop.scene(), shop.made.group, "the pair")));

    const auto copies = shop.session.duplicate(both, aside);
    REQUIRE(copies);
    CHECK(all_links(shop.scene()).size() == 2); // the copy is one, too
    CHECK_FALSE(shop.session.duplicate(one, aside)); // would put a copy into the link
    CHECK(shop.session.remove(*copies));
    CHECK(all_links(shop.scene()).size() == 1);
}

TEST_CASE("a project keeps the path of a linked file and its place, not its content", "[links][project]") {
    Shop shop;
    shop.move(aside);
    const glm::dmat4 place = shop.object(1).object_to_world;
    const std::string text = shop.save();
    CHECK_THAT(text, ContainsSubstring("\"file\": \"pair.obj\""));
    CHECK(text.find("left") == text.npos);
    CHECK(text.find("blue") == text.npos);

    const document::Session again = shop.reopened();
    CHECK(again.scene().instances.live() == shop.scene().instances.live());
    const Id<Instance> right = again.find<Instance>("right");
    REQUIRE(right);
    for (int c = 0; c < 4; ++c)
        CHECK(glm::length(again.scene().instances[right].object_to_world[c] - place[c]) < 1e-12);
    CHECK_FALSE(again.modified());
    REQUIRE(again.recovery_text({}) == shop.session.recovery_text({}));
}

TEST_CASE("a linked file that has changed is shown as it is now", "[links][project]") {
    Shop shop;
    shop.move(aside);
    const glm::dmat4 place = place_of(shop.scene(), shop.made.group);
    shop.save();
    shop.write_pair("o left\nusemtl red\nf 1 2 4\no third\nusemtl blue\nf 1 2 3\no fourth\nf 2 3 4\n");
    SECTION("when the project is opened") {
        const document::Session again = shop.reopened();
        CHECK(again.find<Instance>("fourth"));
        CHECK_FALSE(again.find<Instance>("right"));
    }
    SECTION("by reading it again, in one step") {
        const auto read = shop.load("pair.obj");
        const Id<Instance> left = shop.made.instances[0];
        REQUIRE(document::reload_link(shop.session, shop.made.group, read));
        CHECK(objects_of(shop.scene(), shop.made.group).size() == 3);
        CHECK(shop.scene().instances[left].name == "left"); // keeps its id
        CHECK_FALSE(shop.session.find<Instance>("right"));
        const glm::dmat4 now = place_of(shop.scene(), shop.made.group);
        for (int c = 0; c < 4; ++c)
            CHECK(glm::length(now[c] - place[c]) < 1e-12);
        CHECK(shop.session.find<Material>("blue"));
        REQUIRE(document::reload_link(shop.session, shop.made.group, read));
        REQUIRE(shop.session.undo());
        REQUIRE(shop.session.undo());
        CHECK(shop.session.find<Instance>("right"));
    }
}

TEST_CASE("an unchanged linked file changes nothing when it is read again", "[links]") {
    Shop shop;
    shop.move(aside);
    const auto edit =
        replace_link(shop.scene(), shop.made.group,
                     as_link(shop.load("pair.obj").scene, "pair", *link_source(shop.scene().groups[shop.made.group])));
    REQUIRE(edit);
    for (const AnyChange& change : edit->changes) // geometry and pixels are new ones
        CHECK_FALSE(std::holds_alternative<Change<Material>>(change));
    CHECK(shop.scene().materials.live() == 3); // the room's red, and the link's own
}

TEST_CASE("a linked file that is missing leaves a placeholder, and nothing is lost", "[links][project]") {
    Shop shop;
    shop.move(aside);
    REQUIRE(shop.session.edit(set_hidden(shop.scene(), shop.made.instances, true)));
    const std::string text = shop.save();
    std::filesystem::rename(shop.path("pair.obj"), shop.path("away.obj"));
    document::Session again = shop.reopened();
    REQUIRE(all_links(again.scene()).size() == 1);
    const auto missing = missing_things(again.scene());
    REQUIRE(missing.size() == 1);
    CHECK(missing[0].file == shop.path("pair.obj"));
    CHECK(again.report().count(io::Fate::dropped) >= 1);
    REQUIRE(again.save_project(shop.path("shop.restage")));
    CHECK(*read_file(shop.path("shop.restage")) == text);
    std::filesystem::rename(shop.path("away.obj"), shop.path("pair.obj"));
    CHECK(shop.reopened().find<Instance>("right"));
}

TEST_CASE("made editable, a link is what inserting would have made", "[links][project]") {
    Shop shop;
    REQUIRE(shop.session.edit(make_editable(shop.scene(), shop.made.group)));
    CHECK(all_links(shop.scene()).empty());
    CHECK(shop.session.move(std::vector{shop.made.instances[0]}, aside));
    const std::string text = shop.save();
    CHECK_THAT(text, ContainsSubstring("right"));
    CHECK(text.find("links") == text.npos);
    CHECK(shop.reopened().find<Instance>("right"));
    REQUIRE(shop.session.undo());
    REQUIRE(shop.session.undo());
    CHECK(all_links(shop.scene()).size() == 1);
    CHECK_FALSE(make_editable(shop.scene(), {99}));
}

TEST_CASE("a look keeps where a link is and whether it is seen, while the document is open", "[links][looks]") {
    Shop shop;
    REQUIRE(document::new_look(shop.session, "there"));
    shop.move(aside);
    REQUIRE(shop.session.edit(set_hidden(shop.scene(), shop.made.instances, true)));
    REQUIRE(document::go_to_look(shop.session, 0));
    CHECK_FALSE(shop.object(0).hidden);
    shop.save();
    document::Session again = shop.reopened();
    REQUIRE(document::go_to_look(again, 0));
    CHECK_FALSE(again.scene().instances[again.find<Instance>("left")].hidden);
}

TEST_CASE("packing a project takes the linked file and what it reads", "[links][pack]") {
    Shop shop;
    shop.move(aside);
    const std::string out = shop.path("packed");
    const auto packed = document::pack_project(shop.session.recovery_text({}), out, shop.registry);
    if (!packed) FAIL(packed.error().message);
    CHECK(packed->problems.empty());
    CHECK(packed->files == 3); // room.pbrt, pair.obj, pair.mtl
    document::Session moved(shop.registry);
    REQUIRE(moved.open(packed->project.string()));
    REQUIRE(all_links(moved.scene()).size() == 1);
    CHECK_THAT(link_source(moved.scene().groups[all_links(moved.scene())[0]])->file, ContainsSubstring("packed"));
}

TEST_CASE("exporting writes the objects of links, and none of their marks", "[links][export]") {
    Shop shop;
    REQUIRE(shop.session.export_to(shop.path("out.pbrt")));
    const auto text = read_file(shop.path("out.pbrt"));
    REQUIRE(text);
    CHECK(text->find("link.place") == text->npos);
    CHECK(shop.load("out.pbrt").scene.instances.live() == shop.scene().instances.live());
}
