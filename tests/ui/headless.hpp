// SPDX-License-Identifier: Apache-2.0
// The editor without a window or its own GPU: Dear ImGui with a backend that draws nothing, a mouse moved by Dear
// ImGui Test Engine, and a live picture of a few pixels. Widgets are identified by the marks that panels give them.
#pragma once

#include "document/session.hpp"
#include "editor/editor.hpp"
#include "editor/panels/state.hpp"
#include "editor/theme.hpp"
#include "editor/viewport.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "view/live_view.hpp"

#include <imgui_internal.h>
#include <imgui_te_context.h>
#include <imgui_te_engine.h>
#include <implot.h>
#include <catch2/catch_test_macros.hpp>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <utility>

namespace restage::tests {

class Headless {
  public:
    // `config`: folder of preferences and the list of assets; none = nothing is stored. `more`: a folder of plugins
    // in addition to those of the build.
    explicit Headless(const std::string& scene, float scale = 1, ImVec2 size = {1500, 1000},
                      const std::filesystem::path& config = {}, const std::filesystem::path& more = {}) {
        std::vector<plugin::SearchPath> plugins{{restage::test::build_dir() / "lib/restage/plugins", true}};
        if (!more.empty()) plugins.push_back({more, true});
        registry_.scan(plugins);
        ImGui::CreateContext();
        ImPlot::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_DockingEnable;
        io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures | ImGuiBackendFlags_HasMouseCursors;
        io.DisplaySize = size;
        editor::apply_theme(scale, {});
        engine_ = ImGuiTestEngine_CreateContext();
        ImGuiTestEngineIO& test_io = ImGuiTestEngine_GetIO(engine_);
        test_io.ConfigRunSpeed = ImGuiTestRunSpeed_Fast;
        test_io.ConfigNoThrottle = true;
        test_io.ConfigVerboseLevel = ImGuiTestVerboseLevel_Error;
        test_io.ConfigVerboseLevelOnError = ImGuiTestVerboseLevel_Info;
        test_io.ConfigLogToTTY = true;
        test_io.ConfigWatchdogWarning = test_io.ConfigWatchdogKillTest =
            1e9f; // a busy machine: ctest's limit comes first
        ImGuiTestEngine_Start(engine_, ImGui::GetCurrentContext());
        render::RendererOptions renderer;
        renderer.tracer = "embree";
        renderer.stand_ins = true;
        renderer.shader_dir = restage::test::source_dir() / "shaders";
        editor_ = std::make_unique<editor::Editor>(
            registry_, log_, notices_,
            editor::EditorOptions{.renderer = renderer, .wake = [] {}, .config_dir = config});
        editor_->view.resolution = 0.02f; // the picture does not matter here
        editor_->open(restage::test::source_dir() / "scenes" / scene);
        const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (editor_->opening().running() && std::chrono::steady_clock::now() < limit) {
            frame();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        frame();
        REQUIRE(editor_->scene().instances.live() > 0);
    }
    ~Headless() { // the editor outlives the window: see editor/texture.hpp
        ImGuiTestEngine_Stop(engine_);
        ImPlot::DestroyContext();
        ImGui::DestroyContext();
        ImGuiTestEngine_DestroyContext(engine_);
    }
    Headless(const Headless&) = delete;
    Headless& operator=(const Headless&) = delete;

    editor::Editor& editor() { return *editor_; }
    const scene::Scene& scene() const { return editor_->scene(); }
    const plugin::Registry& registry() const { return registry_; }
    Log& log() { return log_; }
    std::size_t step() const { return editor_->session().history().position(); }

    // Plays user actions. Fails the test case if a check in it fails.
    void play(const char* name, const std::function<void(ImGuiTestContext*)>& user) {
        ImGuiTest* test = IM_REGISTER_TEST(engine_, "editor", name);
        test->TestFunc = user;
        ImGuiTestEngine_QueueTest(engine_, test);
        while (!ImGuiTestEngine_IsTestQueueEmpty(engine_))
            frame();
        INFO(name);
        CHECK(test->Output.Status == ImGuiTestStatus_Success);
    }

    // --- inside play() ---------------------------------------------------------------------------------------------
    // The widget of that mark, scrolled into view; waits a moment for it to be drawn.
    ImVec4 find(ImGuiTestContext* ctx, const std::string& mark) {
        for (int i = 0; i < 30 && !editor_->find_mark(mark); ++i)
            ctx->Yield();
        const auto* now = editor_->find_mark(mark);
        IM_CHECK_SILENT_RETV(now, (ctx->LogError("there is no \"%s\"", mark.c_str()), ImVec4()));
        editor::Marks::Mark found = *now; // marks are rebuilt each frame
        if (found.item && ctx->ItemInfo(found.item, ImGuiTestOpFlags_NoError).ID) { // else something is over it
            ctx->ItemMakeVisible(found.item, ImGuiTestOpFlags_NoError);
            ctx->Yield(2);
            if (const auto* again = editor_->find_mark(mark)) found = *again;
        }
        return {found.x0, found.y0, found.x1, found.y1};
    }
    // Likewise for widgets that appear with the first picture, however long that takes on a busy machine.
    static void wait_until(ImGuiTestContext* ctx, const std::function<bool()>& there) {
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
        while (!there() && std::chrono::steady_clock::now() < limit) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        IM_CHECK(there());
    }
    void wait_for(ImGuiTestContext* ctx, const std::string& mark) {
        const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
        while (!editor_->find_mark(mark) && std::chrono::steady_clock::now() < limit) {
            ctx->Yield();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        IM_CHECK_SILENT_RETV(editor_->find_mark(mark), (ctx->LogError("there is no \"%s\"", mark.c_str()), void()));
    }
    bool has(ImGuiTestContext* ctx, const std::string& mark) {
        ctx->Yield(2);
        return editor_->find_mark(mark) != nullptr;
    }
    // Left of its centre, where fields of several numbers have their first one.
    void click(ImGuiTestContext* ctx, const std::string& mark, int button = 0) {
        const ImVec4 r = find(ctx, mark);
        ctx->MouseMoveToPos({r.x + std::min(12.f, (r.z - r.x) / 2), (r.y + r.w) / 2});
        ctx->MouseClick(button);
        ctx->Yield(2);
    }
    void double_click(ImGuiTestContext* ctx, const std::string& mark) {
        const ImVec4 r = find(ctx, mark);
        ctx->MouseMoveToPos({r.x + std::min(12.f, (r.z - r.x) / 2), (r.y + r.w) / 2});
        ctx->MouseDoubleClick();
        ctx->Yield(2);
    }
    // Across the widget from a quarter of its width: works for sliders and drags.
    void drag(ImGuiTestContext* ctx, const std::string& mark, float pixels = 25) {
        const ImVec4 r = find(ctx, mark);
        ctx->MouseMoveToPos({r.x + (r.z - r.x) * 0.25f, (r.y + r.w) / 2});
        ctx->MouseDown();
        for (int i = 1; i <= 4; ++i)
            ctx->MouseMoveToPos({r.x + (r.z - r.x) * 0.25f + pixels * float(i) / 4, (r.y + r.w) / 2});
        ctx->MouseUp();
        ctx->Yield(2);
    }
    // All text of one frame, in drawing order.
    std::string words(ImGuiTestContext* ctx) {
        wanted_words_ = true;
        while (wanted_words_)
            ctx->Yield();
        return words_;
    }
    void focus(ImGuiTestContext* ctx, const char* panel) {
        editor_->open_panel(panel);
        ctx->Yield(2);
        ctx->WindowFocus((std::string("//") + panel).c_str());
        ctx->Yield(2);
    }
    void select(const std::string& name) {
        const auto id = editor_->session().find<scene::Instance>(name);
        REQUIRE(id);
        const editor::InstanceId ids[] = {id};
        editor_->selection.set(ids);
    }

  private:
    void frame() {
        ImGui::GetIO().DeltaTime = 1.f / 60;
        ImGui::NewFrame();
        if (wanted_words_) ImGui::LogToBuffer(0);
        editor_->frame();
        if (std::exchange(wanted_words_, false)) {
            words_ = ImGui::GetCurrentContext()->LogBuffer.c_str();
            ImGui::LogFinish();
        }
        ImGui::Render();
        for (ImTextureData* texture : ImGui::GetPlatformIO().Textures) {
            if (texture->Status == ImTextureStatus_WantDestroy) {
                texture->SetTexID(ImTextureID_Invalid);
                texture->SetStatus(ImTextureStatus_Destroyed);
            } else if (texture->Status != ImTextureStatus_OK && texture->Status != ImTextureStatus_Destroyed) {
                texture->SetTexID(1);
                texture->SetStatus(ImTextureStatus_OK);
            }
        }
        ImGuiTestEngine_PostSwap(engine_);
    }

    bool wanted_words_ = false;
    std::string words_;
    Log log_{[](LogLevel, std::string_view) {}};
    editor::Notices notices_;
    plugin::Registry registry_{log_, io::with_services()};
    ImGuiTestEngine* engine_ = nullptr;
    std::unique_ptr<editor::Editor> editor_;
};

} // namespace restage::tests
