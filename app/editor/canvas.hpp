// SPDX-License-Identifier: Apache-2.0
// Canvas: an image that keeps the window's content from frame to frame, so that parts of it can be redrawn.
#pragma once

#include "gpu/device.hpp"

#include <volk.h>
#include <cstdint>

struct VmaAllocation_T;

namespace restage::editor {

class Canvas {
  public:
    // width, height [pixel] > 0.
    static Result<Canvas> create(gpu::Device& device, VkFormat format, std::uint32_t width, std::uint32_t height);
    Canvas() = default;
    Canvas(Canvas&& other) noexcept { swap(other); }
    Canvas& operator=(Canvas&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Canvas();

    VkRenderPass render_pass() const { return pass_; } // compatible between canvases of one format

    // Between the two, drawing goes to `area`, which was cleared to black.
    void begin(VkCommandBuffer commands, VkRect2D area);
    void end(VkCommandBuffer commands) const;
    // Copies all of it into an image of the same size and format, then ready to be presented.
    void copy_to(VkCommandBuffer commands, VkImage target) const;

  private:
    void swap(Canvas& other) noexcept;
    gpu::Device* device_ = nullptr;
    VkImage image_ = VK_NULL_HANDLE;
    VmaAllocation_T* allocation_ = nullptr;
    VkImageView view_ = VK_NULL_HANDLE;
    VkRenderPass pass_ = VK_NULL_HANDLE;
    VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
    std::uint32_t width_ = 0, height_ = 0;
    bool fresh_ = true; // never drawn to
};

} // namespace restage::editor
