// SPDX-License-Identifier: Apache-2.0
// GLSL to SPIR-V: includes, where errors point, and the disk cache.
#include "gpu/float_controls.hpp"
#include "gpu/includes.hpp"
#include "test_device.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>

#include <algorithm>
#include <fstream>
#include <spirv-tools/libspirv.hpp>
#include <thread>

using namespace restage;
using namespace restage::gpu;
using namespace restage::gpu::test;
using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::StartsWith;

namespace {

const std::string head = "#version 460\nlayout(local_size_x = 1) in;\n"; // two lines

std::string error_of(const ShaderCompiler& compiler, const ShaderSource& source) {
    const auto result = compiler.compile(source);
    REQUIRE_FALSE(result.has_value());
    return result.error().message;
}

} // namespace

TEST_CASE("an error points at the line of the text itself", "[compiler]") {
    const ShaderCompiler compiler({});
    const std::string error =
        error_of(compiler, {.name = "wave.comp", .text = head + "void main() {\n    float x = y;\n}\n"});
    CHECK_THAT(error, StartsWith("wave.comp:4: "));
    CHECK_THAT(error, ContainsSubstring("'y' : undeclared identifier"));
    CHECK_THAT(error, !ContainsSubstring("No code generated"));
    // Definitions come before the text and do not shift its lines.
    CHECK_THAT(error_of(compiler, {.name = "wave.comp",
                                   .text = head + "void main() {\n    float x = y;\n}\n",
                                   .defines = {{"A", "1"}, {"B", "2"}}}),
               StartsWith("wave.comp:4: "));
}

TEST_CASE("an error points at the included file, on disk and in memory, and lines after an include are correct",
          "[compiler]") {
    const TemporaryFolder folder;
    folder.write("plugin oak/oak.glsl", "// oak\n#include \"grain.glsl\"\nfloat oak() { return grain() * zz; }\n");
    folder.write("plugin oak/grain.glsl", "#pragma once\n\nfloat grain() { return 1.0; }\n");
    const ShaderCompiler compiler({.include_dirs = {folder.path()}});
    const std::string oak = (folder.path() / "plugin oak/oak.glsl").string();

    CHECK_THAT(
        error_of(compiler, {.name = "main", .text = head + "#include \"plugin oak/oak.glsl\"\nvoid main() {}\n"}),
        StartsWith(oak + ":3: 'zz'"));
    CHECK_THAT(error_of(compiler, {.name = "main",
                                   .text = head + "#include \"memory.glsl\"\nvoid main() {}\n",
                                   .files = {{"memory.glsl", "\n\n\nint f() { return q; }\n"}}}),
               StartsWith("memory.glsl:4: 'q'"));
    CHECK_THAT(error_of(compiler, {.name = "main",
                                   .text = head + "#include \"memory.glsl\"\nvoid main() {\n  w;\n}\n",
                                   .files = {{"memory.glsl", "int f() { return 1; }\nint g() { return 1; }\n"}}}),
               StartsWith("main:5: 'w'"));
    // A file in memory may include one on disk; errors in a macro are reported at its use.
    CHECK_THAT(error_of(compiler,
                        {.name = "main",
                         .text = head + "#include \"memory.glsl\"\nvoid main() { }\n",
                         .files = {{"memory.glsl", "#include \"plugin oak/grain.glsl\"\nfloat f() { return hh; }\n"}}}),
               StartsWith("memory.glsl:2: 'hh'"));
}

TEST_CASE("a failed include is reported at its line, and only if that line is compiled", "[compiler]") {
    const ShaderCompiler compiler({});
    CHECK_THAT(error_of(compiler, {.name = "main", .text = head + "#include \"nowhere.glsl\"\nvoid main() {}\n"}),
               StartsWith("main:3: ") && ContainsSubstring("nowhere.glsl"));
    CHECK_THAT(error_of(compiler, {.name = "main", .text = head + "#include nonsense\nvoid main() {}\n"}),
               StartsWith("main:3: "));
    CHECK(compiler.compile(
        {.name = "main", .text = head + "#if 0\n#include \"nowhere.glsl\"\n#endif\nvoid main() {}\n"}));
    CHECK(compiler.compile({.name = "main", .text = head + "/*\n#include \"nowhere.glsl\"\n*/\nvoid main() {}\n"}));
    CHECK(compiler.compile({.name = "main", .text = head + "// x /*\n// #include \"nowhere.glsl\"\nvoid main() {}\n"}));
}

