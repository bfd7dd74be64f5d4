// SPDX-License-Identifier: Apache-2.0
// plugin: materials without native code, materials that change while they are in use, and plugins that crashed.
#include "plugin/quarantine.hpp"
#include "plugin_folder.hpp"

#include <restage/scene_io.h>
#include <atomic>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::plugin;
using Catch::Matchers::ContainsSubstring;
using Folder = restage::test::PluginFolder;
using restage::test::manifest;

namespace {

std::string json_manifest(const std::string& materials) {
    return R"({"id": "org.example.velvet", "provides": ["restage.material/1"], "version": "1.0.0", "licence": "MIT", "needs": {"host": ">=0.2"},
 "materials": )" +
           materials + "}";
}
std::string velvet(const std::string& params, const std::string& more = "") {
    return R"([{"type": "velvet", "label": "Velvet", "glsl": "velvet.glsl", "tooltip": "Cloth.")" + more +
           R"(, "params": )" + params + "}]";
}
const std::string params = R"([
 {"id": "tint", "label": "Tint", "type": "color", "flags": ["texturable"], "default": [0.1, 0.2, 0.3], "tooltip": "T."},
 {"id": "fuzz", "type": "float", "min": 0.5, "max": 2, "default": 1.5, "unit": "m", "flags": ["texturable", "advanced"]},
 {"id": "count", "type": "int", "min": 1, "max": 9, "default": 3},
 {"id": "soft", "type": "bool", "default": true, "x-note": "its author's own"},
 {"id": "weave", "type": "enum", "choices": ["plain", "twill"], "default": "twill"}])";

// Mappings of private copies of plugin libraries.
int open_copies() {
    std::ifstream maps("/proc/self/maps");
    int count = 0;
    for (std::string line; std::getline(maps, line);)
        count += line.find("restage-plugin-") != std::string::npos;
    return count;
}

} // namespace

