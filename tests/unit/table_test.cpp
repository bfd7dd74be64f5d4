// SPDX-License-Identifier: Apache-2.0
// Tables read by plugins (restage/table.h), with MERL's files as example: valid ones become words, invalid ones
// an error; pbrt files, exports and projects keep the path.
#include "document/session.hpp"
#include "export_scene.hpp"
#include "io/import.hpp"
#include "merl_file.hpp"
#include "paths.hpp"
#include "plugin/table_reader.hpp"
#include "plugin_folder.hpp"

#include <bit>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <limits>

using namespace restage;
using namespace restage::scene;
using Catch::Matchers::ContainsSubstring;
using test::Folder, test::merl_bytes, test::Plugins, test::version;
namespace fs = std::filesystem;

namespace {

constexpr test::MerlCounts small{4, 3, 2};
constexpr std::size_t head = 4 + std::size_t(32) * (4 + 2 * 4 + 1); // words before the entries, merl.h

std::string lambert(double albedo = 0.5) {
    return merl_bytes(small, [=](double, double, double, int) { return albedo / std::numbers::pi; });
}

struct Reading {
    Plugins plugins;
    Folder folder;
    plugin::TableReader& reader = *plugins.registry.find_material("measured")->source->table_reader();

    Result<std::shared_ptr<const plugin::Table>> read(const std::string& bytes, const char* name = "a.binary") {
        REQUIRE(write_file_atomic(folder.file(name), bytes));
        return reader.read("filename", folder.file(name));
    }
    std::string refusal(const std::string& bytes) {
        const auto table = read(bytes);
        REQUIRE_FALSE(table);
        const std::string path = folder.file("a.binary");
        CHECK_THAT(table.error().message, Catch::Matchers::StartsWith(path + ": "));
        CHECK(reader.problem("filename", path) == table.error().message);
        return table.error().message;
    }
};

float entry(const plugin::Table& t, std::size_t h, std::size_t d, std::size_t p, std::size_t c) {
    return std::bit_cast<float>(t.words.at(head + 3 * ((h * small[1] + d) * small[2] + p) + c));
}

void put(std::string& bytes, std::size_t plane, std::size_t index, double value) {
    std::memcpy(bytes.data() + 12 + 8 * (plane * 24 + index), &value, 8);
}

} // namespace

TEST_CASE("a MERL file becomes words in the right order", "[table]") {
    Reading r;
    const auto table =
        r.read(merl_bytes(small, [](double h, double d, double p, int c) { return h + 10 * d + 100 * p + c; }));
    REQUIRE(table);
    const plugin::Table& t = **table;
    REQUIRE(t.words.size() == head + 3 * 24);
    CHECK(t.words[0] == 4);
    CHECK(t.words[1] == 3);
    CHECK(t.words[2] == 2);
    const double half_pi = std::numbers::pi / 2;
    for (const std::size_t c : {0u, 1u, 2u})
        CHECK(std::abs(entry(t, 3, 1, 1, c) - (half_pi * std::pow(3.5 / 4, 2) + 10 * half_pi / 2 + 100 * half_pi * 1.5 +
                                               static_cast<double>(c))) < 1e-4);
    REQUIRE(t.notes.size() == 1);
    CHECK(t.notes[0] == "4 x 3 x 2 entries, 0.0 % of them not measured");
}

TEST_CASE("negative and non-finite entries are marked, and counted", "[table]") {
    Reading r;
    std::string bytes = lambert();
    put(bytes, 0, 0, -1);
    put(bytes, 1, 5, -0.5);
    put(bytes, 2, 7, std::numeric_limits<double>::quiet_NaN());
    put(bytes, 2, 8, std::numeric_limits<double>::infinity());
    const auto table = r.read(bytes);
    REQUIRE(table);
    CHECK(entry(**table, 0, 0, 0, 0) == -1);
    CHECK(entry(**table, 0, 2, 1, 1) == -1);
    CHECK(entry(**table, 1, 0, 1, 2) == -1);
    CHECK(entry(**table, 1, 1, 0, 2) == -1);
    CHECK(std::abs(entry(**table, 1, 1, 0, 1) - 0.5 / std::numbers::pi) < 1e-6);
    REQUIRE((*table)->notes.size() == 2);
    CHECK_THAT((*table)->notes[0], ContainsSubstring("2.8 % of them not measured")); // 2 of 72
    CHECK((*table)->notes[1] == "2 values are not finite (taken as not measured)");
    for (const std::uint32_t word : (*table)->words)
        CHECK(std::isfinite(std::bit_cast<float>(word)));
}

