// SPDX-License-Identifier: Apache-2.0
// The library of materials: every preset renders; a click, a drag and hovering give presets to objects; materials are
// saved as presets; what the picture shows of a trial leaves the document alone.
#include "headless.hpp"
#include "render/renderer.hpp"

#include "document/preset.hpp"
#include "editor/material_balls.hpp"
#include "editor/shown_scene.hpp"
#include "scene/bounds.hpp"
#include "temporary_folder.hpp"

using namespace restage;
using editor::InstanceId;
using tests::Headless;

namespace {

const scene::Material* material_of(Headless& h, const char* object) {
    const auto id = h.scene().instances.find(h.editor().session().find<scene::Instance>(object));
    return id ? h.scene().materials.find(id->material) : nullptr;
}

template <class Done>
bool wait(ImGuiTestContext* ctx, Done&& done) {
    for (int i = 0; i < 60000 && !done(); ++i) {
        ctx->Yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return done();
}

} // namespace

TEST_CASE("every preset renders finite on a ball", "[presets]") {
    Log log{[](LogLevel, std::string_view) {}};
    plugin::Registry registry{log, io::with_services()};
    registry.scan(std::vector<plugin::SearchPath>{{test::build_dir() / "lib/restage/plugins", true}});
    render::RendererOptions options;
    options.tracer = "embree";
    options.shader_dir = test::source_dir() / "shaders";
    auto renderer = render::Renderer::create(options, render::material_lookup(registry), log);
    REQUIRE(renderer);
    auto all = document::presets_in(test::source_dir() / "materials", registry);
    REQUIRE(all.presets.size() >= 60);
    for (document::Preset& preset : all.presets) {
        INFO(preset.file.string());
        REQUIRE(document::read_images(preset));
        scene::Scene ball = editor::ball_scene(preset.parts, preset.material);
        ball.film.value.width = ball.film.value.height = 32;
        (*renderer)->forget_scene();
        REQUIRE((*renderer)->sync(ball));
        REQUIRE((*renderer)->trace(4));
        CHECK((*renderer)->stats().not_finite.empty());
        double sum = 0;
        for (const glm::vec3& c : (*renderer)->image().color)
            sum += c.x + c.y + c.z;
        CHECK((std::isfinite(sum) && sum > 0));
    }
}

TEST_CASE("a trial shows a change and leaves the document's versions alone", "[presets]") {
    scene::Scene document;
    scene::apply(document, scene::insert(document, scene::Material{.name = "one", .type = "diffuse"}, ""));
    scene::apply(document, scene::insert(document, scene::Material{.name = "two", .type = "diffuse"}, ""));
    editor::ShownScene shown;
    const auto name = [](const scene::Scene& s, std::uint32_t id) {
        const scene::Material* m = s.materials.find({id});
        return m ? m->name : "";
    };
    CHECK(&shown.follow(document, 1, {}) == &document); // costs nothing until there is a trial
    const auto renaming = [](std::uint64_t number, std::uint32_t id, const char* to) {
        return editor::Trial{
            number, [=](const scene::Scene& s) { return scene::rename(s, scene::Id<scene::Material>{id}, to); }};
    };
    scene::Version last = document.clock;
    const auto follow = [&](const editor::Trial& trial) -> const scene::Scene& {
        const scene::Scene& s = shown.follow(document, 1, trial);
        CHECK(s.clock >= last); // a renderer sees changes only
        last = s.clock;
        return s;
    };
    CHECK(name(follow(renaming(1, 1, "tried")), 1) == "tried");
    CHECK(name(document, 1) == "one");
    CHECK(document.clock == 2);
    const scene::Version tried = last;
    CHECK(name(follow({}), 1) == "one");
    CHECK(shown.follow(document, 1, {}).materials.version({1}) > tried);
    // An edit during a trial, and an insert whose id a trial had.
    const editor::Trial inserting{
        2, [](const scene::Scene& s) {
            return Result<scene::Edit>(scene::insert(s, scene::Material{.name = "new", .type = "diffuse"}, ""));
        }};
    const auto has_new = [](const scene::Scene& s) { return bool(scene::find_by_name<scene::Material>(s, "new")); };
    CHECK(has_new(follow(inserting)));
    scene::apply(document, scene::rename(document, scene::Id<scene::Material>{2}, "edited").value());
    CHECK(name(follow(inserting), 2) == "edited");
    CHECK(has_new(follow(inserting)));
    scene::apply(document, scene::insert(document, scene::Material{.name = "three", .type = "diffuse"}, ""));
    CHECK(name(follow({}), 3) == "three");
    CHECK_FALSE(has_new(follow({})));
    CHECK(has_new(follow(inserting)));
    CHECK(name(follow(renaming(3, 9, "none")), 1) == "one"); // cannot be built: the document
    CHECK_FALSE(shown.trying());
    scene::Scene other;
    CHECK(&shown.follow(other, 2, {}) == &other);
}

TEST_CASE("a click gives a preset to the selection; a drag, to the object under the mouse", "[ui][presets]") {
    test::TemporaryFolder folder;
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path());
    h.select("Chair frame");
    h.play("click", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Materials");
        h.click(ctx, "materials.search");
        ctx->KeyCharsReplace("Gold");
        ctx->Yield(2);
        IM_CHECK(h.has(ctx, "materials.Gold, satin"));
        IM_CHECK(!h.has(ctx, "materials.Copper"));
        h.click(ctx, "materials.Gold");
        IM_CHECK(h.step() == 1);
        IM_CHECK(material_of(h, "Chair frame")->name == "Gold");
        IM_CHECK(h.editor().session().history().undo_label() == "Material Gold");
        h.click(ctx, "materials.Gold"); // it has it: nothing to do
        IM_CHECK(h.step() == 1);
        h.wait_for(ctx, "materials.ball.Gold");
    });
    const std::size_t materials = h.scene().materials.live();
    h.play("drag", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "picture");
        h.focus(ctx, "Materials");
        h.click(ctx, "materials.search");
        ctx->KeyCharsReplace("Gold");
        ctx->Yield(2);
        IM_CHECK(wait(ctx, [&] { return h.editor().shown_frame() != nullptr; }));
        const ImVec4 ball = h.find(ctx, "materials.Gold, satin"), picture = h.find(ctx, "picture");
        const ImVec2 to((picture.x + picture.z) / 2, picture.w - 60);
        const InstanceId under = h.editor().viewport.instance_at(h.editor(), to);
        IM_CHECK(bool(under));
        const auto before = h.scene().instances[under].material;
        ctx->MouseMoveToPos({(ball.x + ball.z) / 2, (ball.y + ball.w) / 2});
        ctx->MouseDown();
        ctx->MouseMoveToPos({to.x, to.y - 20});
        ctx->MouseMoveToPos(to);
        ctx->Yield(3);
        IM_CHECK(h.editor().drop_target == under);
        IM_CHECK(h.has(ctx, "drop.onto." + h.scene().instances[under].name));
        ctx->MouseUp();
        ctx->Yield(3);
        if (h.has(ctx, "scope.alone")) h.click(ctx, "scope.alone");
        IM_CHECK(h.scene().instances[under].material != before);
        IM_CHECK(h.scene().materials[h.scene().instances[under].material].name == "Gold, satin");
        IM_CHECK(h.scene().materials.live() == materials + 1);
        IM_CHECK(h.step() == 2);
    });
}

