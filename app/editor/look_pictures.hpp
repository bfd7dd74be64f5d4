// SPDX-License-Identifier: Apache-2.0
// LookPictures: a small picture of each look of the document, as going to it would show. One that is older than what it
// shows stays, marked, until it is rendered again.
#pragma once

#include "small_pictures.hpp"
#include "texture_pool.hpp"
#include "view/display.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>

namespace restage::document {
struct Look;
}

namespace restage::editor {

class LookPictures {
  public:
    explicit LookPictures(std::function<void()> wake) : renders_(std::move(wake)) {}

    struct Shown {
        const Texture* texture = nullptr; // null = there is none yet
        ImVec2 size{0, 0}; // [pixel]
        bool stale = false; // it will be replaced
        bool failed = false; // it could not be rendered: the log says why
        std::optional<SmallPictures::Place> place; // while it is awaited
    };
    // [main] As it was last rendered; requested if it is not of this state.
    Shown picture(const SmallPictures::Maker& maker, const scene::Scene& now, const document::Look& look,
                  const view::DisplaySettings& display);
    void poll(); // [main] once a frame
    void forget(); // [main] of another document

  private:
    struct Of { // what determines a picture
        std::shared_ptr<const scene::Scene> state; // of the look
        scene::Version meshes = 0;
        std::uint32_t objects = 0, lights = 0; // of the document
        glm::uvec2 size{0};
        std::uint64_t plugins = 0;
        bool operator==(const Of&) const = default;
    };
    struct Picture {
        std::uint64_t number = 0; // of the job
        Of asked, made;
        float exposure = 1; // of the look
        scene::Development development;
        bool failed = false; // the one asked for
        render::FilmImage image;
        std::optional<view::DisplaySettings> display; // of the texture
        TexturePool::Held texture;
    };
    Picture& find(const std::string& name, const Of& of);

    TexturePool pool_;
    std::map<std::string, Picture> pictures_; // by the look's name
    std::uint64_t next_ = 1;
    SmallPictures renders_;
};

} // namespace restage::editor