TEST_CASE("#pragma once includes once, also under #if and in a cycle", "[compiler]") {
    const ShaderCompiler compiler({});
    const std::map<std::string, std::string> files{
        {"a.glsl", "#pragma once\n#include \"b.glsl\"\nint a() { return 1; }\n"},
        {"b.glsl", "#pragma once\n#include \"a.glsl\"\nint b() { return 2; }\n"}};
    const std::string use = "layout(binding = 0) buffer B { int v; };\nvoid main() { v = a() + b(); }\n";
    CHECK(compiler.compile({.name = "m",
                            .text = head + "#include \"a.glsl\"\n#include \"b.glsl\"\n#include \"a.glsl\"\n" + use,
                            .files = files}));
    // The first inclusion is not compiled, so the second must count.
    CHECK(compiler.compile({.name = "m",
                            .text = head + "#if 0\n#include \"a.glsl\"\n#endif\n#include \"a.glsl\"\n" + use,
                            .files = files}));
    // Without it: included twice, and a cycle is an error.
    CHECK_THAT(error_of(compiler, {.name = "m",
                                   .text = head + "#include \"c.glsl\"\n#include \"c.glsl\"\nvoid main() {}\n",
                                   .files = {{"c.glsl", "int c() { return 1; }\n"}}}),
               StartsWith("c.glsl:1: "));
    CHECK_THAT(error_of(compiler, {.name = "m",
                                   .text = head + "#include \"c.glsl\"\nvoid main() {}\n",
                                   .files = {{"c.glsl", "int c() { return 1; }\n#include \"c.glsl\"\n"}}}),
               StartsWith("c.glsl:2: ") && ContainsSubstring("includes itself"));
}

TEST_CASE("files are searched in order: memory, the includer's folder, the source's folders, the compiler's",
          "[compiler]") {
    const TemporaryFolder folder;
    folder.write("late/f.glsl", "#define WHO 4\n");
    folder.write("early/f.glsl", "#define WHO 3\n");
    folder.write("beside/f.glsl", "#define WHO 2\n");
    folder.write("beside/entry.glsl", "#include \"f.glsl\"\n");
    const ShaderCompiler compiler({.include_dirs = {folder.path() / "late", folder.path() / "beside"}});
    const auto who = [&](const std::string& text, std::map<std::string, std::string> files, bool early) {
        std::vector<std::filesystem::path> dirs;
        if (early) dirs.push_back(folder.path() / "early");
        for (int i = 1; i <= 4; ++i)
            if (compiler.compile({.name = "m",
                                  .text = head + text + "\n#if WHO != " + std::to_string(i) +
                                          "\n#error no\n#endif\nvoid main() {}\n",
                                  .files = files,
                                  .include_dirs = dirs}))
                return i;
        return 0;
    };
    CHECK(who("#include \"f.glsl\"", {{"f.glsl", "#define WHO 1\n"}}, true) == 1);
    CHECK(who("#include \"entry.glsl\"", {}, true) == 2);
    CHECK(who("#include <f.glsl>", {}, true) == 3);
    CHECK(who("#include \"f.glsl\"", {}, false) == 4);
}

