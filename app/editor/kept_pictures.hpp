// SPDX-License-Identifier: Apache-2.0
// KeptPictures: live pictures put aside, each with the scene it shows: to compare the present picture with, and to go
// back to. Not part of the document; those of another document are dropped.
#pragma once

#include "scene/scene.hpp"
#include "texture_pool.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace restage::editor {

class PanelContext;
class SelectContext;

class KeptPictures {
  public:
    static constexpr std::size_t most = 16; // the oldest is dropped then

    struct Picture {
        std::string name; // "Picture 3, 64 samples"
        scene::Scene scene; // as seen: its camera is the viewpoint
        ImVec2 size{0, 0}; // [pixel]
        TexturePool::Held texture;
    };
    const std::vector<Picture>& list() const { return list_; } // the latest first
    void add(std::string name, scene::Scene scene, std::uint32_t width, std::uint32_t height,
             std::span<const std::uint32_t> rgba);
    void remove(std::size_t index);
    void forget();
    std::size_t number() const { return added_ + 1; } // of the next one

    // The picture that the live one is compared with: null = none is kept.
    const Picture* compared() const { return compared_ < list_.size() ? &list_[compared_] : nullptr; }
    std::size_t compared_index() const { return compared_; }
    void compare(std::size_t index) { compared_ = index; }
    bool wiping = false;  // it covers the live picture to the left of a line
    float line = 0.5f;    // fraction of the picture's width

  private:
    TexturePool pool_;
    std::vector<Picture> list_;
    std::size_t compared_ = 0, added_ = 0;
};

// Keeps the picture that is shown, as it is shown.
void keep_picture(PanelContext& editor);
// The scene becomes as it was in that picture: one undo step.
void bring_back(SelectContext& editor, std::size_t index);
// Over the live picture, whose rectangle this is: the compared one, at the left of the line or, while J is held,
// everywhere.
void draw_comparison(PanelContext& editor, ImVec2 corner, ImVec2 size);

} // namespace restage::editor
