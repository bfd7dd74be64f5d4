// SPDX-License-Identifier: Apache-2.0
// Pictures: selects which of a LiveView's pictures is shown. The rule is only here, so that it can be tested: if
// pictures are denoised nothing noisy is ever shown, and nothing of another document. The owner locks.
#pragma once

#include "view/live_view.hpp"

namespace restage::view {

class Pictures {
  public:
    // The current request; pictures of other documents are no longer shown.
    void ask(std::uint64_t document, bool denoise, std::optional<render::ClayLook> look = {}) {
        denoise_ = denoise;
        look_ = look;
        if (document == document_) return;
        document_ = document;
        raw_ = clean_ = clay_ = nullptr;
    }
    // Finished pictures, in order of creation. Those of a document no longer requested are dropped.
    void put(std::shared_ptr<const Frame> frame) {
        if (frame->document != document_) return;
        (frame->clay ? clay_ : frame->denoised ? clean_ : raw_) = std::move(frame);
    }
    // "" if denoising works, else why not.
    void denoiser(std::string missing) { missing_ = std::move(missing); }
    const std::string& denoiser_missing() const { return missing_; }

    const std::shared_ptr<const Frame>& raw() const { return raw_; }
    const std::shared_ptr<const Frame>& clean() const { return clean_; }
    // Of first hits, if the current request is for those and there is one.
    std::shared_ptr<const Frame> of_look() const { return look_ && clay_ && clay_->look == look_ ? clay_ : nullptr; }
    bool wants_look() const { return look_.has_value(); }
    // The last clean one stays until the next is ready, however old; before the first, clay.
    const std::shared_ptr<const Frame>& best(bool want_denoised) const {
        if (look_ && clay_ && clay_->look == look_) return clay_;
        const auto& real = want_denoised && denoise_ && missing_.empty() ? clean_ : raw_;
        return real ? real : clay_;
    }

  private:
    std::uint64_t document_ = 0;
    bool denoise_ = true;
    std::optional<render::ClayLook> look_;
    std::string missing_;
    std::shared_ptr<const Frame> raw_, clean_, clay_;
};

} // namespace restage::view