TEST_CASE("files of a plugin can include only the library and each other", "[compiler]") {
    const TemporaryFolder folder;
    folder.write("shaders/restage/v1/wood.glsl", "#include \"lib/rings.glsl\"\n#define WOOD 1\n");
    folder.write("shaders/lib/rings.glsl", "#define RINGS 1\n");
    folder.write("shaders/lib/private.glsl", "#include \"oak.glsl\"\n");
    folder.write("oak/grain.glsl", "#define GRAIN 1\n");
    folder.write("oak/parts/knot.glsl", "#include \"../grain.glsl\"\n#include \"grain.glsl\"\n");
    folder.write("oak/lib/rings.glsl", "#error hides a file of the host's\n");
    folder.write("elm/leaf.glsl", "#define LEAF 1\n");
    const ShaderCompiler compiler({.include_dirs = {folder.path() / "shaders"}});
    const auto error = [&](const std::string& oak) {
        folder.write("oak/oak.glsl", oak);
        const auto done = compiler.compile({.name = "main",
                                            .text = head + "#include <plugin/oak.glsl>\nvoid main() {}\n",
                                            .plugin_folders = {folder.path() / "oak"}});
        return done ? std::string() : done.error().message.substr(folder.path().string().size() + 1);
    };
    CHECK(error("#include <restage/v1/wood.glsl>\n#include \"parts/knot.glsl\"\n"
                "#if !defined(WOOD) || !defined(RINGS) || !defined(GRAIN)\n#error no\n#endif\n") == "");
    const std::string rule = "a plugin's GLSL may include <restage/v1/...> and files of its own folder";
    CHECK_THAT(error("\n#include \"lib/wood.glsl\"\n"),
               StartsWith("oak/oak.glsl:2: cannot include \"lib/wood.glsl\": write <restage/v1/wood.glsl>"));
    for (const char* other : {"\"lib/private.glsl\"", "<lib/rings.glsl>", "\"../elm/leaf.glsl\"", "\"/etc/hosts\"",
                              "<plugin/../elm/leaf.glsl>", "<restage/v1/../../lib/private.glsl>"})
        CHECK_THAT(
            error("#include " + std::string(other) + "\n"),
            StartsWith("oak/oak.glsl:1: cannot include " + std::string(other) + ": ") && ContainsSubstring(rule));
    CHECK_THAT(error("#include <restage/v1/iron.glsl>\n"),
               StartsWith("oak/oak.glsl:1: cannot include <restage/v1/iron.glsl>: there is no such file; " + rule));
    for (const char* word : {"layout", "uniform", "buffer", "shared", "gl_WorkGroupID"})
        CHECK_THAT(error("/* layout\nbuffer */ // uniform\nfloat x = 1; " + std::string(word) + " y;\n"),
                   StartsWith("oak/oak.glsl:3: \"" + std::string(word) + "\": a plugin's GLSL has no"));
    CHECK(error("float layouts(float a_buffer) { return a_buffer; } // shared\n") == "");
    CHECK_THAT(error("#extension GL_EXT_buffer_reference : require\n"), StartsWith("oak/oak.glsl:1: "));
    CHECK_THAT(error_of(compiler, {.name = "main",
                                   .text = head + "#include \"oak.glsl\"\nvoid main() {}\n",
                                   .plugin_folders = {folder.path() / "oak"}}),
               StartsWith("main:3: cannot find the file oak.glsl"));
}

TEST_CASE("the files of a shader are listed once each", "[compiler]") {
    const TemporaryFolder folder;
    folder.write("a.glsl", "#pragma once\n#include \"b.glsl\"\n");
    folder.write("b.glsl", "#pragma once\n");
    const ShaderCompiler compiler({.include_dirs = {folder.path()}});
    const auto spirv = value(
        compiler.compile({.name = "m", .text = head + "#include \"a.glsl\"\n#include \"b.glsl\"\nvoid main() {}\n"}));
    CHECK(spirv.files == std::vector{std::filesystem::canonical(folder.path() / "a.glsl"),
                                     std::filesystem::canonical(folder.path() / "b.glsl")});
}

TEST_CASE("the cache returns compiled code, and detects every change", "[compiler]") {
    const TemporaryFolder folder;
    folder.write("part.glsl", "#define N 1\n");
    const ShaderCompilerOptions options{.include_dirs = {folder.path()}, .cache_dir = folder.path() / "cache"};
    ShaderSource source{.name = "m",
                        .text = head +
                                "#include \"part.glsl\"\nlayout(binding = 0) buffer B { int v; };\n"
                                "#ifndef M\n#define M 0\n#endif\nvoid main() { v = N + M; }\n"};
    const ShaderCompiler compiler(options);
    const Spirv first = value(compiler.compile(source));
    CHECK_FALSE(first.from_cache);
    const Spirv again = value(ShaderCompiler(options).compile(source));
    CHECK(again.from_cache);
    CHECK(again.words == first.words);
    CHECK(again.key == first.key);
    CHECK(again.files == first.files);

    source.name = "renamed"; // does not go into the code
    CHECK(value(compiler.compile(source)).from_cache);
    source.defines = {{"M", "5"}};
    const Spirv defined = value(compiler.compile(source));
    CHECK_FALSE(defined.from_cache);
    CHECK(defined.words != first.words);
    source.defines.clear();
    folder.write("part.glsl", "#define N 2\n");
    CHECK_FALSE(value(compiler.compile(source)).from_cache);
    folder.write("part.glsl", "#define N 1\n");
    CHECK(value(compiler.compile(source)).words == first.words);
    ShaderCompilerOptions plain = options;
    plain.optimize = false;
    CHECK_FALSE(value(ShaderCompiler(plain).compile(source)).from_cache);
}

