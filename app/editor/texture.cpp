// SPDX-License-Identifier: Apache-2.0
#include "texture.hpp"

#include <imgui_internal.h>
#include <cstring>
#include <utility>

namespace restage::editor {

namespace {
constexpr std::size_t most_sizes = 8;
}

Texture::~Texture() {
    IM_ASSERT(!ImGui::GetCurrentContext() && "the window is destroyed before its textures");
    for (auto& [size, data] : sizes_)
        IM_DELETE(data);
    for (ImTextureData* data : leaving_)
        IM_DELETE(data);
}

void Texture::set(std::uint32_t width, std::uint32_t height, std::span<const std::uint32_t> rgba) {
    if (width == 0 || height == 0 || rgba.size() < std::size_t(width) * height) return;
    ImTextureData*& data = sizes_[{int(width), int(height)}];
    if (data && (data->Status == ImTextureStatus_WantDestroy || data->Status == ImTextureStatus_Destroyed))
        leaving_.push_back(std::exchange(data, nullptr)); // the backend has it, or is done with it
    if (data) data->WantDestroyNextFrame = false;
    if (!data) {
        data = IM_NEW(ImTextureData)();
        data->Create(ImTextureFormat_RGBA32, int(width), int(height));
        data->UseColors = true;
        ImGui::RegisterUserTexture(data);
        std::memcpy(data->GetPixels(), rgba.data(), std::size_t(data->GetSizeInBytes()));
    } else {
        std::memcpy(data->GetPixels(), rgba.data(), std::size_t(data->GetSizeInBytes()));
        if (data->Status == ImTextureStatus_OK || data->Status == ImTextureStatus_WantUpdates)
            ImTextureDataQueueUpload(data, 0, 0, int(width), int(height));
    }
    current_ = data;
    retire_others();
}

void Texture::retire_others() {
    std::erase_if(leaving_, [](ImTextureData* data) {
        if (data->Status != ImTextureStatus_Destroyed) return false;
        ImGui::UnregisterUserTexture(data);
        IM_DELETE(data);
        return true;
    });
    for (auto it = sizes_.begin(); it != sizes_.end();) {
        ImTextureData* data = it->second;
        if (data != current_ && sizes_.size() > most_sizes) data->WantDestroyNextFrame = true;
        if (data != current_ && data->Status == ImTextureStatus_Destroyed) {
            ImGui::UnregisterUserTexture(data);
            IM_DELETE(data);
            it = sizes_.erase(it);
        } else {
            ++it;
        }
    }
}

} // namespace restage::editor
