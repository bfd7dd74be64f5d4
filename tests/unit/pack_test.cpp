// SPDX-License-Identifier: Apache-2.0
// Packing: the packed project opens as it was when the originals are gone, wherever its files were; what is missing is
// told. Zip files: everything comes back, and nothing leaves the folder.
#include "document/pack.hpp"
#include "io/scene_compare.hpp"
#include "io/zip_file.hpp"
#include "project_room.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <map>

using namespace restage;
using namespace restage::test;
using Catch::Matchers::ContainsSubstring;

namespace {

void write(const fs::path& path, const std::string& bytes) {
    fs::create_directories(path.parent_path());
    REQUIRE(write_file_atomic(path, bytes));
}
void write_picture(const fs::path& path, float value) {
    fs::create_directories(path.parent_path());
    REQUIRE(io::write_image(path.string(), {.width = 1, .height = 1, .channels = 3, .values = {value, value, value}}));
}

// A scene with an included file, a spectrum, and two pictures of one name: of its folder, and of one beside it.
struct Scattered : Fixture {
    Scattered() {
        write(at("home/scenes/main.pbrt"), R"(
Camera "perspective"
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Texture "near" "spectrum" "imagemap" "string filename" "wood.pfm"
Texture "far" "spectrum" "imagemap" "string filename" "../textures/wood.pfm"
MakeNamedMaterial "near" "string type" "diffuse" "texture reflectance" "near"
MakeNamedMaterial "far" "string type" "diffuse" "texture reflectance" "far"
MakeNamedMaterial "metal" "string type" "conductor" "spectrum eta" "metal.spd" "float roughness" 0.2
Include "parts/more.pbrt"
)");
        write(at("home/scenes/parts/more.pbrt"), R"(
NamedMaterial "near"
Shape "sphere" "float radius" 1
NamedMaterial "far"
Shape "disk" "float radius" 2
NamedMaterial "metal"
Shape "plymesh" "string filename" "parts/one.ply"
)");
        write(at("home/scenes/metal.spd"), "400 0.5\n700 0.9\n");
        write(at("home/scenes/parts/one.ply"),
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        write_picture(at("home/scenes/wood.pfm"), 0.25f);
        write_picture(at("home/textures/wood.pfm"), 0.75f);
        write(at("elsewhere/chair.obj"), "mtllib chair.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
        write(at("elsewhere/chair.mtl"), "newmtl red\nKd 1 0 0\nmap_Kd wood.pfm\n");
        write_picture(at("elsewhere/wood.pfm"), 0.5f);
    }
    void open(document::Session& session, const fs::path& path) const {
        const auto opened = session.open(path.string());
        INFO((opened ? "" : opened.error().message));
        REQUIRE(opened);
    }
    document::Packed pack(const document::Session& session, const char* out) const {
        auto packed = document::pack_project(session.recovery_text({}), at(out), registry);
        INFO((packed ? "" : packed.error().message));
        REQUIRE(packed);
        return *packed;
    }
    void forget_originals() const {
        fs::remove_all(folder / "home");
        fs::remove_all(folder / "elsewhere");
    }
    // As it was, with all pixels and geometry, and without a report of loss.
    void check_packed(const document::Session& was, const fs::path& project) const {
        document::Session now(registry);
        open(now, project);
        CHECK(io::structural_differences(was.scene(), now.scene(), registry) == std::vector<std::string>{});
        CHECK(now.report().count(io::Fate::dropped) == was.report().count(io::Fate::dropped));
        now.scene().images.each([&](Id<Image>, const Image& image) {
            INFO(image.name << " " << image.path);
            CHECK((image.path.empty() || fs::is_regular_file(image.path)));
            const Image* before = was.scene().images.find(find_by_name<Image>(was.scene(), image.name));
            REQUIRE(before);
            REQUIRE((image.data && before->data));
            CHECK(image.data->values == before->data->values);
        });
    }
};

} // namespace

TEST_CASE("A packed project opens as it was when the originals are gone", "[pack]") {
    const Scattered files;
    document::Session session(files.registry);
    files.open(session, files.at("home/scenes/main.pbrt"));
    REQUIRE(session.insert_file(files.at("elsewhere/chair.obj")));
    REQUIRE(session.set_param(session.find<Material>("metal"), "uroughness", Value::number(0.5f)));
    const char* out = GENERATE("packed", "packed.zip");
    INFO(out);
    const document::Packed packed = files.pack(session, out);
    CHECK(packed.problems == std::vector<std::string>{});
    CHECK(packed.files == 9);
    CHECK(packed.bytes > 300);
    files.forget_originals();
    fs::create_directories(files.folder / "other machine");
    const fs::path moved = files.folder / "other machine" / (std::string("moved") + fs::path(out).extension().string());
    fs::rename(files.folder / out, moved);
    files.check_packed(session, document::is_packed(moved) ? moved : moved / "packed.restage");
}

TEST_CASE("What is missing is told, and the rest is packed", "[pack]") {
    const Scattered files;
    fs::remove(files.folder / "home/textures/wood.pfm");
    fs::remove(files.folder / "home/scenes/parts/one.ply");
    document::Session session(files.registry);
    files.open(session, files.at("home/scenes/main.pbrt"));
    const document::Packed packed = files.pack(session, "packed");
    REQUIRE(packed.problems.size() == 2);
    CHECK_THAT(packed.problems[0], ContainsSubstring("parts/one.ply is missing"));
    CHECK_THAT(packed.problems[1], ContainsSubstring("textures/wood.pfm is missing"));
    document::Session again(files.registry);
    files.open(again, packed.project);
}

TEST_CASE("A file that is named by its whole path is told", "[pack]") {
    const Scattered files;
    const std::string main = read_file(files.at("home/scenes/main.pbrt")).value();
    write(files.at("home/scenes/main.pbrt"), main + "Include \"" + files.at("home/scenes/parts/more.pbrt") + "\"\n");
    document::Session session(files.registry);
    files.open(session, files.at("home/scenes/main.pbrt"));
    const document::Packed packed = files.pack(session, "packed");
    REQUIRE(packed.problems.size() == 1);
    CHECK_THAT(packed.problems[0], ContainsSubstring("parts/more.pbrt is named by its whole path"));
}

TEST_CASE("Files behind links are packed where the scene names them", "[pack]") {
    const Scattered files;
    fs::rename(files.folder / "home/textures", files.folder / "elsewhere/textures");
    fs::create_directory_symlink(files.folder / "elsewhere/textures", files.folder / "home/textures");
    document::Session session(files.registry);
    files.open(session, files.at("home/scenes/main.pbrt"));
    const document::Packed packed = files.pack(session, "packed");
    CHECK(packed.problems == std::vector<std::string>{});
    files.forget_originals();
    files.check_packed(session, packed.project);
}

TEST_CASE("Nothing is packed over other files, and nothing is left of a failure", "[pack]") {
    const Scattered files;
    document::Session session(files.registry);
    files.open(session, files.at("home/scenes/main.pbrt"));
    const auto full = document::pack_project(session.recovery_text({}), files.at("home"), files.registry);
    REQUIRE_FALSE(full);
    CHECK_THAT(full.error().message, ContainsSubstring("home: is not an empty folder; choose a new one"));
    const document::ReadOptions stopped{.progress = [](float, std::string_view) { return false; }};
    const auto none = document::pack_project(session.recovery_text({}), files.at("none"), files.registry, stopped);
    REQUIRE_FALSE(none);
    CHECK(none.error().cancelled());
    CHECK_FALSE(fs::exists(files.folder / "none"));
}

TEST_CASE("Zip files bring back what was put into them", "[zip]") {
    const TemporaryFolder folder;
    std::string noise;
    for (std::uint32_t i = 0, x = 1; i < 10000; ++i, x = x * 1664525u + 1013904223u)
        noise += static_cast<char>(x >> 24);
    const std::map<std::string, std::string> contents{
        {"a.txt", std::string(100000, 'a')}, {"b/c/noise.bin", noise}, {"b/empty", ""}, {"b/\xC3\xA4 b.txt", "x"}};
    for (const auto& [name, bytes] : contents)
        write(folder / ("in/" + name), bytes);
    REQUIRE(io::write_zip(folder / "x.zip", folder / "in"));
    CHECK(fs::file_size(folder / "x.zip") < 12000);
    REQUIRE(io::unpack_zip(folder / "x.zip", folder / "out"));
    for (const auto& [name, bytes] : contents) {
        INFO(name);
        CHECK(read_file(folder / ("out/" + name)).value_or("?") == bytes);
    }
    REQUIRE(io::write_zip(folder / "y.zip", folder / "out"));
    CHECK(read_file(folder / "x.zip").value() == read_file(folder / "y.zip").value());
    CHECK_FALSE(io::unpack_zip(folder / "x.zip", folder / "out")); // it exists
}

TEST_CASE("Zip files that are damaged or lead out of the folder are refused", "[zip]") {
    const TemporaryFolder folder;
    write(folder / "in/abcdefgh", "some text, some text, some text, some text");
    REQUIRE(io::write_zip(folder / "good.zip", folder / "in"));
    const std::string good = read_file(folder / "good.zip").value();
    const auto replaced = [&](const std::string& name) {
        std::string bytes = good;
        for (std::size_t at = 0; (at = bytes.find("abcdefgh", at)) != bytes.npos;)
            bytes.replace(at, 8, name);
        return bytes;
    };
    std::string flipped = good;
    flipped[40] = static_cast<char>(flipped[40] ^ 1); // of the deflated bytes
    const auto [bytes, why] =
        GENERATE_COPY(table<std::string, std::string>({{replaced("../evil1"), "leads out of the folder"},
                                                       {replaced("a/../../"), "leads out of the folder"},
                                                       {replaced("/tmp/abc"), "is not a relative path"},
                                                       {replaced("..\\evil1"), "is not a relative path"},
                                                       {replaced("C:\\abcde"), "is not a relative path"},
                                                       {flipped, "is damaged"},
                                                       {good.substr(0, good.size() - 1), "is not a whole zip file"},
                                                       {good.substr(10), "is not a whole zip file"},
                                                       {"", "is not a whole zip file"}}));
    write(folder / "bad.zip", bytes);
    const auto done = io::unpack_zip(folder / "bad.zip", folder / "out");
    REQUIRE_FALSE(done);
    CHECK_THAT(done.error().message, ContainsSubstring(why));
    CHECK_FALSE(fs::exists(folder / "out"));
    CHECK_FALSE(fs::exists(folder / "evil1"));
    const auto large = io::unpack_zip(folder / "good.zip", folder / "out", {}, 41);
    REQUIRE_FALSE(large);
    CHECK_THAT(large.error().message, ContainsSubstring("it holds 42 bytes"));
}
