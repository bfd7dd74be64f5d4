// SPDX-License-Identifier: Apache-2.0
// plugin: valid plugins load; foreign, too new, broken or missing ones are refused with one sentence, and nothing
// crashes.
#include "plugin/abi.hpp"
#include "plugin/adapters.hpp"
#include "plugin/tables.hpp"
#include "plugin_folder.hpp"

#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cstdlib>
#include <filesystem>

namespace fs = std::filesystem;
using namespace restage;
using namespace restage::plugin;
using Catch::Matchers::ContainsSubstring;

using Folder = restage::test::PluginFolder;
using restage::test::manifest;

TEST_CASE("a valid plugin loads, logs through the host and is shut down", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("materials/velvet", manifest(), "good");
    {
        Registry registry(folder.log);
        folder.scan(registry);
        folder.scan(registry); // the same folder again changes nothing
        REQUIRE(registry.entries().size() == 1);
        INFO(registry.entries()[0]->reason);
        REQUIRE(registry.entries()[0]->state == State::loaded);
        const auto velvet = registry.find_material("velvet");
        REQUIRE(velvet);
        CHECK(velvet->plugin->folder == where);
        CHECK(velvet->table->params.size() == 2);
        CHECK(std::string(velvet->table->params[0].id) == "fuzz");
        CHECK_FALSE(registry.find_material("silk"));
        CHECK(registry.importers().empty());
        CHECK(std::count(folder.lines.begin(), folder.lines.end(), "org.example.velvet: velvet is here") == 1);
    }
    CHECK(std::count(folder.lines.begin(), folder.lines.end(), "org.example.velvet: velvet leaves") == 1);
}

TEST_CASE("the manifest is validated before the library is opened", "[plugin]") {
    Folder folder;
    // The library is always valid: only the manifest can be the reason.
    const auto refused = [&](const std::string& json) { return folder.refusal_of(json, "good"); };
    CHECK_THAT(refused("{\n \"id\": }"), ContainsSubstring("plugin.json:2:8: not JSON"));
    CHECK_THAT(refused(""), ContainsSubstring("plugin.json:1:1: not JSON"));
    CHECK_THAT(refused("[1, 2]"), ContainsSubstring("must be one JSON object"));
    CHECK_THAT(refused(R"({"id": "org.example.velvet"})"), ContainsSubstring("\"version\" is missing"));
    CHECK_THAT(refused(R"({"id": 7})"), ContainsSubstring("\"id\" must be a non-empty string"));
    CHECK_THAT(refused(manifest("\"restage.material/1\"", "", "velvet")), ContainsSubstring("not in reverse-DNS form"));
    const auto provides = [&](const char* list) { return refused(manifest(list)); };
    CHECK_THAT(provides(""), ContainsSubstring("\"provides\" is empty"));
    CHECK_THAT(provides("1"), ContainsSubstring("\"provides\" must be a list of strings"));
    CHECK_THAT(provides(R"("material")"), ContainsSubstring("\"material\" is not an interface"));
    CHECK_THAT(provides(R"("restage.material/0")"), ContainsSubstring("is not an interface"));
    CHECK_THAT(provides(R"("restage.toaster/1")"),
               ContainsSubstring("provides restage.toaster/1, which this program cannot use"));
    CHECK_THAT(provides(R"("restage.material/2")"), ContainsSubstring("the plugin is too new"));
    const auto needs = [&](const char* members) { return refused(manifest("\"restage.material/1\"", members)); };
    CHECK_THAT(needs(R"("host": 2)"), ContainsSubstring("\"host\" must be a non-empty string"));
    CHECK_THAT(needs(R"("host": "new")"), ContainsSubstring("\"new\" is not a version range"));
    CHECK_THAT(needs(R"("host": ">=0.2 0.4")"), ContainsSubstring("is not a version range"));
    CHECK_THAT(needs(R"("host": ">=9.1")"), ContainsSubstring("needs Restage >=9.1, this is "));
    CHECK_THAT(needs(R"("host": ">=9.1")"), ContainsSubstring("the plugin is too new; update the program"));
    CHECK_THAT(needs(R"("host": ">=0.1 <0.2")"), ContainsSubstring("the plugin is too old; update the plugin"));
    CHECK_THAT(needs(R"("interfaces": ["restage.toaster/1"])"),
               ContainsSubstring("needs restage.toaster/1, which this program does not have"));
    CHECK_THAT(needs(R"("hots": ">=0.2")"),
               ContainsSubstring("\"needs\": the key \"hots\" is unknown; known keys: host, interfaces"));
    // Manifests of 0.1, before bundles.
    CHECK_THAT(refused(R"({"id":"org.example.velvet","kind":"material","version":"1.0.0","licence":"MIT","abi":1,)"
                       R"("library":"velvet"})"),
               ContainsSubstring("belong to Restage 0.1: write, for example, \"provides\""));
    const std::string body = R"({"id":"org.example.velvet","provides":["restage.material/1"],"version":"1.0.0",)"
                             R"("licence":"MIT",)";
    CHECK_THAT(refused(body + R"("library":"../velvet"})"), ContainsSubstring("not a path inside the plugin's folder"));
    CHECK_THAT(refused(body + R"("library":"/lib/libc.so.6"})"), ContainsSubstring("not a path inside"));
    CHECK_THAT(refused(body + R"("library":"velvet","files":["gone.glsl"]})"),
               ContainsSubstring("gone.glsl is missing"));
    CHECK_THAT(refused(body + R"("library":"velvet","files":"velvet.glsl"})"), ContainsSubstring("must be a list"));
    CHECK(std::none_of(folder.lines.begin(), folder.lines.end(),
                       [](const auto& line) { return line.find("velvet is here") != std::string::npos; }));
}

