// SPDX-License-Identifier: Apache-2.0
#include "damage.hpp"

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <utility>

namespace restage::editor {

namespace {

// 64 bits at a time: multiply and fold.
class Hash {
  public:
    void add(std::uint64_t x) {
        state_ = (state_ ^ x) * 0x9e3779b97f4a7c15u;
        state_ ^= state_ >> 32;
    }
    void add(float a, float b) {
        add(std::uint64_t(std::bit_cast<std::uint32_t>(a)) << 32 | std::bit_cast<std::uint32_t>(b));
    }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 1;
};

ImRect nothing() { return {FLT_MAX, FLT_MAX, -FLT_MAX, -FLT_MAX}; }

} // namespace

ImRect Damage::update(const ImDrawData& data) {
    items_.clear();
    for (const ImDrawList* list : data.CmdLists)
        for (const ImDrawCmd& command : list->CmdBuffer) {
            Item item{.bounds = nothing()};
            Hash hash;
            const ImVec4& clip = command.ClipRect;
            hash.add(clip.x, clip.y);
            hash.add(clip.z, clip.w);
            hash.add(reinterpret_cast<std::uintptr_t>(command.TexRef._TexData));
            hash.add(command.TexRef._TexData ? 0 : std::uint64_t(command.TexRef._TexID));
            hash.add(reinterpret_cast<std::uintptr_t>(command.UserCallback));
            const ImDrawVert* vertices = list->VtxBuffer.Data + command.VtxOffset;
            const ImDrawIdx* indices = list->IdxBuffer.Data + command.IdxOffset;
            for (unsigned i = 0; i < command.ElemCount; ++i) {
                const ImDrawVert& v = vertices[indices[i]];
                hash.add(v.pos.x, v.pos.y);
                hash.add(v.uv.x, v.uv.y);
                hash.add(v.col);
                item.bounds.Add(v.pos);
            }
            item.bounds.ClipWith({clip.x, clip.y, clip.z, clip.w});
            item.hash = hash.value();
            item.texture_changed = command.TexRef._TexData && command.TexRef._TexData->Status != ImTextureStatus_OK;
            items_.push_back(item);
        }

    // Both frames share a common prefix and suffix, in order; what lies between differs.
    const auto same = [](const Item& a, const Item& b) { return a.hash == b.hash; };
    const auto begin = std::size_t(std::ranges::mismatch(last_, items_, same).in1 - last_.begin());
    std::size_t end = 0; // items of the common suffix
    while (end < std::min(last_.size(), items_.size()) - begin &&
           same(last_[last_.size() - 1 - end], items_[items_.size() - 1 - end]))
        ++end;
    ImRect damage = nothing();
    const auto add = [&](const Item& item) {
        if (item.bounds.Min.x < item.bounds.Max.x && item.bounds.Min.y < item.bounds.Max.y) damage.Add(item.bounds);
    };
    const bool paired = last_.size() == items_.size();
    for (std::size_t i = begin; i < items_.size() - end; ++i)
        if (!paired || !same(last_[i], items_[i])) add(items_[i]);
    for (std::size_t i = begin; i < last_.size() - end; ++i)
        if (!paired || !same(last_[i], items_[i])) add(last_[i]);
    for (const Item& item : items_)
        if (item.texture_changed) add(item);
    last_.swap(items_);

    const ImRect all(data.DisplayPos, {data.DisplayPos.x + data.DisplaySize.x, data.DisplayPos.y + data.DisplaySize.y});
    if (std::exchange(forgotten_, false)) return all;
    if (damage.Min.x >= damage.Max.x) return damage;
    damage = {std::floor(damage.Min.x), std::floor(damage.Min.y), std::ceil(damage.Max.x), std::ceil(damage.Max.y)};
    damage.ClipWithFull(all);
    return damage;
}

void Damage::clip(ImDrawData& data, const ImRect& rect) {
    for (ImDrawList* list : data.CmdLists)
        for (ImDrawCmd& command : list->CmdBuffer) {
            ImVec4& c = command.ClipRect;
            c = {std::max(c.x, rect.Min.x), std::max(c.y, rect.Min.y), std::min(c.z, rect.Max.x),
                 std::min(c.w, rect.Max.y)};
        }
}

} // namespace restage::editor