TEST_CASE("a damaged cache entry is recompiled", "[compiler]") {
    const TemporaryFolder folder;
    const ShaderCompiler compiler({.cache_dir = folder.path() / "cache"});
    const ShaderSource source{.name = "m", .text = head + "void main() {}\n"};
    const Spirv first = value(compiler.compile(source));
    const auto file = folder.path() / "cache" / (first.key + ".spv");
    const std::string good = value(read_file(file));
    std::string flipped = good;
    flipped[flipped.size() - 3] ^= 0x10;
    for (const std::string& bad : {std::string(), good.substr(0, good.size() / 2), good.substr(0, good.size() - 4),
                                   flipped, std::string(good.size(), '\0')}) {
        ok(write_file_atomic(file, bad));
        const Spirv spirv = value(compiler.compile(source));
        CHECK_FALSE(spirv.from_cache);
        CHECK(spirv.words == first.words);
        CHECK(value(compiler.compile(source)).from_cache); // and was repaired
    }
}

TEST_CASE("many threads compile at once into one cache", "[compiler]") {
    const TemporaryFolder folder;
    const ShaderCompiler compiler({.cache_dir = folder.path() / "cache"});
    std::vector<std::thread> threads;
    std::vector<std::vector<std::uint32_t>> words(8);
    for (std::size_t t = 0; t < words.size(); ++t)
        threads.emplace_back([&, t] {
            auto spirv =
                compiler.compile({.name = "m",
                                  .text = head + "layout(binding = 0) buffer B { int v; };\nvoid main() { v = K; }\n",
                                  .defines = {{"K", std::to_string(t % 2)}}});
            if (spirv) words[t] = spirv->words;
        });
    for (std::thread& thread : threads)
        thread.join();
    for (std::size_t t = 0; t < words.size(); ++t) {
        CHECK_FALSE(words[t].empty());
        CHECK(words[t] == words[t % 2]);
    }
    CHECK(words[0] != words[1]);
}

TEST_CASE("a shader requests once that its device preserve NaN, and stays a valid module", "[compiler]") {
    const ShaderCompiler compiler({});
    const auto spirv = compiler.compile({.name = "k", .text = head + "void main() {}\n"});
    REQUIRE(spirv);
    const auto kept = keep_nan(spirv->words);
    // OpCapability SignedZeroInfNanPreserve, OpExecutionMode <entry> SignedZeroInfNanPreserve 32
    REQUIRE(kept.size() == spirv->words.size() + 6);
    CHECK(kept[5] == (2u << 16 | 17));
    CHECK(kept[6] == 4466);
    const std::uint32_t mode[] = {4461, 32};
    const auto at = std::search(kept.begin(), kept.end(), std::begin(mode), std::end(mode));
    REQUIRE(at != kept.end());
    CHECK(*(at - 2) == (4u << 16 | 16));
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
    CHECK(tools.Validate(kept));
    CHECK(keep_nan(kept) == kept);
    const std::vector<std::uint32_t> broken(kept.begin(), kept.begin() + 9);
    CHECK(keep_nan(broken) == broken);
}

TEST_CASE("every ray-tracing stage compiles", "[compiler]") {
    const ShaderCompiler compiler({});
    const std::string rt = "#version 460\n#extension GL_EXT_ray_tracing : require\n";
    const std::string payload = "layout(location = 0) rayPayloadInEXT vec4 p;\nhitAttributeEXT vec2 b;\n";
    CHECK(compiler.compile({.name = "a",
                            .text = rt + "layout(location = 0) rayPayloadEXT vec4 p;\nvoid main() {}\n",
                            .stage = ShaderStage::raygen}));
    CHECK(compiler.compile(
        {.name = "b", .text = rt + payload + "void main() { p.xy = b; }\n", .stage = ShaderStage::closest_hit}));
    CHECK(compiler.compile({.name = "c",
                            .text = rt + payload + "void main() { ignoreIntersectionEXT; }\n",
                            .stage = ShaderStage::any_hit}));
    CHECK(compiler.compile({.name = "d",
                            .text = rt + "layout(location = 0) rayPayloadInEXT vec4 p;\nvoid main() { p = vec4(0); }\n",
                            .stage = ShaderStage::miss}));
    CHECK(
        compiler.compile({.name = "e",
                          .text = rt + "layout(location = 0) callableDataInEXT vec4 p;\nvoid main() { p = vec4(0); }\n",
                          .stage = ShaderStage::callable}));
    CHECK_THAT(
        error_of(compiler,
                 {.name = "f", .text = rt + "void main() { ignoreIntersectionEXT; }\n", .stage = ShaderStage::miss}),
        StartsWith("f:3: "));
    // A text without main() is reported as an error.
    CHECK_THAT(error_of(compiler, {.name = "g", .text = "#version 460\n"}),
               StartsWith("g: ") && ContainsSubstring("entry point"));
}
