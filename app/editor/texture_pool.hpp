// SPDX-License-Identifier: Apache-2.0
// TexturePool: textures for pictures that come and go. Textures outlive the window (texture.hpp), so those given back
// are used again.
#pragma once

#include "texture.hpp"

#include <memory>
#include <vector>

namespace restage::editor {

class TexturePool {
  public:
    using Held = std::shared_ptr<Texture>;
    Held take() {
        for (const Held& one : all_)
            if (one.use_count() == 1) {
                one->hide();
                return one;
            }
        return all_.emplace_back(std::make_shared<Texture>());
    }

  private:
    std::vector<Held> all_;
};

} // namespace restage::editor
