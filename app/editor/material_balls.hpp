// SPDX-License-Identifier: Apache-2.0
// MaterialBalls: a path-traced ball for each listed material, of the scene or a preset, in a neutral studio, rendered
// on first use by a separate renderer on a thread with the live picture's priority, so that the two share the
// processor. Balls of presets are kept on disk.
#pragma once

#include "document/preset.hpp"
#include "scene/scene.hpp"
#include "small_pictures.hpp"
#include "texture_pool.hpp"

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace restage::editor {

class MaterialBalls {
  public:
    explicit MaterialBalls(std::function<void()> wake) : renders_(std::move(wake), "a ball of a material", 5) {}

    using Maker = SmallPictures::Maker;
    // [main] The ball as it was last rendered, null until there is one; one that is older than the scene's materials
    // and textures is requested again. Those requested in the latest frame are rendered first, in order: a coarse
    // picture of each, then the full ones.
    const Texture* ball(const Maker& maker, const scene::Scene& scene, scene::Id<scene::Material> id);
    // Likewise of a preset, again when its file changes. Its images are decoded on the thread.
    const Texture* ball(const Maker& maker, const document::Preset& preset);
    void poll(); // [main] once a frame
    void hold(bool on) { renders_.hold(on); } // [main] while true nothing is rendered; kept balls are read
    void forget(); // [main] of another document: presets stay
    std::size_t rendered() const { return rendered_; } // [any] how many; those found on disk do not count

  private:
    struct Made { // what determines a ball
        std::uint64_t document = 0; // 0 = a preset
        scene::Version materials = 0, textures = 0, images = 0;
        std::uint64_t preset = 0; // its hash
        std::uint64_t plugins = 0;
        bool operator==(const Made&) const = default;
    };
    struct Ball {
        Made made; // the latest request
        TexturePool::Held texture;
    };
    using Pixels = std::shared_ptr<std::vector<std::uint32_t>>; // red in the lowest byte
    struct Asked { // and not made yet
        std::uint64_t number = 0;
        std::string key;
        Made made;
        Pixels pixels; // [worker] until it is made
    };
    const Texture* request(const Maker& maker, const std::string& key, const Made& now,
                           const std::function<document::Preset()>& make);
    SmallPictures::Job job(const Maker& maker, document::Preset preset, bool kept, const Pixels& pixels);

    TexturePool pool_;
    std::map<std::string, Ball> balls_; // "17": of the scene; "/folder/gold.json"
    std::uint64_t document_ = 1;
    std::atomic<std::size_t> rendered_ = 0;
    std::deque<Asked> asked_; // the latest first
    std::uint64_t next_ = 1;
    SmallPictures renders_; // destroyed first: its thread uses what is above
};

// A ball of that material in a neutral studio, without the rest of the scene. [any]
scene::Scene ball_scene(const scene::Scene& scene, scene::Id<scene::Material> id);

} // namespace restage::editor
