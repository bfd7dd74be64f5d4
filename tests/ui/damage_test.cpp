// SPDX-License-Identifier: Apache-2.0
// Damage: reported differences are real, and real differences are reported.
#include "editor/damage.hpp"

#include <catch2/catch_test_macros.hpp>
#include <functional>
#include <string>

using namespace restage::editor;

namespace {

// Dear ImGui without a backend, one frame at a time.
class Frames {
  public:
    Frames() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures;
        io.DisplaySize = {400, 300};
    }
    ~Frames() { ImGui::DestroyContext(); }
    // The damage after drawing this. Textures count as uploaded afterwards.
    ImRect draw(const std::function<void()>& content) {
        ImGui::NewFrame();
        ImGui::SetNextWindowPos({10, 20});
        ImGui::SetNextWindowSize({100, 50});
        ImGui::Begin("a", nullptr, ImGuiWindowFlags_NoDecoration);
        content();
        ImGui::End();
        ImGui::SetNextWindowPos({200, 20});
        ImGui::SetNextWindowSize({100, 50});
        ImGui::Begin("b", nullptr, ImGuiWindowFlags_NoDecoration);
        ImGui::TextUnformatted("0123456789 same");
        ImGui::End();
        ImGui::Render();
        const ImRect rect = damage.update(*ImGui::GetDrawData());
        for (ImTextureData* texture : ImGui::GetPlatformIO().Textures)
            if (texture->Status != ImTextureStatus_Destroyed) texture->SetStatus(ImTextureStatus_OK);
        return rect;
    }
    ImRect text(const std::string& text) {
        return draw([&] { ImGui::TextUnformatted(text.c_str()); });
    }
    void settle() { // new windows appear in their second frame
        for (int i = 0; i < 4; ++i)
            text("0");
    }
    Damage damage;
};

bool nothing(const ImRect& rect) { return rect.Min.x >= rect.Max.x || rect.Min.y >= rect.Max.y; }

} // namespace

TEST_CASE("damage: all of the first frame, nothing of an identical second one") {
    Frames frames;
    const ImRect all = frames.text("0");
    CHECK((all.Min.x == 0 && all.Min.y == 0 && all.Max.x == 400 && all.Max.y == 300));
    frames.settle();
    CHECK(nothing(frames.text("0")));
    frames.damage.forget();
    CHECK(frames.text("0").GetWidth() == 400);
    CHECK(nothing(frames.text("0")));
}

TEST_CASE("damage: a text that changes, within its window") {
    Frames frames;
    frames.settle();
    const ImRect rect = frames.text("1");
    REQUIRE_FALSE(nothing(rect));
    CHECK((rect.Min.x >= 10 && rect.Min.y >= 20 && rect.Max.x <= 110 && rect.Max.y <= 70));
    CHECK(nothing(frames.text("1")));
}

TEST_CASE("damage: appearing and vanishing items damage their place") {
    Frames frames;
    frames.settle();
    const auto with_square = [&](float x) {
        return frames.draw([x] {
            ImGui::TextUnformatted("0");
            if (x > 0) ImGui::GetForegroundDrawList()->AddRectFilled({x, 200}, {x + 20, 220}, 0xff0000ff);
        });
    };
    const ImRect came = with_square(300), moved = with_square(340), gone = with_square(0);
    CHECK((came.Min.x <= 300 && came.Max.x >= 320 && came.Min.x > 250 && came.Min.y > 150));
    CHECK((moved.Min.x <= 300 && moved.Max.x >= 360 && moved.Min.x > 250));
    CHECK((gone.Min.x <= 340 && gone.Max.x >= 360 && gone.Min.x > 300));
}

TEST_CASE("damage: a texture with new pixels, where it is shown") {
    Frames frames;
    ImTextureData picture;
    picture.Create(ImTextureFormat_RGBA32, 8, 8);
    ImGui::RegisterUserTexture(&picture);
    const auto show = [&] { return frames.draw([&] { ImGui::Image(picture.GetTexRef(), {30, 20}); }); };
    for (int i = 0; i < 4; ++i)
        show();
    CHECK(nothing(show()));
    picture.SetStatus(ImTextureStatus_WantUpdates);
    const ImRect rect = show();
    REQUIRE_FALSE(nothing(rect));
    CHECK((rect.GetWidth() <= 32 && rect.GetHeight() <= 22));
    CHECK(nothing(show()));
    ImGui::UnregisterUserTexture(&picture);
}

TEST_CASE("damage: drawing is clipped to it") {
    Frames frames;
    frames.settle();
    const ImRect rect = frames.text("1");
    Damage::clip(*ImGui::GetDrawData(), rect);
    for (const ImDrawList* list : ImGui::GetDrawData()->CmdLists)
        for (const ImDrawCmd& command : list->CmdBuffer) {
            const ImVec4& c = command.ClipRect;
            CHECK((c.z <= c.x || c.w <= c.y ||
                   (c.x >= rect.Min.x && c.y >= rect.Min.y && c.z <= rect.Max.x && c.w <= rect.Max.y)));
        }
}
