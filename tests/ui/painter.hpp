// SPDX-License-Identifier: Apache-2.0
// Dear ImGui's triangles as pixels, without a device: what a panel looks like at any scale, in milliseconds.
#pragma once

#include <imgui.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace restage::tests {

class Painter {
  public:
    // Everything drawn inside the rectangle [lower, upper) of the window, over black.
    Painter(const ImDrawData& data, ImVec2 lower, ImVec2 upper)
        : lower_(std::floor(lower.x), std::floor(lower.y)),
          width_(int(std::ceil(upper.x) - lower_.x)),
          height_(int(std::ceil(upper.y) - lower_.y)),
          pixels_(std::size_t(std::max(width_ * height_, 0)) * 3) {
        for (const ImDrawList* list : data.CmdLists)
            for (const ImDrawCmd& command : list->CmdBuffer)
                if (!command.UserCallback) draw(*list, command);
    }

    void write_ppm(const std::filesystem::path& file) const {
        std::ofstream out(file, std::ios::binary);
        out << "P6\n" << width_ << ' ' << height_ << "\n255\n";
        for (const float v : pixels_)
            out.put(char(std::uint8_t(std::clamp(v, 0.f, 1.f) * 255 + 0.5f)));
    }

  private:
    static float cross(ImVec2 a, ImVec2 b, ImVec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

    static std::array<float, 4> texel(const ImTextureData* texture, ImVec2 uv) { // nearest
        if (!texture || !texture->Pixels) return {0.5f, 0.5f, 0.5f, 1};
        const int x = std::clamp(int(uv.x * float(texture->Width)), 0, texture->Width - 1);
        const int y = std::clamp(int(uv.y * float(texture->Height)), 0, texture->Height - 1);
        const auto* p = static_cast<const std::uint8_t*>(const_cast<ImTextureData*>(texture)->GetPixelsAt(x, y));
        if (texture->Format == ImTextureFormat_Alpha8) return {1, 1, 1, float(p[0]) / 255};
        return {float(p[0]) / 255, float(p[1]) / 255, float(p[2]) / 255, float(p[3]) / 255};
    }

    void draw(const ImDrawList& list, const ImDrawCmd& command) {
        for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
            std::array<ImDrawVert, 3> v;
            for (unsigned k = 0; k < 3; ++k)
                v[k] = list.VtxBuffer[int(list.IdxBuffer[int(command.IdxOffset + i + k)] + command.VtxOffset)];
            triangle(v, command.ClipRect, command.TexRef._TexData);
        }
    }

    void triangle(const std::array<ImDrawVert, 3>& v, const ImVec4& clip, const ImTextureData* texture) {
        const float area = cross(v[0].pos, v[1].pos, v[2].pos);
        if (area == 0) return;
        const auto [left, right] = std::minmax({v[0].pos.x, v[1].pos.x, v[2].pos.x});
        const auto [top, bottom] = std::minmax({v[0].pos.y, v[1].pos.y, v[2].pos.y});
        const int x0 = std::max(0, int(std::max(left, clip.x) - lower_.x)),
                  x1 = std::min(width_, int(std::ceil(std::min(right, clip.z) - lower_.x)));
        const int y0 = std::max(0, int(std::max(top, clip.y) - lower_.y)),
                  y1 = std::min(height_, int(std::ceil(std::min(bottom, clip.w) - lower_.y)));
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                const ImVec2 at(lower_.x + float(x) + 0.5f, lower_.y + float(y) + 0.5f);
                const std::array<float, 3> w{cross(v[1].pos, v[2].pos, at) / area, cross(v[2].pos, v[0].pos, at) / area,
                                             cross(v[0].pos, v[1].pos, at) / area};
                if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
                std::array<float, 4> color{};
                ImVec2 uv(0, 0);
                for (std::size_t k = 0; k < 3; ++k) {
                    const ImVec4 c = ImGui::ColorConvertU32ToFloat4(v[k].col);
                    const std::array<float, 4> of{c.x, c.y, c.z, c.w};
                    for (std::size_t j = 0; j < 4; ++j)
                        color[j] += w[k] * of[j];
                    uv.x += w[k] * v[k].uv.x, uv.y += w[k] * v[k].uv.y;
                }
                const std::array<float, 4> t = texel(texture, uv);
                const float alpha = color[3] * t[3];
                float* to = &pixels_[(std::size_t(y) * std::size_t(width_) + std::size_t(x)) * 3];
                for (std::size_t j = 0; j < 3; ++j)
                    to[j] += alpha * (color[j] * t[j] - to[j]);
            }
    }

    ImVec2 lower_;
    int width_, height_;
    std::vector<float> pixels_;
};

} // namespace restage::tests