TEST_CASE("a file that is not MERL is refused with a message", "[table]") {
    Reading r;
    CHECK_THAT(r.refusal(lambert().substr(0, 500)),
               ContainsSubstring("has 500 bytes where 4 x 3 x 2 entries take 588: it is cut short"));
    CHECK_THAT(r.refusal(lambert() + "x"), ContainsSubstring("not a MERL file"));
    CHECK_THAT(r.refusal(""), ContainsSubstring("too short"));
    CHECK_THAT(r.refusal("abc"), ContainsSubstring("too short"));
    CHECK_THAT(r.refusal("# irregular isotropic BRDF\n0.1 0.2 0.3\n"), ContainsSubstring("is text"));
    CHECK_THAT(r.refusal(std::string("tensor_file\0\1\0", 14)), ContainsSubstring("RGL's material database"));
    for (const test::MerlCounts n :
         {test::MerlCounts{0, 90, 180}, {-1, 90, 180}, {2147483647, 2147483647, 2147483647}, {5000, 1, 1}}) {
        std::string bytes = lambert();
        std::memcpy(bytes.data(), n.data(), 12);
        CHECK_THAT(r.refusal(bytes), ContainsSubstring("not a MERL file"));
    }
    std::string big = lambert(); // many, but plausible: the file is too short for them
    const test::MerlCounts n{4096, 4096, 4096};
    std::memcpy(big.data(), n.data(), 12);
    CHECK_THAT(r.refusal(big), ContainsSubstring("cut short"));
    for (std::uint32_t seed = 0; seed < 300; ++seed) { // noise: any result, but no crash
        std::string noise;
        for (std::uint32_t i = 0; i < seed; ++i)
            noise += static_cast<char>(hash64(&i, sizeof i, seed) & 255);
        (void)r.read(noise);
    }
    const std::string gone = r.folder.file("gone.binary");
    const auto missing = r.reader.read("filename", gone);
    REQUIRE_FALSE(missing);
    CHECK_THAT(missing.error().message, ContainsSubstring(gone + ": cannot be opened"));
    CHECK_THAT(r.reader.read("filename", r.folder.path.string()).error().message, ContainsSubstring("is a folder"));
    CHECK_THAT(r.reader.read("filename", "a.binary").error().message, ContainsSubstring("must be absolute"));
    CHECK(r.reader.read("filename", "").value()->words.empty());
}

TEST_CASE("a table is read once, and reread when its file changes; not after its plugin is unloaded", "[table]") {
    std::shared_ptr<plugin::TableReader> reader;
    Folder folder;
    const std::string file = folder.file("a.binary");
    {
        Plugins plugins;
        reader = plugins.registry.find_material("measured")->source->table_reader();
        REQUIRE(write_file_atomic(file, lambert(0.5)));
        const auto first = reader->read("filename", file).value();
        CHECK(reader->read("filename", file).value() == first);
        REQUIRE(write_file_atomic(file, lambert(0.25)));
        fs::last_write_time(file, fs::last_write_time(file) + std::chrono::seconds(2));
        const auto second = reader->read("filename", file).value();
        CHECK(second != first);
        CHECK(std::abs(2 * entry(*second, 0, 0, 0, 0) - entry(*first, 0, 0, 0, 0)) < 1e-6);
        REQUIRE(write_file_atomic(file, "broken"));
        REQUIRE_FALSE(reader->read("filename", file));
        REQUIRE(write_file_atomic(file, lambert(0.75)));
        CHECK(reader->read("filename", file));
        CHECK(reader->problem("filename", file).empty());
    }
    CHECK(reader->read("filename", file)); // cached tables stay
    REQUIRE(write_file_atomic(folder.file("b.binary"), lambert()));
    CHECK_THAT(reader->read("filename", folder.file("b.binary")).error().message,
               ContainsSubstring("has been replaced"));
}