TEST_CASE("an incompatible library is refused with the reason", "[plugin]") {
    Folder folder;
    const auto refused = [&](const char* library) { return folder.refusal_of(manifest(), library); };
    CHECK_THAT(refused(nullptr), ContainsSubstring("the library is missing"));
    CHECK_THAT(refused("no_symbol"), ContainsSubstring("exports no symbol \"restage_plugin\""));
    CHECK_THAT(refused("other_abi"), ContainsSubstring("was built for plugin interface 77"));
    CHECK_THAT(refused("small_entry"), ContainsSubstring("its entry table has 8 bytes"));
    CHECK_THAT(refused("init_fails"), ContainsSubstring("its init function reports failure"));
    CHECK_THAT(refused("no_tables"), ContainsSubstring("provides no restage.material/1"));
    CHECK_THAT(refused("small_table"), ContainsSubstring("its table restage.material/1 has 16 bytes"));
    CHECK_THAT(refused("bad_prefix"), ContainsSubstring("\"gl_velvet\" is not a GLSL identifier"));
    CHECK_THAT(refused("bad_param_id"), ContainsSubstring("parameter 0: \"float\" is a reserved word of GLSL"));
    CHECK_THAT(refused("bad_default"), ContainsSubstring("parameter \"fuzz\": its default is out of its range"));
    CHECK_THAT(refused("bad_enum"), ContainsSubstring("parameter \"weave\": its default is not the index of a choice"));
    CHECK_THAT(refused("table_unread"),
               ContainsSubstring("has a table parameter, but the plugin provides no reader for it"));
    CHECK_THAT(refused("table_of_none"), ContainsSubstring("reads tables for \"velvet\", which is not one of its"));
    CHECK_THAT(refused("table_default_gone"), ContainsSubstring("gone.dat, is missing"));
    CHECK_THAT(refused("twice"), ContainsSubstring("provides \"velvet\" twice"));
    CHECK_THAT(refused("endless"), ContainsSubstring("without end"));
    CHECK_THAT(refused("unresolved"), ContainsSubstring("a_function_nobody_has"));
    CHECK_THAT(folder.refusal_of(manifest("\"restage.material/1\"", "", "org.example.silk"), "good"),
               ContainsSubstring("its id is \"org.example.velvet\""));
    CHECK_THAT(folder.refusal_of(manifest("\"restage.importer/1\""), "good"),
               ContainsSubstring("provides no restage.importer/1"));
}