TEST_CASE("hovering a ball tries it on the selection, without a step", "[ui][presets]") {
    test::TemporaryFolder folder;
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path());
    auto& state = h.editor().panel_state->library;
    const auto over = [&](ImGuiTestContext* ctx, const char* mark) {
        const ImVec4 r = h.find(ctx, mark);
        ctx->MouseMoveToPos({(r.x + r.z) / 2, (r.y + r.w) / 2});
        ctx->Yield(40); // 0.67 s
    };
    h.play("hover", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Materials");
        h.click(ctx, "materials.search");
        ctx->KeyCharsReplace("Gold");
        over(ctx, "materials.Gold");
        IM_CHECK(!state.trial.build); // nothing is selected
        h.select("Chair frame");
        const scene::Version version = h.editor().session().version();
        over(ctx, "materials.Gold");
        IM_CHECK(state.trial.build != nullptr);
        const std::uint64_t first = state.trial.number;
        over(ctx, "materials.Gold, satin");
        IM_CHECK(state.trial.number == first + 1);
        IM_CHECK(h.editor().session().version() == version);
        IM_CHECK(!h.editor().session().modified());
        over(ctx, "materials.search");
        IM_CHECK(!state.trial.build);
        over(ctx, "materials.Gold");
        IM_CHECK(state.trial.build != nullptr);
        h.focus(ctx, "Log"); // the panel is gone, and so is what it showed
        IM_CHECK(!editor::current_trial(state).build);
        IM_CHECK(h.step() == 0);
    });
}