TEST_CASE("a reload of the plugin rereads the files of its folder", "[table][plugin]") {
    test::PluginFolder folder;
    const fs::path built = restage::test::build_dir() / "lib/restage/plugins/material-measured";
    const fs::path copy = folder.path / "measured";
    fs::create_directories(copy);
    for (const auto& entry : fs::directory_iterator(built))
        fs::copy_file(entry.path(), copy / entry.path().filename());
    plugin::Registry registry(folder.log);
    folder.scan(registry);
    const auto before = registry.find_material("measured");
    REQUIRE(before);
    const std::string file = default_value(before->table->params[0]).text;
    CHECK(file == (copy / "glossy_paint.binary").string());
    const auto first = before->source->table_reader()->read("filename", file).value();
    CHECK(first->words[0] == 24);
    REQUIRE(write_file_atomic(file, lambert()));
    REQUIRE(registry.reload_changed().size() == 1);
    const auto after = registry.find_material("measured");
    REQUIRE(after);
    CHECK(after->source->table_reader() != before->source->table_reader());
    CHECK(after->source->table_reader()->read("filename", file).value()->words[0] == 4);
    CHECK(first->words[0] == 24); // a running renderer keeps it
    CHECK_FALSE(before->source->table_reader()->read("filename", file));
    fs::remove(file); // a missing default: the previous version stays
    REQUIRE(registry.reload_changed().size() == 1);
    CHECK_THAT(registry.entries()[0]->trouble, ContainsSubstring("glossy_paint.binary is missing"));
    CHECK(registry.find_material("measured"));
}

TEST_CASE("a reader that requests too much is stopped with a reason", "[table][plugin]") {
    test::PluginFolder folder;
    folder.add("p", test::manifest(), "table_greedy");
    plugin::Registry registry(folder.log);
    folder.scan(registry);
    const auto velvet = registry.find_material("velvet");
    REQUIRE(velvet);
    REQUIRE(write_file_atomic(folder.path / "a.dat", "x"));
    const auto table = velvet->source->table_reader()->read("weave", (folder.path / "a.dat").string());
    REQUIRE_FALSE(table);
    CHECK_THAT(table.error().message, ContainsSubstring("a.dat: it would be a table of more than 1024 MiB"));
}

TEST_CASE("a plugin without native code may not have tables", "[table][plugin]") {
    test::PluginFolder folder;
    const fs::path where = folder.path / "p";
    fs::create_directories(where);
    REQUIRE(write_file_atomic(where / "velvet.glsl", "// empty"));
    REQUIRE(write_file_atomic(
        where / "plugin.json",
        R"({"id":"org.example.velvet","provides":["restage.material/1","restage.table/1"],"version":"1.0.0","licence":"MIT",)"
        R"("materials":[{"type":"velvet","glsl":"velvet.glsl",)"
        R"("params":[{"id":"filename","type":"table"}]}]})"));
    CHECK_THAT(folder.refusal(), ContainsSubstring("\"params\"[0]: a table parameter needs native code to read it"));
}