TEST_CASE("a file that is not a library for this machine is refused, not opened", "[plugin]") {
    Folder folder;
    const std::string good = read_file(test::built_plugins / (std::string("good") + Library::extension())).value();
    const auto refused = [&](const std::string& bytes) {
        fs::remove_all(folder.path);
        const fs::path where = folder.add("p", manifest(), nullptr);
        REQUIRE(write_file_atomic(where / (std::string("velvet") + Library::extension()), bytes));
        return folder.refusal();
    };
    CHECK_THAT(refused("#!/bin/sh\necho I am a script\n"), ContainsSubstring("is not a shared library"));
    CHECK_THAT(refused(""), ContainsSubstring("is not a shared library"));
    std::string foreign = good;
    foreign[18] = 8; // e_machine: MIPS
    CHECK_THAT(refused(foreign), ContainsSubstring("built for another processor"));
    foreign = good;
    foreign[4] = 1; // 32 bit
    CHECK_THAT(refused(foreign), ContainsSubstring("built for another processor"));
    for (const std::size_t part : {20u, 100u, 1000u})
        CHECK_THAT(refused(good.substr(0, part)), ContainsSubstring("is truncated"));
    CHECK_THAT(refused(good.substr(0, good.size() / 3)), ContainsSubstring("is truncated"));
}

TEST_CASE("a misspelt key of a manifest is named with its place and the nearest known one", "[plugin]") {
    Folder folder;
    const auto with = [&](const std::string& keys) {
        return R"({"id": "org.example.velvet", "provides": ["restage.material/1"],
  "version": "1.0.0", "licence": "MIT", "needs": {"host": ">=0.2"}, "library": "velvet")" +
               keys + "}";
    };
    CHECK_THAT(folder.refusal_of(with(R"(,
  "file": ["velvet.glsl"])"),
                                 "good"),
               ContainsSubstring("plugin.json:3:3: the key \"file\" is unknown; did you mean \"files\"?"));
    CHECK_THAT(
        folder.refusal_of(with(R"(, "x-files": {"exceptoins": [1, "\"exceptoins\""]}, "exceptoins": [])"), "good"),
        ContainsSubstring("plugin.json:2:140: the key \"exceptoins\" is unknown; did you mean \"exceptions\"?"));
    CHECK_THAT(folder.refusal_of(with(R"(, "homepage": "example.org")"), "good"),
               ContainsSubstring("the key \"homepage\" is unknown; known keys: id, version"));
    CHECK_THAT(folder.refusal_of(with(R"(, "homepage": "example.org")"), "good"),
               ContainsSubstring("custom keys begin with \"x-\""));
    const auto exceptions = [&](const std::string& list) {
        return folder.refusal_of(with(", \"exceptions\": " + list), "good");
    };
    CHECK_THAT(exceptions(R"({"step": "energy"})"), ContainsSubstring("\"exceptions\" must be a list"));
    CHECK_THAT(exceptions("[1]"), ContainsSubstring("\"exceptions\"[0] must be an object"));
    CHECK_THAT(exceptions(R"([{"step": "energy", "limit": 1.1, "why": "x"}, {"stp": "energy"}])"),
               ContainsSubstring("\"exceptions\"[1]: the key \"stp\" is unknown; did you mean \"step\"?"));
    CHECK_THAT(exceptions(R"([{"step": "energy", "limit": "1.1", "why": "x"}])"),
               ContainsSubstring("\"limit\" must be a number"));
    CHECK_THAT(exceptions(R"([{"step": "energy", "limit": 1.1}])"), ContainsSubstring("\"why\" is missing"));
    fs::remove_all(folder.path);
    folder.add("p", with(R"(, "x-homepage": "example.org", "exceptions": [])"), "good");
    Registry registry(folder.log);
    folder.scan(registry);
    CHECK(registry.find_material("velvet"));
}

