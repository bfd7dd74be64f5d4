// SPDX-License-Identifier: Apache-2.0
// Materials from outside: of other scenes' files, presets dropped on the window, balls that an earlier start rendered.
#include "headless.hpp"

#include "base/file.hpp"
#include "editor/files.hpp"
#include "editor/library.hpp"
#include "editor/material_balls.hpp"
#include "temporary_folder.hpp"

#include <algorithm>

using namespace restage;
using tests::Headless;

namespace {

using editor::InstanceId;

const scene::Material* material_on(const scene::Scene& s, const char* name) {
    const auto id = scene::find_by_name<scene::Instance>(s, name);
    return id ? s.materials.find(s.instances[id].material) : nullptr;
}

bool wait_until(ImGuiTestContext* ctx, const std::function<bool()>& done) {
    for (int i = 0; i < 60000 && !done(); ++i) {
        ctx->Yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return done();
}

constexpr const char* dotted = R"({"restage": "material", "name": "Dotted", "category": "Fabric", "type": "diffuse",
 "params": {"reflectance": {"texture": "dots"}},
 "textures": {"dots": {"type": "dots", "float": false, "params": {"inside": [0.8, 0.8, 0.8], "uscale": 9}}},
 "source": "chosen by eye for a test"})";

} // namespace

TEST_CASE("materials of another scene's file are listed and given with their textures", "[ui][presets]") {
    Headless h("cornell/cornell.pbrt");
    const std::size_t before = h.scene().materials.live();
    const InstanceId first = [&] {
        InstanceId found;
        h.scene().instances.each([&](InstanceId id, const scene::Instance&) { found = found ? found : id; });
        return found;
    }();
    h.play("borrow", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Materials");
        const editor::LibraryState& state = h.editor().panel_state->library;
        editor::borrow_materials(h.editor(), test::source_dir() / "scenes/demo/demo.pbrt");
        IM_CHECK(wait_until(ctx, [&] { return !state.borrowed.empty(); }));
        IM_CHECK_STR_EQ(state.category.c_str(), "demo.pbrt"); // they are shown
        IM_CHECK(h.has(ctx, "materials.Oak"));
        IM_CHECK(h.scene().materials.live() == before && h.step() == 0); // nothing else of it is used
        const std::size_t count = state.borrowed.size();
        editor::borrow_materials(h.editor(), test::source_dir() / "scenes/demo/demo.pbrt");
        ctx->Yield(2);
        IM_CHECK(wait_until(ctx, [&] { return !h.editor().files().jobs.running(); }));
        IM_CHECK(state.borrowed.size() == count); // read again: replaced
        const InstanceId ids[] = {first};
        h.editor().selection.set(ids);
        h.click(ctx, "materials.Oak");
        IM_CHECK(wait_until(ctx, [&] { return h.step() == 1; }));
    });
    const scene::Material* given = h.scene().materials.find(h.scene().instances[first].material);
    REQUIRE(given);
    CHECK(given->name == "Oak");
    CHECK(h.scene().textures.live() > 0);
}

TEST_CASE("a preset's file that is dropped goes to the object there, or into one's presets", "[ui][presets]") {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "outside.json";
    const auto other = folder.path() / "other.json";
    REQUIRE(write_file_atomic(file, dotted));
    REQUIRE(write_file_atomic(other, "{}"));
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path() / "config");
    h.play("drop", [&](ImGuiTestContext* ctx) {
        const auto own = folder.path() / "config/materials/dotted.json";
        editor::drop_preset(h.editor(), file, {});
        IM_CHECK(wait_until(ctx, [&] { return std::filesystem::exists(own); }));
        h.focus(ctx, "Materials");
        h.click(ctx, "materials.search");
        ctx->KeyCharsReplace("Dotted");
        IM_CHECK(h.has(ctx, "materials.Dotted"));
        IM_CHECK(h.step() == 0);
        const auto chair = scene::find_by_name<scene::Instance>(h.scene(), "Vase");
        IM_CHECK(bool(chair));
        editor::drop_preset(h.editor(), file, chair);
        ctx->Yield(3);
        if (h.has(ctx, "scope.alone")) h.click(ctx, "scope.alone");
        IM_CHECK(wait_until(ctx, [&] { return h.step() == 1; }));
        editor::drop_preset(h.editor(), other, chair); // not a preset
        ctx->Yield(2);
        IM_CHECK(h.step() == 1);
    });
    const scene::Material* given = material_on(h.scene(), "Vase");
    REQUIRE(given);
    CHECK(given->name == "Dotted");
    CHECK(given->params.find("reflectance")->texture);
}

TEST_CASE("balls of presets are rendered once, and read at the next start", "[ui][presets]") {
    const test::TemporaryFolder folder;
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    registry.scan(std::vector<plugin::SearchPath>{{test::build_dir() / "lib/restage/plugins", true}});
    editor::MaterialBalls first([] {}), second([] {}); // outlive the window
    Headless h("cornell/cornell.pbrt");
    render::RendererOptions options;
    options.tracer = "embree";
    options.shader_dir = test::source_dir() / "shaders";
    options.cache_dir = folder.path();
    const editor::MaterialBalls::Maker maker{registry, log, options};
    auto read = document::read_preset(test::source_dir() / "materials/gold.json", registry);
    REQUIRE(read);
    const auto shown = [&](ImGuiTestContext* ctx, editor::MaterialBalls& balls) {
        return wait_until(ctx, [&] {
            balls.poll();
            return balls.ball(maker, *read) != nullptr;
        });
    };
    h.play("balls", [&](ImGuiTestContext* ctx) {
        IM_CHECK(shown(ctx, first));
        IM_CHECK(wait_until(ctx, [&] { return first.rendered() == 1; })); // a coarse one came first
        IM_CHECK(std::filesystem::exists(folder.path() / "balls"));
        IM_CHECK(shown(ctx, second));
        IM_CHECK(second.rendered() == 0);
    });
}