TEST_CASE("measured materials of pbrt files: read, written, read again", "[table][pbrt]") {
    Reading r;
    fs::create_directories(r.folder.path / "in/brdfs");
    fs::create_directories(r.folder.path / "out");
    const std::string table = (r.folder.path / "in/brdfs/a.binary").string();
    REQUIRE(write_file_atomic(table, lambert()));
    REQUIRE(write_file_atomic(r.folder.path / "in/x.bsdf", "tensor_file"));
    REQUIRE(write_file_atomic(
        r.folder.path / "in/s.pbrt",
        "WorldBegin\nMaterial \"measured\" \"string filename\" \"brdfs/a.binary\" \"rgb tint\" [ 1 .5 .25 ]\n"
        "Shape \"sphere\"\nMaterial \"measured\" \"string filename\" \"gone.binary\"\nShape \"sphere\"\n"
        "Material \"measured\" \"string filename\" \"x.bsdf\"\nShape \"sphere\"\n"));
    document::Session session(r.plugins.registry);
    REQUIRE(session.open((r.folder.path / "in/s.pbrt").string()));
    const auto material = [](const document::Session& s, std::uint32_t instance) -> const Material& {
        return s.scene().materials[s.scene().instances[{instance}].material];
    };
    CHECK(material(session, 1).params.find("filename")->text == table);
    CHECK(material(session, 3).type == "diffuse");
    std::string report;
    for (const io::ReportEntry& e : session.report().entries)
        report += io::to_string(e) + "\n";
    CHECK_THAT(report, ContainsSubstring("kept: material \"" + material(session, 1).name + "\": looks up " + table +
                                         ": 4 x 3 x 2"));
    CHECK_THAT(report, ContainsSubstring("dropped: material \"" + material(session, 2).name +
                                         "\": " + (r.folder.path / "in/gone.binary").string() + ": cannot be opened"));
    CHECK_THAT(report, ContainsSubstring("data of RGL (.bsdf) is not read"));
    for (const bool edited : {false, true}) { // verbatim, and from its values
        if (edited)
            REQUIRE(session.set_param({session.scene().instances[{1}].material}, "tint", Value::color(1, 1, 0.5f)));
        for (const char* v : {"v4", "v3"}) {
            const std::string out = (r.folder.path / "out" / (std::string(v) + (edited ? "e" : "") + ".pbrt")).string();
            REQUIRE(session.export_to(out, version(v)));
            if (edited) // pbrt gets an approximation: its own measured materials have a different format
                CHECK_THAT(
                    read_file(out).value(),
                    ContainsSubstring("#restage MakeNamedMaterial \"measured\" \"string plugin\" [ \"measured\" ]") &&
                        ContainsSubstring("\"string filename\" [ \"textures/a"));
            document::Session again(r.plugins.registry);
            REQUIRE(again.open(out));
            const Material& m = material(again, 1);
            REQUIRE(m.type == "measured");
            CHECK_THAT(m.params.find("filename")->text, ContainsSubstring((r.folder.path / "out/textures/a").string()));
            CHECK(read_file(m.params.find("filename")->text).value() == lambert());
            CHECK(m.params.color("tint", {})[2] == (edited ? 0.5f : 0.25f));
        }
    }
}

TEST_CASE("a project keeps a table's path relative to itself", "[table][project]") {
    Reading r;
    REQUIRE(r.read(lambert()));
    document::Session session(r.plugins.registry);
    const auto id = session.add_material("steel", "measured").value();
    CHECK_FALSE(session.set_param(id, "filename", Value::choice("a.binary"))); // another type
    REQUIRE(session.set_param(id, "filename", Value::table(r.folder.file("a.binary"))));
    const std::string project = r.folder.file("p.restage");
    REQUIRE(session.save_project(project));
    CHECK_THAT(read_file(project).value(), ContainsSubstring("\"file\": \"a.binary\""));
    const fs::path moved = r.folder.path / "moved";
    fs::create_directories(moved);
    fs::rename(project, moved / "p.restage");
    fs::rename(r.folder.file("a.binary"), moved / "a.binary");
    document::Session again(r.plugins.registry);
    REQUIRE(again.open((moved / "p.restage").string()));
    const Value* value = again.scene().materials[id].params.find("filename");
    REQUIRE(value);
    CHECK(*value == Value::table((moved / "a.binary").string()));
    fs::remove(moved / "a.binary");
    document::Session lost(r.plugins.registry);
    REQUIRE(lost.open((moved / "p.restage").string()));
    REQUIRE(lost.report().count(io::Fate::dropped) == 1);
    CHECK_THAT(io::to_string(lost.report().entries[0]), ContainsSubstring("a.binary: cannot be opened"));
}