TEST_CASE("the message for a plugin that is not built says how to build it", "[plugin]") {
    Folder folder;
    CHECK_THAT(folder.refusal_of(manifest(), nullptr),
               ContainsSubstring("the library is missing: the plugin is not built"));
    fs::remove_all(folder.path);
    const fs::path where = folder.add("p", manifest(), nullptr);
    REQUIRE(write_file_atomic(where / "CMakeLists.txt", ""));
    const std::string reason = folder.refusal();
    CHECK_THAT(reason, ContainsSubstring("this folder holds the plugin's sources"));
    CHECK_THAT(reason, ContainsSubstring("cmake -B build"));
    CHECK_THAT(reason, ContainsSubstring((where / "build/lib/restage/plugins").string()));
}

TEST_CASE("GLSL keywords are not valid parameter names", "[plugin]") {
    // Samples of each family, each tried with glslang as a struct member in a composed shader.
    for (const char* word : {"sampler",
                             "samplerShadow",
                             "usampler2DArray",
                             "sampler2DRectShadow",
                             "image2D",
                             "iimage2DMSArray",
                             "image3D",
                             "texture2D",
                             "utextureBuffer",
                             "subpassInput",
                             "usubpassInputMS",
                             "samplerCubeArrayShadow",
                             "vec3",
                             "bvec2",
                             "f16vec4",
                             "i64vec2",
                             "hvec3",
                             "mat4x3",
                             "dmat2",
                             "uint64_t",
                             "float16_t",
                             "atomic_uint",
                             "rayPayloadEXT",
                             "accelerationStructureEXT",
                             "nonprivate",
                             "pervertexEXT",
                             "precise",
                             "half",
                             "long",
                             "address",
                             "length",
                             "Material",
                             "VULKAN",
                             "GL_EXT_ray_tracing",
                             "RESTAGE_LIB_RNG"}) {
        INFO(word);
        CHECK_FALSE(is_glsl_identifier(word));
        const model::Param param{.id = word, .label = "x", .type = model::ParamType::boolean};
        CHECK_THAT(check_params({&param, 1}), ContainsSubstring(std::string("\"") + word + "\" is a reserved word"));
    }
    for (const char* name :
         {"tint", "textures", "texture_scale", "vector", "matte", "int_size", "imagery", "samples", "vec", "mat5",
          "ivec5", "texture", "mix", "clamp", "color", "material", "normalize", "PI", "main"})
        CHECK(is_glsl_identifier(name));
}

TEST_CASE("missing GLSL refuses the material", "[plugin]") {
    Folder folder;
    const fs::path where = folder.add("p", manifest(), "good");
    fs::remove(where / "velvet.glsl");
    CHECK_THAT(folder.refusal(), ContainsSubstring("velvet.glsl is missing"));
}

TEST_CASE("of two plugins with the same id the first in the search order is used", "[plugin]") {
    Folder folder;
    const fs::path first = folder.add("a", manifest(), "good");
    folder.add("b", manifest(), "good");
    Registry registry(folder.log);
    folder.scan(registry);
    REQUIRE(registry.entries().size() == 2);
    CHECK(registry.find_material("velvet")->plugin->folder == first);
    CHECK_THAT(registry.entries()[1]->reason, ContainsSubstring("is already loaded from " + first.string()));
}

TEST_CASE("a broken plugin does not block a valid one with the same id", "[plugin]") {
    Folder folder;
    folder.add("a", manifest(), "init_fails");
    const fs::path second = folder.add("b", manifest(), "good");
    Registry registry(folder.log);
    folder.scan(registry);
    REQUIRE(registry.find_material("velvet"));
    CHECK(registry.find_material("velvet")->plugin->folder == second);
}

TEST_CASE("RESTAGE_PLUGIN_PATH is searched between the user's folder and the installation", "[plugin]") {
    setenv("RESTAGE_PLUGIN_PATH", "/one::/two:", 1);
    setenv("XDG_DATA_HOME", "/home/of/data", 1);
    const auto paths = Registry::default_paths();
    unsetenv("RESTAGE_PLUGIN_PATH");
    unsetenv("XDG_DATA_HOME");
    REQUIRE(paths.size() == 4);
    CHECK(paths[0].folder == "/home/of/data/restage/plugins");
    CHECK(paths[1].folder == "/one");
    CHECK(paths[2].folder == "/two");
    CHECK(paths[2].required);
    CHECK(paths[3].folder.string().ends_with("/lib/restage/plugins"));
    Folder folder;
    Registry registry(folder.log);
    registry.scan(std::vector<SearchPath>{{"/no/such/folder", true}, {"/nor/this", false}});
    REQUIRE(folder.lines.size() == 1);
    CHECK_THAT(folder.lines[0], ContainsSubstring("/no/such/folder does not exist"));
}

