// SPDX-License-Identifier: Apache-2.0
// Pictures: of what a LiveView has made, what is shown. The rule is here alone, so that it can be held by a test: where
// pictures are denoised nothing noisy is ever shown, and nothing of another document. Its owner locks.
#pragma once

#include "view/live_view.hpp"

namespace restage::view {

class Pictures {
  public:
    // What is asked for from now on; of another document nothing is shown any more.
    void ask(std::uint64_t document, bool denoise) {
        denoise_ = denoise;
        if (document == document_) return;
        document_ = document;
        raw_ = clean_ = clay_ = nullptr;
    }
    // Finished ones, in the order in which they were made. One of a document that is no longer asked for is dropped.
    void put(std::shared_ptr<const Frame> frame) {
        if (frame->document != document_) return;
        (frame->clay ? clay_ : frame->denoised ? clean_ : raw_) = std::move(frame);
    }
    // Denoising works (""), or why it does not.
    void denoiser(std::string missing) { missing_ = std::move(missing); }
    const std::string& denoiser_missing() const { return missing_; }

    const std::shared_ptr<const Frame>& raw() const { return raw_; }
    const std::shared_ptr<const Frame>& clean() const { return clean_; }
    // The last clean one stays until the next is there, however old; before the first, clay.
    const std::shared_ptr<const Frame>& best(bool want_denoised) const {
        const auto& real = want_denoised && denoise_ && missing_.empty() ? clean_ : raw_;
        return real ? real : clay_;
    }

  private:
    std::uint64_t document_ = 0;
    bool denoise_ = true;
    std::string missing_;
    std::shared_ptr<const Frame> raw_, clean_, clay_;
};

} // namespace restage::view