TEST_CASE("a textured preset is projected on a mesh without coordinates; equal names have marks of their own",
          "[ui][presets]") {
    test::TemporaryFolder folder;
    Headless h("cornell/cornell.pbrt", 1, {1500, 1000}, folder.path());
    document::Session& session = h.editor().session_for_changes();
    auto square = std::make_shared<scene::MeshData>();
    square->positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square->triangles = {{0, 1, 2}, {0, 2, 3}};
    scene::compute_bounds(*square);
    const auto mesh = h.scene().meshes.next();
    REQUIRE(session.edit(scene::insert(h.scene(), scene::Mesh{.name = "square", .data = square}, "Add")));
    REQUIRE(session.edit(scene::insert(h.scene(), scene::Instance{.name = "Bare", .mesh = mesh}, "Add")));
    const std::size_t steps = h.step();
    h.select("Bare");
    const std::string tiles = "Tiles, black and white";
    h.play("click", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Materials");
        h.click(ctx, "materials.search");
        ctx->KeyCharsReplace(tiles.c_str());
        h.click(ctx, "materials." + tiles);
        IM_CHECK(h.step() == steps + 1);
        IM_CHECK(material_of(h, "Bare")->name == tiles);
        const auto id = session.find<scene::Instance>("Bare");
        IM_CHECK(!h.scene().meshes[h.scene().instances[id].mesh].data->uvs.empty());
        IM_CHECK(h.has(ctx, "materials." + tiles) &&
                 h.has(ctx, "materials." + tiles + "#2")); // the scene's, the preset
        IM_CHECK(h.find(ctx, "materials." + tiles + "#2").y > h.find(ctx, "materials." + tiles).y);
        h.editor().undo();
        ctx->Yield(2);
        IM_CHECK(h.scene().instances[id].mesh == mesh);
    });
}

TEST_CASE("a material is saved as a preset, and replacing one asks", "[ui][presets]") {
    test::TemporaryFolder folder;
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path());
    const auto file = folder.path() / "materials/my-chair.json";
    h.select("Chair frame");
    h.play("save", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Inspector");
        h.click(ctx, "material.save_preset");
        h.click(ctx, "preset.name");
        ctx->KeyCharsReplace("My chair");
        h.click(ctx, "preset.category");
        ctx->KeyCharsReplace("Furniture");
        h.click(ctx, "preset.save");
        IM_CHECK(std::filesystem::exists(file));
        h.focus(ctx, "Materials");
        h.click(ctx, "materials.category");
        h.click(ctx, "materials.category.Furniture");
        IM_CHECK(h.has(ctx, "materials.My chair"));
        h.focus(ctx, "Inspector");
        h.click(ctx, "material.save_preset");
        h.click(ctx, "preset.name");
        ctx->KeyCharsReplace("My chair");
        h.click(ctx, "preset.save"); // asks
        IM_CHECK(h.has(ctx, "preset.save"));
        h.click(ctx, "preset.save");
        IM_CHECK(!h.has(ctx, "preset.save"));
    });
    const auto read = document::read_preset(file, h.registry());
    REQUIRE(read);
    CHECK(read->name == "My chair");
}
