// SPDX-License-Identifier: Apache-2.0
// Choices by picture or number: balls of materials, skies, the steps of drags; and the positions of dialogs.
#include "headless.hpp"
#include "render/renderer.hpp"

#include "editor/assets.hpp"
#include "editor/material_balls.hpp"
#include "editor/preferences.hpp"
#include "temporary_folder.hpp"
#include "view/display.hpp"

#include <fstream>

using namespace restage;
using tests::Headless;

namespace {

void write_pfm(const std::filesystem::path& file, int width, int height) {
    std::ofstream out(file, std::ios::binary);
    out << "PF\n" << width << ' ' << height << "\n-1.0\n";
    for (int i = 0; i < width * height; ++i) {
        const float pixel[] = {0.2f, 0.4f, float(i % width) / float(width)};
        out.write(reinterpret_cast<const char*>(pixel), sizeof pixel);
    }
}

struct Look {
    glm::dvec3 mean{0}, spread{0}; // of the colours that a screen shows, 0..1
    double white = 0; // the fraction of pixels
};

// Of the ball's inner part.
Look look_of(const render::FilmImage& image) {
    std::vector<std::uint32_t> rgba;
    view::to_display(image, {}, rgba);
    Look look;
    glm::dvec3 squares(0);
    double n = 0;
    for (std::uint32_t y = image.height / 4; y < image.height * 3 / 4; ++y)
        for (std::uint32_t x = image.width / 4; x < image.width * 3 / 4; ++x) {
            const std::uint32_t pixel = rgba[std::size_t(y) * image.width + x];
            const glm::dvec3 c = glm::dvec3(pixel & 255, pixel >> 8 & 255, pixel >> 16 & 255) / 255.0;
            look.mean += c;
            squares += c * c;
            look.white += c.x > 0.97 && c.y > 0.97 && c.z > 0.97;
            ++n;
        }
    look.mean /= n;
    look.white /= n;
    look.spread = glm::sqrt(glm::max(squares / n - look.mean * look.mean, 0.0));
    return look;
}

} // namespace

TEST_CASE("balls show the material: a texture is not black, a metal neither white nor flat", "[ui]") {
    Headless h("spheres/spheres.pbrt");
    render::RendererOptions options = h.editor().options().renderer;
    options.stand_ins = false;
    auto renderer = render::Renderer::create(options, render::material_lookup(h.registry()), h.log());
    REQUIRE(renderer);
    const auto ball = [&](const char* name) {
        scene::Id<scene::Material> id;
        h.scene().materials.each([&](scene::Id<scene::Material> one, const scene::Material& m) {
            if (m.name == name) id = one;
        });
        INFO(name);
        REQUIRE(id);
        (*renderer)->forget_scene();
        REQUIRE((*renderer)->sync(editor::ball_scene(h.scene(), id)));
        REQUIRE((*renderer)->trace(16));
        const Look look = look_of((*renderer)->image());
        CHECK((look.mean.y > 0.15 && look.mean.y < 0.9 && look.white < 0.5));
        CHECK(look.spread.y > 0.02); // it is a disk
        return look;
    };
    CHECK(ball("Ground").spread.y > 1.5 * ball("Clay").spread.y); // its tiles are visible
    const Look copper = ball("Brushed copper"), silver = ball("Silver mirror");
    CHECK(copper.mean.x > 1.2 * copper.mean.z);
    CHECK(std::abs(silver.mean.x - silver.mean.z) < 0.1);
    CHECK(silver.spread.y > 0.05); // the studio in it
}

TEST_CASE("a sky is chosen by its thumbnail, and surface maps are not listed", "[ui]") {
    test::TemporaryFolder folder;
    write_pfm(folder.path() / "noon.pfm", 64, 32);
    write_pfm(folder.path() / "wall_bump.pfm", 64, 32);
    write_pfm(folder.path() / "wall-NormalGL.pfm", 64, 32);
    write_pfm(folder.path() / "tiles.pfm", 32, 32);
    std::ofstream(folder.path() / "assets.json") << R"({"folders": ["."]})";
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path());
    h.play("sky", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Log"); // the assets are known even if their panel was never shown
        h.editor().panel_state->assets.loaded = false;
        h.editor().panel_state->assets.entries.clear();
        h.focus(ctx, "Scene");
        h.click(ctx, "sky.image");
        h.wait_for(ctx, "sky.choose.noon.pfm");
        IM_CHECK(h.has(ctx, "sky.choose.sky.exr")); // the scene's own
        h.wait_for(ctx, "sky.thumbnail.noon.pfm");
        for (const char* map : {"wall_bump.pfm", "wall-NormalGL.pfm", "tiles.pfm", "plaster-height.png"}) {
            for (int i = 0; i < 2000 && h.has(ctx, std::string("sky.choose.") + map); ++i) // until its shape is known
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
            IM_CHECK_SILENT_RETV(!h.has(ctx, std::string("sky.choose.") + map),
                                 (ctx->LogError("%s is listed", map), void()));
        }
        h.click(ctx, "sky.choose.noon.pfm");
        for (int i = 0; i < 20000 && h.step() == 0; ++i) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        IM_CHECK(h.step() == 1 && h.scene().environment.value->name == "noon");
    });
}

