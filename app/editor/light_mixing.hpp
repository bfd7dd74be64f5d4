// SPDX-License-Identifier: Apache-2.0
// LightMixing: the mix of the document's lights that the viewport shows while its panel is drawn: the lights in layers,
// their weights, and the picture. Nothing here changes the document until the weights are applied. [main]
#pragma once

#include "pick_tool.hpp"
#include "scene/scene.hpp"
#include "view/light_mixer.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace restage::document {
class Session;
}
namespace restage::view {
struct Frame;
}

namespace restage::editor {

class DocumentContext;
class PanelUi;
class SelectContext;

class LightMixing {
  public:
    explicit LightMixing(std::function<void()> wake) : wake_(wake), mixer_(std::move(wake)) {}

    static constexpr std::size_t most_layers = 12;
    std::span<const view::LightLayer> layers() const { return layers_; } // of the document, while the panel is drawn
    std::vector<glm::vec3> weights; // of each layer: linear RGB, 1 = as in the document
    bool changed() const; // some weight is not 1

    void drawn() { drawn_ = true; } // by the panel, in each frame that shows it
    // Once a frame, after the document's changes: renders the layers again where these differ. `size` of the live
    // picture, `denoise` as in the view.
    void follow(SelectContext& editor, glm::uvec2 size, bool denoise);
    // The mixed picture; null: the live one is to be shown.
    const std::shared_ptr<const view::Frame>& frame() const { return frame_; }
    bool shown() const { return bool(frame_); }
    std::uint32_t samples() const; // a pixel, of each layer; 0: some have none yet
    bool done() const { return mixer_.done(); }

    // A spot of the picture that the user pointed at, from (0,0) to (1,1); none after the scene or view has changed.
    std::optional<glm::dvec2> spot;
    // Each layer's part of the light there, 0 to 1; empty without a spot or pictures.
    const std::vector<double>& shares() const { return shares_; }
    // The layer's weight changes so that the spot gets `factor` times its light. False: the layer does not reach it.
    bool brighten(std::size_t layer, double factor);

    // The document's lights get the mix's strengths and colours: one undo step. The pictures stay.
    void apply(SelectContext& editor);
    void forget(); // of another document

  private:
    struct Of { // what the pictures depend on
        std::array<scene::Version, 12> versions{};
        std::uint64_t document = 0, view = 0, plugins = 0;
        glm::uvec2 size{0};
        scene::Filter filter;
        bool operator==(const Of&) const = default;
    };
    static Of of(const SelectContext& editor, glm::uvec2 size);
    void restart(SelectContext& editor);
    void update(PanelUi& editor, std::uint64_t document, bool denoise);

    struct Mixed { // what the frame shows
        std::shared_ptr<const view::LightPictures> pictures;
        std::vector<glm::vec3> weights; // of the pictures
        bool denoised = false;
        std::optional<glm::dvec2> spot;
        bool operator==(const Mixed&) const = default;
    };
    std::function<void()> wake_;
    view::LightMixer mixer_;
    std::vector<view::LightLayer> layers_;
    std::vector<glm::vec3> applied_; // by which the document differs from what is rendered
    std::optional<Of> of_;
    std::shared_ptr<const view::Frame> frame_;
    std::vector<double> shares_;
    Mixed mixed_;
    bool drawn_ = false;
    double drawn_at_ = 0; // [s]
    bool applying_ = false; // the next change of the document is that of apply()
};

PickTool spot_picker(); // sets LightMixing::spot

} // namespace restage::editor
