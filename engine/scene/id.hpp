// SPDX-License-Identifier: Apache-2.0
// Id<T>: a 1-based, never reused name of a slot in a Table<T>. Removing leaves a hole, so undo restores the same id.
// Every change of a slot gives it a new version from the scene's clock; derived data compares versions.
#pragma once

#include "base/copy_on_write.hpp"

#include <algorithm>
#include <array>
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

// Copies share slots and items until one of them changes: a copy costs one reference, a set() after it copies the chunk
// of its slot and the list of chunks, but no other item. Items are immutable once shared, so copies may be read on
// other threads.
template <class T>
class Table {
  public:
    // Number of slots, holes included: ids run from 1 to size().
    std::uint32_t size() const { return root_ ? root_->size : 0; }
    std::uint32_t live() const { return root_ ? root_->live : 0; }

    const T* find(Id<T> id) const {
        const Slot* slot = slot_of(id);
        return slot ? slot->item.get() : nullptr;
    }
    const T& operator[](Id<T> id) const {
        assert(find(id));
        return *slot_of(id)->item;
    }
    Version version(Id<T> id) const {
        const Slot* slot = slot_of(id);
        return slot ? slot->version : 0;
    }
    Version version() const { return root_ ? root_->version : 0; } // of the latest change anywhere in the table
    Id<T> next() const { return {size() + 1}; } // the id of the next append

    // The only mutator: nullopt removes. `id` is next() or an existing slot.
    void set(Id<T> id, std::optional<T> item, Version version) {
        assert(id && id.value <= size() + 1);
        if (!root_) root_.assign({});
        Root& root = root_.own();
        const std::uint32_t i = id.value - 1;
        if (i / chunk_slots == root.chunks.size()) root.chunks.emplace_back(Chunk{});
        root.size = std::max(root.size, id.value);
        Chunk& chunk = root.chunks[i / chunk_slots].own();
        Slot& slot = chunk.slots[i % chunk_slots];
        root.live += (item ? 1u : 0u) - (slot.item ? 1u : 0u);
        if (item)
            slot.item.assign(std::move(*item));
        else
            slot.item = {};
        slot.version = root.version = version;
        chunk.version = std::max(chunk.version, version);
    }
    // Every slot gets the version; the items stay.
    void set_versions(Version version) {
        if (!root_) return;
        Root& root = root_.own();
        for (std::uint32_t i = 0; i < root.size; ++i) {
            Chunk& chunk = root.chunks[i / chunk_slots].own();
            chunk.slots[i % chunk_slots].version = chunk.version = version;
        }
        root.version = version;
    }

    // f(Id<T>, const T&) for every live slot, in order of id. f may change the table: the walk sees a snapshot.
    template <class F>
    void each(F&& f) const {
        walk(0, [&](Id<T> id, const Slot& slot) {
            if (slot.item) f(id, *slot.item);
        });
    }
    // f(Id<T>, const T*) for every slot changed after `version`; null if removed.
    template <class F>
    void each_changed(Version version, F&& f) const {
        walk(version, [&](Id<T> id, const Slot& slot) {
            if (slot.version > version) f(id, slot.item.get());
        });
    }

  private:
    // A set() after a copy increments a reference per chunk and per slot of one chunk: n / 128 + 128.
    static constexpr std::uint32_t chunk_slots = 128;
    struct Slot {
        CopyOnWrite<T> item;
        Version version = 0;
    };
    struct Chunk {
        std::array<Slot, chunk_slots> slots;
        Version version = 0; // the highest of its slots
    };
    struct Root {
        std::vector<CopyOnWrite<Chunk>> chunks;
        std::uint32_t size = 0, live = 0;
        Version version = 0;
    };

    const Slot* slot_of(Id<T> id) const {
        if (!id || !root_ || id.value > root_->size) return nullptr;
        return &root_->chunks[(id.value - 1) / chunk_slots]->slots[(id.value - 1) % chunk_slots];
    }
    template <class F>
    void walk(Version newer_than, F&& f) const {
        if (!root_) return;
        const CopyOnWrite<Root> root = root_;
        std::uint32_t first = 0;
        for (const CopyOnWrite<Chunk>& chunk : root->chunks) {
            const std::uint32_t count = std::min(root->size - first, chunk_slots);
            if (newer_than == 0 || chunk->version > newer_than)
                for (std::uint32_t i = 0; i < count; ++i)
                    f(Id<T>{first + i + 1}, chunk->slots[i]);
            first += count;
        }
    }

    CopyOnWrite<Root> root_;
};

} // namespace restage::scene

template <class T>
struct std::hash<restage::scene::Id<T>> {
    std::size_t operator()(restage::scene::Id<T> id) const noexcept { return std::hash<std::uint32_t>{}(id.value); }
};
