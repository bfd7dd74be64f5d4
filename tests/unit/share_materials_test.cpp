// SPDX-License-Identifier: Apache-2.0
// Equal materials of inserted files are shared with the document's, and those it has already can be merged.
#include "scene/share_materials.hpp"
#include "document/session.hpp"
#include "model_files.hpp"
#include "scene/validate.hpp"

using namespace restage;
using namespace restage::tests;
using namespace restage::scene;

namespace {

constexpr const char* corner = "v 0 0 1\nv 1 0 1\nv 0 1 1\n";

struct Rooms : ModelFiles {
    document::Session session{registry};
    Rooms() {
        write("oak.mtl", "newmtl oak\nKd 0.5 0.3 0.1\nnewmtl wax\nKd 0.9 0.9 0.8\n");
        write("other.mtl", "newmtl oak\nKd 0.5 0.3 0.1\nnewmtl pine\nKd 0.9 0.9 0.8\n");
        write("dark.mtl", "newmtl oak\nKd 0.1 0.1 0.1\n");
        write("chair.obj",
              std::string("mtllib oak.mtl\n") + corner + "usemtl oak\nf 1 2 3\no b\nusemtl wax\nf 1 2 3\n");
        write("table.obj",
              std::string("mtllib other.mtl\n") + corner + "usemtl oak\nf 1 2 3\no b\nusemtl pine\nf 1 2 3\n");
        write("stool.obj", std::string("mtllib dark.mtl\n") + corner + "usemtl oak\nf 1 2 3\n");
        REQUIRE(session.open(path("chair.obj")));
    }
    Merged insert(const char* name) {
        auto made = session.insert_file(path(name));
        if (!made) FAIL(made.error().message);
        return std::move(*made);
    }
    const Material& material_of(Id<Instance> id) const {
        return session.scene().materials[session.scene().instances[id].material];
    }
};

} // namespace

TEST_CASE("an inserted material that the document has already is shared, if its name is the same", "[merge][share]") {
    Rooms rooms;
    const Scene before = rooms.session.scene();
    const Merged made = rooms.insert("table.obj");
    CHECK(rooms.session.scene().instances[made.instances[0]].material == rooms.session.find<Material>("oak"));
    CHECK(rooms.material_of(made.instances[1]).name == "pine"); // as wax, but called otherwise
    CHECK(rooms.session.scene().materials.live() == before.materials.live() + 1);
    REQUIRE(rooms.session.undo());
    CHECK(rooms.session.scene().materials.live() == before.materials.live());
}

TEST_CASE("a material of the same name and another look is not shared", "[merge][share]") {
    Rooms rooms;
    const Merged dark = rooms.insert("stool.obj");
    CHECK(rooms.material_of(dark.instances[0]).name == "oak 2");
    // The one that was inserted is found by its name without the number.
    const Merged again = rooms.insert("stool.obj");
    CHECK(rooms.material_of(again.instances[0]).name == "oak 2");
}

TEST_CASE("images are equal by their pixels, or by their file if it was not read", "[merge][share]") {
    Scene into, from;
    const auto add = [](Scene& s, const char* file, std::vector<float> values) {
        Image image{.name = "grain", .path = file};
        if (!values.empty())
            image.data = std::make_shared<const PixelData>(
                PixelData{.width = 1, .height = 1, .channels = 3, .values = std::move(values)});
        s.images.set(s.images.next(), image, 1);
        Texture texture{.name = "grain", .type = "imagemap", .image = {s.images.size()}};
        s.textures.set(s.textures.next(), texture, 1);
        Material oak{.name = "oak", .type = "diffuse"};
        Value value{.type = model::ParamType::color};
        value.texture = {s.textures.size()};
        oak.params.set("reflectance", value);
        s.materials.set(s.materials.next(), oak, 1);
    };
    add(into, "/a/grain.png", {1, 0, 0});
    SECTION("pixels") {
        add(from, "/b/grain.png", {1, 0, 0});
        CHECK(shared_materials(into, from).size() == 1);
    }
    SECTION("other pixels") {
        add(from, "/b/grain.png", {1, 0, 0.5});
        CHECK(shared_materials(into, from).empty());
    }
    SECTION("other files that were not read") {
        into = {};
        add(into, "/a/grain.png", {});
        add(from, "/b/grain.png", {});
        CHECK(shared_materials(into, from).empty());
    }
    SECTION("a spectrum that only the origin keeps") {
        add(from, "/a/grain.png", {1, 0, 0});
        Material oak = from.materials[{1}];
        oak.origin.values.push_back({"reflectance", "[400 0.2 700 0.9]"});
        from.materials.set({1}, oak, 2);
        CHECK(shared_materials(into, from).empty());
    }
}

TEST_CASE("equal materials of a document are merged in one step", "[share]") {
    Rooms rooms;
    const Merged made = rooms.insert("table.obj");
    const Id<Material> oak = rooms.session.find<Material>("oak");
    // As documents from before have them: a copy with a number.
    Material copy = rooms.session.scene().materials[oak];
    copy.name = "oak 2";
    const Id<Material> second = rooms.session.scene().materials.next();
    REQUIRE(rooms.session.edit(insert(rooms.session.scene(), copy, "")));
    REQUIRE(rooms.session.set_material(std::vector{made.instances[0]}, second));
    const std::size_t steps = rooms.session.history().position();

    MergedMaterials merged = merge_equal_materials(rooms.session.scene());
    CHECK(merged.merged == 1);
    CHECK(merged.other_names == 1); // pine and wax
    REQUIRE(rooms.session.edit(std::move(merged.edit)));
    CHECK(rooms.session.history().position() == steps + 1);
    CHECK(rooms.session.scene().instances[made.instances[0]].material == oak);
    CHECK_FALSE(rooms.session.scene().materials.find(second));
    CHECK(rooms.session.find<Material>("pine"));
    CHECK(merge_equal_materials(rooms.session.scene()).edit.changes.empty());
    REQUIRE(rooms.session.undo());
    CHECK(rooms.session.scene().instances[made.instances[0]].material == second);
}
