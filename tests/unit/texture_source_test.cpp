// SPDX-License-Identifier: Apache-2.0
// Textures declared by plugins in plugin.json: found by type, refused with a reason, listed, reloaded.
#include "plugin/texture_source.hpp"
#include "plugin/provides.hpp"
#include "plugin_folder.hpp"

#include <catch2/matchers/catch_matchers_string.hpp>

using namespace restage;
using namespace restage::plugin;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string stripes(const std::string& params, const std::string& rest = "", const char* id = "org.example.stripes",
                    const char* type = "stripes", const char* prefix = "stripes") {
    return std::string(R"({"id": ")") + id +
           R"(", "provides": ["restage.texture/1"], "version": "1.0.0", "licence": "MIT", "textures": [{"type": ")" +
           type + R"(", "label": "Stripes", "prefix": ")" + prefix + R"(", "glsl": "velvet.glsl", )" + rest +
           R"("params": [)" + params + "]}]}";
}
constexpr const char* color = R"({"id": "one", "type": "color", "flags": ["texturable"], "default": [1, 0, 0]})";

} // namespace

TEST_CASE("a texture without native code is read from its manifest", "[texture]") {
    test::PluginFolder folder;
    folder.add("stripes", stripes(color, R"("flags": ["mapped", "site"], )"), nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    const auto found = registry.find_texture("stripes");
    REQUIRE(found);
    CHECK(found->table->label == "Stripes");
    CHECK(found->table->mapped);
    CHECK(found->table->site);
    CHECK(!found->table->image);
    REQUIRE(found->table->params.size() == 1);
    CHECK(found->table->params[0].texturable);
    CHECK(found->source->eval() == nullptr);
    CHECK(found->source->glsl()->size() == 1);
    CHECK(provides(registry, *registry.entries()[0]) == std::vector<std::string>{"texture stripes"});
    CHECK(registry.entries()[0]->manifest.kind() == "texture");
    CHECK(!registry.find_texture("dots"));
}

TEST_CASE("errors in a texture's table are reported with their place", "[texture]") {
    test::PluginFolder folder;
    const auto refusal = [&](const std::string& json) { return folder.refusal_of(json, nullptr); };
    CHECK_THAT(refusal(stripes(R"({"id": "one", "type": "colour"})")),
               ContainsSubstring(R"("textures"[0]."params"[0]: "type": "colour" is unknown; known: float, color)"));
    CHECK_THAT(refusal(stripes(color, R"("flags": ["maped"], )")), ContainsSubstring("known: image, mapped, site"));
    CHECK_THAT(refusal(stripes(color, R"("gsl": "x", )")), ContainsSubstring("did you mean \"glsl\"?"));
    CHECK_THAT(refusal(stripes(R"({"id": "uscale", "type": "float"})", R"("flags": ["mapped"], )")),
               ContainsSubstring("\"uscale\" is reserved for the host"));
    CHECK_THAT(refusal(stripes(R"({"id": "image", "type": "float"})", R"("flags": ["image"], )")),
               ContainsSubstring("\"image\" is reserved for the host"));
    CHECK_THAT(refusal(stripes(color, "", "org.example.stripes", "Stripes")), ContainsSubstring("proper type name"));
    CHECK_THAT(refusal(stripes(color, "", "org.example.stripes", "stripes", "texture")),
               ContainsSubstring("is reserved"));
    std::string many;
    for (int i = 0; i < 17; ++i)
        many += std::string(i ? ", " : "") + R"({"id": "p)" + std::to_string(i) +
                R"(", "type": "float", "flags": ["texturable"]})";
    CHECK_THAT(refusal(stripes(many)), ContainsSubstring("17 texturable parameters; the maximum is 16"));
    CHECK_THAT(refusal(R"({"id": "org.example.stripes", "provides": ["restage.material/1"], "version": "1.0.0",
                           "licence": "MIT", "textures": []})"),
               ContainsSubstring("does not list restage.texture/1"));
}

TEST_CASE("types and prefixes of textures are unique over all plugins", "[texture]") {
    test::PluginFolder folder;
    folder.add("a", stripes(color), nullptr);
    folder.add("b", stripes(color, "", "org.example.other", "stripes", "other"), nullptr);
    folder.add("c", stripes(color, "", "org.example.third", "third", "stripes"), nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    CHECK(registry.textures().size() == 1);
    CHECK_THAT(registry.entries()[1]->reason,
               ContainsSubstring("\"stripes\" is already provided by org.example.stripes"));
    CHECK_THAT(registry.entries()[2]->reason, ContainsSubstring("the prefix \"stripes\" is already taken"));
}

TEST_CASE("a texture is reloaded when its GLSL changes, if the judge accepts it", "[texture][reload]") {
    test::PluginFolder folder;
    const auto path = folder.add("stripes", stripes(color), nullptr);
    Registry registry(folder.log);
    folder.scan(registry);
    bool agrees = true;
    registry.set_judge({}, [&](const TextureEntry& entry) -> Result<> {
        CHECK(entry.table->type == "stripes");
        return agrees ? Result<>() : fail("no");
    });
    const auto before = *registry.find_texture("stripes");
    REQUIRE(write_file_atomic(path / "velvet.glsl", "// another text"));
    REQUIRE(registry.reload_changed().size() == 1);
    const auto after = *registry.find_texture("stripes");
    CHECK(after.source->revision() != before.source->revision());
    CHECK(before.table->label == "Stripes"); // kept alive
    agrees = false;
    REQUIRE(write_file_atomic(path / "velvet.glsl", "// and a third one"));
    const auto news = registry.reload_changed();
    REQUIRE(news.size() == 1);
    CHECK(news[0].error == "no");
    CHECK(registry.find_texture("stripes")->source->revision() == after.source->revision());
}
