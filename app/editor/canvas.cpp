// SPDX-License-Identifier: Apache-2.0
#include "canvas.hpp"

#include <vk_mem_alloc.h>
#include <utility>

namespace restage::editor {

Result<Canvas> Canvas::create(gpu::Device& device, VkFormat format, std::uint32_t width, std::uint32_t height) {
    Canvas c;
    c.device_ = &device;
    c.width_ = width;
    c.height_ = height;
    const VkImageCreateInfo image{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = VK_IMAGE_TYPE_2D,
                                  .format = format,
                                  .extent = {width, height, 1},
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .tiling = VK_IMAGE_TILING_OPTIMAL,
                                  .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
    const VmaAllocationCreateInfo memory{.usage = VMA_MEMORY_USAGE_AUTO};
    VkResult result = vmaCreateImage(device.allocator(), &image, &memory, &c.image_, &c.allocation_, nullptr);
    if (result != VK_SUCCESS) return device.error(result, "creating the window's image");
    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = c.image_,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format,
                                     .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    result = vkCreateImageView(device.handle(), &view, nullptr, &c.view_);
    if (result != VK_SUCCESS) return device.error(result, "creating the window's image");

    const VkAttachmentDescription attachment{.format = format,
                                             .samples = VK_SAMPLE_COUNT_1_BIT,
                                             .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                             .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                             .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                                             .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                             .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                             .finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{
        .pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS, .colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkSubpassDependency drawn_before_copied{.srcSubpass = 0,
                                                  .dstSubpass = VK_SUBPASS_EXTERNAL,
                                                  .srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                                  .dstStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
                                                  .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                                  .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
    const VkRenderPassCreateInfo pass{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                      .attachmentCount = 1,
                                      .pAttachments = &attachment,
                                      .subpassCount = 1,
                                      .pSubpasses = &subpass,
                                      .dependencyCount = 1,
                                      .pDependencies = &drawn_before_copied};
    result = vkCreateRenderPass(device.handle(), &pass, nullptr, &c.pass_);
    if (result != VK_SUCCESS) return device.error(result, "creating the window's image");
    const VkFramebufferCreateInfo framebuffer{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                              .renderPass = c.pass_,
                                              .attachmentCount = 1,
                                              .pAttachments = &c.view_,
                                              .width = width,
                                              .height = height,
                                              .layers = 1};
    result = vkCreateFramebuffer(device.handle(), &framebuffer, nullptr, &c.framebuffer_);
    if (result != VK_SUCCESS) return device.error(result, "creating the window's image");
    return c;
}

Canvas::~Canvas() {
    if (!device_) return;
    vkDestroyFramebuffer(device_->handle(), framebuffer_, nullptr);
    vkDestroyRenderPass(device_->handle(), pass_, nullptr);
    vkDestroyImageView(device_->handle(), view_, nullptr);
    vmaDestroyImage(device_->allocator(), image_, allocation_);
}

void Canvas::swap(Canvas& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(allocation_, other.allocation_);
    std::swap(view_, other.view_);
    std::swap(pass_, other.pass_);
    std::swap(framebuffer_, other.framebuffer_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    std::swap(fresh_, other.fresh_);
}

namespace {

void transition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to,
                VkPipelineStageFlags from_stage, VkAccessFlags from_access, VkPipelineStageFlags to_stage,
                VkAccessFlags to_access) {
    const VkImageMemoryBarrier barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                       .srcAccessMask = from_access,
                                       .dstAccessMask = to_access,
                                       .oldLayout = from,
                                       .newLayout = to,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .image = image,
                                       .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, from_stage, to_stage, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

} // namespace

void Canvas::begin(VkCommandBuffer commands, VkRect2D area) {
    // The last frame's copy has finished.
    transition(commands, image_,
               std::exchange(fresh_, false) ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
               VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
               VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
               VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT);
    const VkRenderPassBeginInfo pass{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                     .renderPass = pass_,
                                     .framebuffer = framebuffer_,
                                     .renderArea = area};
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    const VkClearAttachment black{.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT, .colorAttachment = 0, .clearValue = {}};
    const VkClearRect rect{.rect = area, .baseArrayLayer = 0, .layerCount = 1};
    vkCmdClearAttachments(commands, 1, &black, 1, &rect);
}

void Canvas::end(VkCommandBuffer commands) const { vkCmdEndRenderPass(commands); }

void Canvas::copy_to(VkCommandBuffer commands, VkImage target) const {
    transition(commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
               VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT);
    const VkImageCopy all{.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                          .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                          .extent = {width_, height_, 1}};
    vkCmdCopyImage(commands, image_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                   1, &all);
    transition(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
               VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0);
}

} // namespace restage::editor