TEST_CASE("the steps of drags are set in the toolbar, used and remembered", "[ui]") {
    test::TemporaryFolder folder;
    Headless h("demo/demo.pbrt", 1, {1500, 1000}, folder.path());
    h.select("Chair frame");
    const auto id = h.editor().selection.active();
    const glm::dvec3 start(h.scene().instances[id].object_to_world[3]);
    h.play("steps", [&](ImGuiTestContext* ctx) {
        h.wait_for(ctx, "gizmo.center");
        h.click(ctx, "toolbar.steps");
        for (const auto& [mark, text] : {std::pair("steps.move", "0.3"), {"steps.angle", "10"}}) {
            ctx->KeyDown(ImGuiMod_Ctrl);
            h.click(ctx, mark);
            ctx->KeyUp(ImGuiMod_Ctrl);
            ctx->KeyCharsReplaceEnter(text);
            ctx->Yield(2);
        }
        ctx->PopupCloseAll();
        IM_CHECK(!h.has(ctx, "steps.move"));
        const ImVec4 r = h.find(ctx, "gizmo.center");
        const ImVec2 from((r.x + r.z) / 2, (r.y + r.w) / 2);
        ctx->MouseMoveToPos(from);
        ctx->KeyDown(ImGuiMod_Ctrl);
        ctx->MouseDown();
        for (int i = 1; i <= 5; ++i)
            ctx->MouseMoveToPos({from.x + 20.f * float(i), from.y + 10.f * float(i)});
        ctx->MouseUp();
        ctx->KeyUp(ImGuiMod_Ctrl);
        ctx->Yield(3);
        const glm::dvec3 by = glm::dvec3(h.scene().instances[id].object_to_world[3]) - start;
        IM_CHECK(h.step() == 1 && glm::length(by) > 0.29);
        for (int i = 0; i < 3; ++i)
            IM_CHECK(std::abs(by[i] / 0.3 - std::round(by[i] / 0.3)) < 1e-3);
    });
    const editor::Preferences kept = editor::read_preferences(folder.path());
    CHECK((kept.snap_move == 0.3f && kept.snap_angle == 10));
}

TEST_CASE("the note at the picture's corner describes the shown picture", "[ui]") {
    view::Frame shown{.divider = 4, .denoised = true};
    shown.image.width = 160;
    shown.image.height = 90;
    shown.image.samples = 2;
    shown.relative_error = 0.125;
    CHECK(editor::picture_note(shown, "", false) == "160 × 90, 2 samples per pixel, error 12.5 %, denoised");
    CHECK(editor::picture_note(shown, "velvet", false)
              .ends_with("velvet is being compiled; until then it is shown simplified"));
}

TEST_CASE("a dialog is in the middle of the window, and returns there when the window is resized", "[ui]") {
    Headless h("cornell/cornell.pbrt");
    h.play("dialog", [&](ImGuiTestContext* ctx) {
        h.editor().show_modal("A question", [](editor::PanelContext&) {
            ImGui::TextUnformatted("Some words that make it wide enough");
            ImGui::Button("Answer");
            return true;
        });
        const auto centred = [&] {
            ctx->Yield(8);
            const ImGuiWindow* window = ImGui::FindWindowByName("A question");
            const ImVec2 size = ImGui::GetIO().DisplaySize;
            return window && window->Active && std::abs(window->Pos.x + window->Size.x / 2 - size.x / 2) < 2 &&
                   std::abs(window->Pos.y + window->Size.y / 2 - size.y / 2) < 2;
        };
        IM_CHECK(centred());
        for (const ImVec2 size : {ImVec2(800, 500), ImVec2(1500, 1000)}) {
            ImGui::GetIO().DisplaySize = size;
            IM_CHECK(centred());
        }
        ctx->KeyPress(ImGuiKey_Escape);
        ctx->Yield(2);
    });
}
