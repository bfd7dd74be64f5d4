// SPDX-License-Identifier: Apache-2.0
// MaterialBalls: a path-traced ball for each listed material, of the scene or a preset, in a neutral studio, rendered
// on first use by a separate renderer on a low-priority thread. Balls of presets are kept on disk.
#pragma once

#include "base/log.hpp"
#include "document/preset.hpp"
#include "plugin/registry.hpp"
#include "render/renderer_options.hpp"
#include "scene/scene.hpp"
#include "texture_pool.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace restage::editor {

class MaterialBalls {
  public:
    explicit MaterialBalls(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~MaterialBalls();
    MaterialBalls(const MaterialBalls&) = delete;
    MaterialBalls& operator=(const MaterialBalls&) = delete;

    // The renderer's host, and the log for failures. Both outlive this.
    struct Maker {
        const plugin::Registry& registry;
        Log& log;
        render::RendererOptions options;
    };
    // [main] The ball as it was last rendered, null until there is one; one that is older than the scene's materials
    // and textures is requested again. The latest request is rendered first.
    const Texture* ball(const Maker& maker, const scene::Scene& scene, scene::Id<scene::Material> id);
    // Likewise of a preset, again when its file changes. Its images are decoded on the thread.
    const Texture* ball(const Maker& maker, const document::Preset& preset);
    void poll(); // [main] once a frame
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
    struct Job {
        std::string key;
        Made made;
        document::Preset preset; // of a scene's material: the whole scene is its parts
    };
    struct Finished {
        std::string key;
        Made made;
        std::vector<std::uint32_t> rgba;
    };
    const Texture* request(const Maker& maker, const std::string& key, const Made& now,
                           const std::function<document::Preset()>& make);
    void work(Maker maker);

    std::function<void()> wake_;
    TexturePool pool_;
    std::map<std::string, Ball> balls_; // "17": of the scene; "/folder/gold.json"
    std::uint64_t document_ = 1;
    std::atomic<std::size_t> rendered_ = 0;
    std::mutex mutex_;
    std::condition_variable more_;
    std::deque<Job> jobs_;
    std::deque<Finished> finished_;
    bool stop_ = false;
    std::thread thread_;
};

// A ball of that material in a neutral studio, without the rest of the scene. [any]
scene::Scene ball_scene(const scene::Scene& scene, scene::Id<scene::Material> id);

} // namespace restage::editor
