// SPDX-License-Identifier: Apache-2.0
// Id<T>: a 1-based, never reused name of a slot in a Table<T>. Removing leaves a hole, so undo restores the same id.
// Every change of a slot gives it a new version from the scene's clock; who derives from it compares versions.
#pragma once

#include <cassert>
#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace restage::scene {

using Version = std::uint64_t;

template <class T>
struct Id {
    std::uint32_t value = 0; // 0 = none
    explicit operator bool() const { return value != 0; }
    auto operator<=>(const Id&) const = default;
};

template <class T>
class Table {
  public:
    // Number of slots, holes included: ids run from 1 to size().
    std::uint32_t size() const { return static_cast<std::uint32_t>(slots_.size()); }
    std::uint32_t live() const { return live_; }

    const T* find(Id<T> id) const {
        return id && id.value <= slots_.size() && slots_[id.value - 1].item ? &*slots_[id.value - 1].item : nullptr;
    }
    const T& operator[](Id<T> id) const {
        assert(find(id));
        return *slots_[id.value - 1].item;
    }
    Version version(Id<T> id) const { return id && id.value <= slots_.size() ? slots_[id.value - 1].version : 0; }
    Version version() const { return version_; } // of the latest change anywhere in the table
    Id<T> next() const { return {size() + 1}; }  // the id the next append gets

    // The only way in: nullopt removes. `id` may be next(), or an existing slot.
    void set(Id<T> id, std::optional<T> item, Version version) {
        assert(id && id.value <= slots_.size() + 1);
        if (id.value > slots_.size()) slots_.emplace_back();
        auto& slot = slots_[id.value - 1];
        live_ += (item ? 1u : 0u) - (slot.item ? 1u : 0u);
        slot = {std::move(item), version};
        version_ = version;
    }

    // f(Id<T>, const T&) for every live slot, in order of id.
    template <class F>
    void each(F&& f) const {
        for (std::uint32_t i = 0; i < slots_.size(); ++i)
            if (slots_[i].item) f(Id<T>{i + 1}, *slots_[i].item);
    }

  private:
    struct Slot {
        std::optional<T> item;
        Version version = 0;
    };
    std::vector<Slot> slots_;
    std::uint32_t live_ = 0;
    Version version_ = 0;
};

} // namespace restage::scene

template <class T>
struct std::hash<restage::scene::Id<T>> {
    std::size_t operator()(restage::scene::Id<T> id) const noexcept { return std::hash<std::uint32_t>{}(id.value); }
};