TEST_CASE("identifiers and tables are checked against GLSL's rules", "[plugin]") {
    CHECK(is_glsl_identifier("uroughness"));
    CHECK(is_glsl_identifier("_x9"));
    for (const char* bad : {"", "9x", "a-b", "gl_x", "a__b", "sample", "vec3", "a b", "ä"})
        CHECK_FALSE(is_glsl_identifier(bad));
    const model::Param twice[] = {{.id = "a", .label = "A", .type = model::ParamType::boolean},
                                  {.id = "a", .label = "A", .type = model::ParamType::boolean}};
    CHECK(check_params(twice) == "parameter \"a\" is a duplicate");
    const model::Param texturable[] = {
        {.id = "a", .label = "A", .type = model::ParamType::integer, .texturable = true}};
    CHECK(check_params(texturable) == "parameter \"a\": only FLOAT and COLOR can be texturable");
    const model::Param beyond[] = {
        {.id = "a", .label = "A", .type = model::ParamType::integer, .int_min = 1, .int_max = 3, .int_def = 4}};
    CHECK(check_params(beyond) == "parameter \"a\": its default is out of its range");
    CHECK(read_params(nullptr, 1).error().message == "its parameter table is missing");
    const RestageParam unknown{.type = 99, .id = "a", .label = "A"};
    CHECK(read_params(&unknown, 1).error().message == "parameter \"a\": its type 99 is unknown");
}

TEST_CASE("structs that grow at their end are read up to the members known to both sides", "[plugin]") {
    // Built with a future SDK: two lines, each longer than ours.
    struct Longer {
        RestageParam known;
        double more[2];
    };
    Longer longer[2] = {{RESTAGE_FLOAT_PARAM("a", "A", 0, 1, 0.25f, RESTAGE_PARAM_TEXTURABLE, "m", "One."), {7, 7}},
                        {RESTAGE_INT_PARAM("b", "B", -(1 << 30), 1 << 30, 16777217, 0, "", "Two."), {7, 7}}};
    for (Longer& line : longer)
        line.known.size = sizeof(Longer);
    const auto lines = read_params(&longer[0].known, 2);
    REQUIRE(lines);
    REQUIRE(lines->size() == 2);
    CHECK(((*lines)[0].id == "a" && (*lines)[0].def[0] == 0.25f && (*lines)[0].texturable));
    CHECK(((*lines)[1].id == "b" && (*lines)[1].int_def == 16777217 && (*lines)[1].tooltip == "Two."));
    // And with an earlier one: without unit, choices and tooltip, which are not read.
    struct Shorter {
        char bytes[offsetof(RestageParam, unit)];
    };
    Shorter shorter[2];
    for (int i = 0; i < 2; ++i) {
        longer[i].known.size = sizeof(Shorter);
        std::memcpy(&shorter[i], &longer[i].known, sizeof(Shorter));
    }
    const auto old = read_params(reinterpret_cast<const RestageParam*>(shorter), 2);
    REQUIRE(old);
    REQUIRE(old->size() == 2);
    CHECK(((*old)[0].def[0] == 0.25f && (*old)[0].unit.empty() && (*old)[0].tooltip.empty()));
    CHECK((*old)[1].int_max == 1 << 30);
    // A caller with a shorter struct is not written past its end.
    struct {
        RestageValue value{};
        std::uint32_t behind = 0xabcd;
    } asked;
    asked.value.size = offsetof(RestageValue, text);
    asked.value.text = "mine";
    give(&asked.value, RestageValue{.type = RESTAGE_INT, .id = "b", .i = 5, .text = "theirs"});
    CHECK((asked.value.i == 5 && std::string(asked.value.text) == "mine" && asked.behind == 0xabcd));
    CHECK(asked.value.size == offsetof(RestageValue, text));
}