TEST_CASE("a material without native code: its table is in the manifest", "[plugin]") {
    Folder folder;
    folder.add("velvet", json_manifest(velvet(params, R"(, "flags": ["lossless", "tangent"])")), nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    const auto found = registry.find_material("velvet");
    REQUIRE(found);
    const model::Material& t = *found->table;
    CHECK(std::string(t.label) == "Velvet");
    CHECK(std::string(t.prefix) == "velvet"); // the type, as none is given
    CHECK((t.lossless && t.tangent && !t.stochastic && !t.transmissive));
    REQUIRE(t.params.size() == 5);
    CHECK(t.params[0].type == model::ParamType::color);
    CHECK(t.params[0].def[2] == 0.3f);
    CHECK(std::string(t.params[1].label) == "fuzz"); // the id, as none is given
    CHECK((t.params[1].texturable && t.params[1].advanced));
    CHECK((t.params[1].min == 0.5f && t.params[1].max == 2 && t.params[1].def[0] == 1.5f));
    CHECK(std::string(t.params[1].unit) == "m");
    CHECK(t.params[2].int_def == 3);
    CHECK(t.params[3].int_def == 1);
    CHECK(choices_text(t.params[4]) == "plain|twill");
    CHECK(t.params[4].int_def == 1);
    CHECK(found->source->glsl()->size() == 1);
}

TEST_CASE("errors in a JSON table are reported with their place", "[plugin]") {
    Folder folder;
    const auto refused = [&](const std::string& materials) {
        return folder.refusal_of(json_manifest(materials), nullptr);
    };
    CHECK_THAT(refused("[]"), ContainsSubstring("\"materials\" must be a list of at least one material"));
    CHECK_THAT(refused(R"([{"type": "velvet"}])"), ContainsSubstring("\"materials\"[0]: \"glsl\" is missing"));
    CHECK_THAT(refused(velvet("[{}]")), ContainsSubstring("\"materials\"[0].\"params\"[0]: \"id\" is missing"));
    CHECK_THAT(refused(velvet(R"([{"id": "a", "type": "colour"}])")),
               ContainsSubstring("\"type\": \"colour\" is unknown; known: float, color, int, bool, enum, text"));
    CHECK_THAT(refused(velvet(R"([{"id": "a", "type": "float", "min": "0"}])")),
               ContainsSubstring("\"min\" must be a number"));
    CHECK_THAT(refused(velvet(R"([{"id": "a", "type": "float", "mim": 0}])")),
               ContainsSubstring("\"params\"[0]: the key \"mim\" is unknown; did you mean \"min\"?"));
    CHECK_THAT(refused(velvet("[]", R"(, "tooltips": "x")")),
               ContainsSubstring("\"materials\"[0]: the key \"tooltips\" is unknown; did you mean \"tooltip\"?"));
    CHECK_THAT(refused(velvet("[]", R"(, "emission": {"radiance": "a", "colour": "b"})")),
               ContainsSubstring("\"emission\": the key \"colour\" is unknown; known keys: radiance, scale"));
    CHECK_THAT(refused(velvet(R"([{"id": "a", "type": "float", "default": 7}])")),
               ContainsSubstring("parameter \"a\": its default is out of its range"));
    CHECK_THAT(refused(velvet(R"([{"id": "a", "type": "color", "default": 1}])")),
               ContainsSubstring("must be three numbers [red, green, blue]"));
    CHECK_THAT(refused(velvet(R"([{"id": "a", "type": "enum", "choices": ["x"], "default": "y"}])")),
               ContainsSubstring("must be one of the choices"));
    CHECK_THAT(refused(velvet("[]", R"(, "flags": ["shiny"])")), ContainsSubstring("\"shiny\" is unknown"));
    CHECK_THAT(refused(velvet("[]", R"(, "prefix": "a__b")")), ContainsSubstring("is not a GLSL identifier"));
    CHECK_THAT(refused(velvet("[]", R"(, "prefix": "material")")), ContainsSubstring("\"material\" is reserved"));
    CHECK_THAT(refused(velvet("[") + "]"), ContainsSubstring("not JSON"));
    const std::string both = json_manifest(velvet("[]"));
    CHECK_THAT(folder.refusal_of(both.substr(0, both.size() - 1) + R"(, "library": "velvet"})", "good"),
               ContainsSubstring("provides \"velvet\" twice"));
}

TEST_CASE("an edited material is reloaded; holders of the previous one keep it", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("velvet", json_manifest(velvet(params)), nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    const auto before = registry.find_material("velvet");
    REQUIRE(before);
    const auto version = registry.version();
    CHECK(registry.reload_changed().empty());
    CHECK(registry.version() == version);

    REQUIRE(write_file_atomic(where / "velvet.glsl", "// something else"));
    auto news = registry.reload_changed();
    REQUIRE(news.size() == 1);
    CHECK(news[0].error.empty());
    CHECK(registry.version() > version);
    const auto edited = registry.find_material("velvet");
    CHECK(edited->source->revision() != before->source->revision());
    CHECK(edited->source->glsl()->begin()->second == "// something else");
    CHECK(before->source->glsl()->begin()->second == "// empty");

    // One parameter fewer; the old table is still complete.
    REQUIRE(write_file_atomic(where / "plugin.json", json_manifest(velvet(R"([{"id": "fuzz", "type": "float"}])"))));
    REQUIRE(registry.reload_changed().size() == 1);
    CHECK(registry.find_material("velvet")->table->params.size() == 1);
    CHECK(before->table->params.size() == 5);
    CHECK(choices_text(before->table->params[4]) == "plain|twill");

    // Reverted: the initial revision.
    REQUIRE(write_file_atomic(where / "plugin.json", json_manifest(velvet(params))));
    REQUIRE(write_file_atomic(where / "velvet.glsl", "// empty"));
    REQUIRE(registry.reload_changed().size() == 1);
    CHECK(registry.find_material("velvet")->source->revision() == before->source->revision());
}

TEST_CASE("an incompatible version is not loaded: the previous one stays", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("velvet", json_manifest(velvet(params)), nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    registry.set_judge([](const MaterialEntry& entry) -> Result<> {
        const std::string& text = entry.source->glsl()->begin()->second;
        return text == "bad" ? fail("velvet.glsl:3: no good") : Result<>();
    });
    const auto still = [&](const std::string& why) {
        const auto news = registry.reload_changed();
        REQUIRE(news.size() == 1);
        CHECK_THAT(news[0].error, ContainsSubstring(why));
        CHECK(registry.find_material("velvet")->table->params.size() == 5);
        CHECK(registry.find_material("velvet")->source->glsl()->begin()->second == "// empty");
        CHECK(news[0].plugin->trouble == news[0].error);
        CHECK(news[0].plugin->state == State::loaded);
        CHECK(registry.reload_changed().empty()); // reported once
    };
    REQUIRE(write_file_atomic(where / "velvet.glsl", "bad"));
    still("velvet.glsl:3: no good");
    REQUIRE(write_file_atomic(where / "plugin.json", "{ \"id\": "));
    still("not JSON");
    REQUIRE(write_file_atomic(where / "plugin.json", json_manifest(velvet(params))));
    REQUIRE(write_file_atomic(where / "velvet.glsl", "good"));
    REQUIRE(registry.reload_changed().size() == 1);
    CHECK(registry.find_material("velvet")->source->glsl()->begin()->second == "good");
    CHECK(registry.entries()[0]->trouble.empty());
}

TEST_CASE("a refused plugin is loaded once it is fixed", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("velvet", "{", nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    CHECK_FALSE(registry.find_material("velvet"));
    REQUIRE(write_file_atomic(where / "plugin.json", json_manifest(velvet(params))));
    REQUIRE(registry.reload_changed().size() == 1);
    CHECK(registry.find_material("velvet"));
    CHECK(registry.entries()[0]->state == State::loaded);
}

TEST_CASE("a library is reloaded a hundred times without leaks", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("velvet", manifest(), "good");
    const int none = open_copies();
    {
        Registry registry(folder.log);
        folder.scan(registry);
        const auto first = registry.find_material("velvet");
        const int one = open_copies();
        CHECK(one > none);
        const fs::path library = where / (std::string("velvet") + Library::extension());
        for (int i = 0; i < 100; ++i) {
            if (i % 2) { // replaced in place, as cp does, while it is in use
                const std::string bytes = read_file(library).value();
                std::ofstream(library, std::ios::binary) << bytes;
            }
            REQUIRE(registry.reload(*registry.entries()[0]));
        }
        CHECK(open_copies() == one);
        CHECK(std::string(first->table->params[0].id) == "fuzz"); // an unloaded library
        const auto said = [&](const char* line) { return std::count(folder.lines.begin(), folder.lines.end(), line); };
        CHECK(said("org.example.velvet: velvet is here") == 101);
        CHECK(said("org.example.velvet: velvet leaves") == 100);
    }
    CHECK(open_copies() == none);
}

TEST_CASE("readers see complete catalogues while plugins are reloaded", "[plugin]") {
    const fs::path built = test::build_dir() / "lib/restage/plugins";
    Folder folder;
    for (const char* name : {"importer-pbrt", "exporter-pbrt", "material-diffuse", "material-conductor"})
        fs::copy(built / name, folder.path / name, fs::copy_options::recursive);
    Registry registry(folder.log);
    folder.scan(registry);
    REQUIRE(registry.importers().size() == 1);
    REQUIRE(registry.materials().size() == 2);
    std::atomic<bool> stop{false};
    std::atomic<int> torn{0}, looks{0};
    const auto look = [&] {
        while (!stop) {
            const auto all = registry.catalogue();
            torn += all->importers.size() != 1 || all->exporters.size() != 1 || all->materials.size() != 2;
            torn += registry.importers().size() != 1 || registry.exporters().size() != 1;
            const auto importer = registry.find_importer("pbrt");
            // The library stays open as long as its entry, whatever is loaded meanwhile.
            torn +=
                !importer || importer->native->probe("x.pbrt", "LookAt", 6) <= 0 || importer->plugin->name().empty();
            torn +=
                !registry.find_exporter("pbrt") || !registry.find_material("diffuse") || registry.find_denoiser("x");
            ++looks;
        }
    };
    std::thread a(look), b(look);
    for (int i = 0; i < 20 || looks < 20; ++i)
        for (const Entry* entry : registry.entries())
            if (!registry.reload(*entry)) ++torn;
    stop = true;
    a.join(), b.join();
    CHECK(torn == 0);
}

TEST_CASE("an importer in use stays open when it is reloaded", "[plugin]") {
    Folder folder;
    fs::copy(test::build_dir() / "lib/restage/plugins/importer-pbrt", folder.path / "importer-pbrt",
             fs::copy_options::recursive);
    Registry registry(folder.log);
    folder.scan(registry);
    const auto held = registry.find_importer("pbrt");
    REQUIRE(held);
    const fs::path library = folder.path / "importer-pbrt" / registry.entries()[0]->manifest.library;
    const std::string bytes = read_file(library).value();
    fs::remove(library); // a new file, as written by a build
    REQUIRE(write_file_atomic(library, bytes));
    const auto news = registry.reload_changed();
    REQUIRE(news.size() == 1);
    CHECK(news[0].error == "");
    CHECK(registry.find_importer("pbrt")->native != held->native);
    CHECK(held->native->probe("x.pbrt", "LookAt", 6) > 0);
}

namespace {

// Runs f with a file as temporary folder, so that nothing can be created in it.
template <class F>
void without_temporary_folder(const Folder& folder, F&& f) {
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before ? before : "";
    REQUIRE(write_file_atomic(folder.path / "no-folder", ""));
    setenv("TMPDIR", (folder.path / "no-folder").c_str(), 1);
    f();
    before ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
}

} // namespace

TEST_CASE("without a temporary folder materials load and reload", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("plugins/velvet", manifest(), "good");
    without_temporary_folder(folder, [&] {
        Registry registry(folder.log);
        registry.scan(std::vector<SearchPath>{{folder.path / "plugins", true}});
        REQUIRE(registry.find_material("velvet"));
        const fs::path library = where / (std::string("velvet") + Library::extension());
        for (int i = 0; i < 5; ++i) {
            const std::string bytes = read_file(library).value();
            std::ofstream(library, std::ios::binary) << bytes; // in place, while it is in use
            REQUIRE(registry.reload(*registry.entries()[0]));
        }
        const auto said = [&](const char* line) { return std::count(folder.lines.begin(), folder.lines.end(), line); };
        CHECK(said("org.example.velvet: velvet is here") == 6); // each time a new library, not the previous one
        CHECK(said("org.example.velvet: velvet leaves") == 5);
        CHECK(folder.lines.size() == 12); // nothing else is logged: nothing is lost
    });
}

TEST_CASE("a crashed plugin stays off until it changes or is enabled", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("plugins/velvet", manifest(), "good");
    const fs::path notes = folder.path / "notes";
    const auto scan = [&](Registry& registry) {
        registry.scan(std::vector<SearchPath>{{folder.path / "plugins", true}});
        return registry.entries().at(0);
    };
    const Quarantine quarantine(notes);
    {
        Registry registry(folder.log, {.quarantine = notes});
        const Entry* entry = scan(registry);
        REQUIRE(entry->state == State::loaded);
        const Blame blame = entry->blame("while it read sofa.vel");
        REQUIRE(write_file_atomic(blame.file, blame.text + "\nSIGSEGV\n")); // as after a crash
    }
    Registry registry(folder.log, {.quarantine = notes});
    const Entry* off = scan(registry);
    CHECK(off->state == State::refused);
    CHECK(off->quarantined);
    CHECK_THAT(off->reason, ContainsSubstring("it crashed (SIGSEGV) while it read sofa.vel; it stays off until"));
    CHECK_THAT(off->reason, ContainsSubstring("restage plugins --enable org.example.velvet"));
    CHECK(quarantine.release("org.example.velvet").value());
    CHECK_FALSE(quarantine.release("org.example.velvet").value());
    Registry again(folder.log, {.quarantine = notes});
    const Entry* on = scan(again);
    CHECK(on->state == State::loaded);

    const Blame blame = on->blame("while it was being loaded");
    REQUIRE(write_file_atomic(blame.file, blame.text + "\nSIGABRT\n"));
    REQUIRE(write_file_atomic(where / "velvet.glsl", "// mended"));
    Registry mended(folder.log, {.quarantine = notes});
    CHECK(scan(mended)->state == State::loaded);
}

TEST_CASE("safe mode loads only the program's own plugins", "[plugin]") {
    Folder folder;
    folder.add("theirs/velvet", manifest(), "good");
    folder.add("ours/velvet", manifest(), "good");
    const std::vector<SearchPath> paths{{folder.path / "theirs", true},
                                        {.folder = folder.path / "ours", .required = true, .own = true}};
    Registry all(folder.log), safe(folder.log, {.safe_mode = true});
    all.scan(paths);
    safe.scan(paths);
    CHECK(all.find_material("velvet")->plugin->folder == folder.path / "theirs/velvet");
    REQUIRE(safe.entries().size() == 1);
    CHECK(safe.find_material("velvet")->plugin->folder == folder.path / "ours/velvet");
}
