// SPDX-License-Identifier: Apache-2.0
// Chords that end in the frame in which their last key is pressed.
#include "editor/chords.hpp"

#include <imgui.h>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <string>

using namespace restage::editor;

TEST_CASE("A chord whose modifier is released within the same frame is recognized, and later keys are typed") {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures;
    io.DisplaySize = {400, 300};
    std::array<char, 32> text{"oak"};
    const auto frame = [&](bool focus) {
        begin_imgui_frame();
        ImGui::Begin("a");
        if (focus) ImGui::SetKeyboardFocusHere();
        ImGui::InputText("b", text.data(), text.size());
        ImGui::End();
        ImGui::Render();
    };
    for (int i = 0; i < 4; ++i)
        frame(i == 0);
    io.AddKeyEvent(ImGuiKey_RightArrow, true); // SetKeyboardFocusHere() selects all; a click does not
    io.AddKeyEvent(ImGuiKey_RightArrow, false);
    for (int i = 0; i < 3; ++i)
        frame(false);

    const auto control = [&](bool down) { // as the GLFW backend queues it
        io.AddKeyEvent(ImGuiMod_Ctrl, down);
        io.AddKeyEvent(ImGuiKey_LeftCtrl, down);
    };
    control(true);
    frame(false);
    io.AddKeyEvent(ImGuiKey_A, true);
    control(false);
    io.AddKeyEvent(ImGuiKey_A, false);
    for (const char c : {'s', 'k', 'y'})
        io.AddInputCharacter(static_cast<unsigned>(c));
    for (int i = 0; i < 8; ++i)
        frame(false);
    CHECK(std::string(text.data()) == "sky");
    CHECK(!io.KeyCtrl);
    ImGui::DestroyContext();
}
