// SPDX-License-Identifier: Apache-2.0
// Window: one GLFW window that Dear ImGui draws into through Vulkan, with its own device, so that drawing never
// waits for rendering. Begin a frame, build the UI, end it. [main]
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"

#include <imgui.h>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace restage::editor {

struct WindowOptions {
    std::string title = "Restage";
    glm::ivec2 size{1280, 720};      // in screen coordinates
    std::string device;              // as RendererOptions::device
    bool validation = false;
    float scale = 0;                 // of text and widgets; 0 = the monitor's
    std::filesystem::path fonts;     // folder with the UI's fonts
    std::filesystem::path layout;    // folder that stores the layout; "" = none
};

class Window {
  public:
    static Result<std::unique_ptr<Window>> create(const WindowOptions& options, Log& log);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    // Waits for events, at most this long [s]; wake() from any thread ends the wait.
    void wait(double seconds);
    static void wake();

    Result<bool> begin_frame(); // false = nothing to draw on (minimised)
    Result<void> end_frame();
    // More frames should follow soon: input is pending, or has not taken full effect yet.
    bool unsettled() const;

    // Keys pressed since the last call, each with the modifiers it was pressed with. Dear ImGui sees modifiers as they
    // are a frame later, which loses "Ctrl+Z" typed fast while a frame is slow. None while an earlier click is still
    // unprocessed: it may focus the field that they are typed into.
    std::vector<ImGuiKeyChord> take_keys();
    bool input_waits() const; // Dear ImGui takes some events a frame later than others

    bool close_requested() const;
    bool display_gone() const; // the Wayland compositor has exited. X11 ends the process itself: see Farewell
    void refuse_close();
    std::vector<std::filesystem::path> take_dropped(glm::vec2& where); // files dropped on it since the last call
    void set_title(const std::string& title);
    float scale() const;
    GLFWwindow* handle() const;

  private:
    struct Impl;
    explicit Window(std::unique_ptr<Impl>);
    std::unique_ptr<Impl> impl_;
};

} // namespace restage::editor
