// SPDX-License-Identifier: Apache-2.0
// Texture: pixels that Dear ImGui can draw. Its backend uploads and frees them.
#pragma once

#include <imgui.h>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace restage::editor {

// A picture whose size changes often (the viewport's): one texture per size is kept, so that switching between
// coarse and fine allocates nothing. It must outlive the window, which frees the device's copies.
class Texture {
  public:
    Texture() = default;
    ~Texture();
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;

    // RGBA, row 0 on top. Visible from this frame on.
    void set(std::uint32_t width, std::uint32_t height, std::span<const std::uint32_t> rgba);
    void hide() { current_ = nullptr; } // until the next set()
    bool ready() const { return current_ != nullptr; }
    ImTextureRef ref() const { return current_->GetTexRef(); }

  private:
    void retire_others();
    ImTextureData* current_ = nullptr;
    std::map<std::pair<int, int>, ImTextureData*> sizes_;
    std::vector<ImTextureData*> leaving_; // of sizes that came back before the backend had destroyed them
};

} // namespace restage::editor
