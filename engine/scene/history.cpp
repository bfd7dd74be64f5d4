// SPDX-License-Identifier: Apache-2.0
#include "scene/history.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <unordered_map>
#include <utility>

namespace restage::scene {

namespace {

// A change's target: its type and, for tables, its id.
std::uint64_t target(const AnyChange& change) {
    const std::uint32_t id = std::visit(
        []<class C>(const C& c) -> std::uint32_t {
            if constexpr (requires { c.id; })
                return c.id.value;
            else
                return 0;
        },
        change);
    return std::uint64_t(change.index()) << 32 | id;
}

void drop_idle_changes(Edit& edit) {
    std::erase_if(edit.changes, [](const AnyChange& change) {
        return std::visit([](const auto& c) { return c.before == c.after; }, change);
    });
}

// `later` follows `edit`: each target keeps its first `before` and gets the last `after`. Changes of different
// targets commute, and an insert keeps its first position.
void merge(Edit& edit, const Edit& later) {
    std::unordered_map<std::uint64_t, std::size_t> place;
    place.reserve(edit.changes.size());
    for (std::size_t i = 0; i < edit.changes.size(); ++i)
        place.emplace(target(edit.changes[i]), i);
    for (const AnyChange& change : later.changes) {
        const auto [found, is_new] = place.emplace(target(change), edit.changes.size());
        if (is_new)
            edit.changes.push_back(change);
        else
            std::visit([&]<class C>(const C& c) { std::get<C>(edit.changes[found->second]).after = c.after; }, change);
    }
    drop_idle_changes(edit);
}

// --- memory held by an edit

std::size_t heap_bytes(const std::string& text) {
    return text.capacity() > std::string().capacity() ? text.capacity() + 1 : 0;
}

std::size_t heap_bytes(const ParamSet& params) {
    std::size_t sum = params.entries().capacity() * sizeof(ParamSet::Entry);
    for (const ParamSet::Entry& entry : params.entries())
        sum += heap_bytes(entry.id) + heap_bytes(entry.value.text);
    return sum;
}

std::size_t heap_bytes(const Origin& origin) {
    std::size_t sum = heap_bytes(origin.verbatim) + heap_bytes(origin.format);
    for (const OriginValue& value : origin.values)
        sum += sizeof value + heap_bytes(value.id) + heap_bytes(value.text);
    return sum;
}

// Heap bytes of an item, without shared data. A test compares this with the fields of project files.
template <class T>
std::size_t heap_bytes(const T& item) {
    std::size_t sum = 0;
    if constexpr (requires { item.name; }) sum += heap_bytes(item.name);
    if constexpr (requires { item.type.size(); }) sum += heap_bytes(item.type);
    if constexpr (requires { item.params.entries(); }) sum += heap_bytes(item.params);
    if constexpr (requires { item.origin; }) sum += heap_bytes(item.origin);
    if constexpr (requires { item.sky_params; }) sum += heap_bytes(item.sky) + heap_bytes(item.sky_params);
    if constexpr (requires { item.filename; }) sum += heap_bytes(item.filename);
    if constexpr (requires { item.source_file; }) sum += heap_bytes(item.source_file) + heap_bytes(item.primitive);
    if constexpr (requires { item.path; }) sum += heap_bytes(item.path);
    return sum;
}

template <class T>
std::size_t heap_bytes(const std::optional<T>& item) {
    return item ? heap_bytes(*item) : 0;
}

std::size_t own_bytes(const Edit& edit) {
    std::size_t sum = heap_bytes(edit.label) + edit.changes.capacity() * sizeof(AnyChange);
    for (const AnyChange& change : edit.changes)
        sum += std::visit([](const auto& c) { return heap_bytes(c.before) + heap_bytes(c.after); }, change);
    return sum;
}

std::size_t data_bytes(const MeshData& m) {
    return m.positions.size() * sizeof(glm::vec3) + m.normals.size() * sizeof(glm::vec3) +
           (m.uvs.size() + m.uvs2.size()) * sizeof(glm::vec2) + m.triangles.size() * sizeof(glm::uvec3) +
           m.tangents.size() * sizeof(glm::vec4);
}

std::size_t data_bytes(const PixelData& p) { return p.values.size() * sizeof(float); }

} // namespace

History::Entry History::hold(Edit edit) {
    Entry entry{std::move(edit)};
    entry.bytes = own_bytes(entry.edit);
    own_bytes_ += entry.bytes;
    count_shared(entry.edit, 1);
    return entry;
}

void History::count_shared(const Edit& edit, int sign) {
    const auto count = [&](const auto& item) {
        if constexpr (requires { item->data; }) {
            if (!item || !item->data) return;
            Shared& shared = shared_[item->data.get()];
            if (shared.holders == 0) shared = {item->data, data_bytes(*item->data), 0};
            shared.holders += sign;
            if (shared.holders == 0) shared_.erase(item->data.get());
        }
    };
    for (const AnyChange& change : edit.changes)
        std::visit([&](const auto& c) { count(c.before), count(c.after); }, change);
}

void History::forget(std::vector<Entry>::iterator first, std::vector<Entry>::iterator last) {
    for (auto entry = first; entry != last; ++entry) {
        own_bytes_ -= entry->bytes;
        count_shared(entry->edit, -1);
    }
    entries_.erase(first, last);
}

std::size_t History::bytes() const {
    std::size_t sum = own_bytes_;
    for (const auto& [data, shared] : shared_)
        if (shared.data.use_count() == shared.holders) sum += shared.bytes;
    return sum;
}

void History::set_budget(std::size_t bytes) {
    budget_ = bytes;
    hold_to_budget();
}

void History::hold_to_budget() {
    while (position_ > 1 && bytes() > budget_) {
        forget(entries_.begin(), entries_.begin() + 1);
        --position_;
        ++dropped_;
        for (auto* clean : {&clean_, &clean_before_}) // a state before the oldest entry is unreachable
            if (*clean) *clean = **clean > 0 ? std::optional(**clean - 1) : std::nullopt;
    }
}

bool History::push(Scene& scene, Edit edit, std::string_view gesture) {
    drop_idle_changes(edit);
    if (edit.changes.empty()) return false;
    apply(scene, edit);
    if (!gesture.empty() && gesture == gesture_ && position_ > 0) {
        Edit& running = entries_.back().edit;
        count_shared(running, -1);
        own_bytes_ -= std::exchange(entries_.back().bytes, 0);
        merge(running, edit);
        if (running.changes.empty()) { // dragged back to the start
            entries_.pop_back();
            --position_;
            end_gesture();
        } else {
            entries_.back() = hold(std::move(running));
            hold_to_budget();
        }
        return true;
    }
    end_gesture();
    if (!gesture.empty()) {
        redo_before_.assign(std::make_move_iterator(entries_.begin() + std::ptrdiff_t(position_)),
                            std::make_move_iterator(entries_.end()));
        entries_.resize(position_);
        clean_before_ = clean_;
    }
    append(hold(std::move(edit)));
    gesture_ = gesture;
    return true;
}

void History::push_beside(Scene& scene, Edit edit, Beside beside) {
    drop_idle_changes(edit);
    ++scene.clock; // also if only what is beside it changes
    apply(scene, edit);
    end_gesture();
    Entry entry = hold(std::move(edit));
    entry.replaces = true;
    entry.before = std::exchange(beside_, beside);
    entry.after = std::move(beside);
    append(std::move(entry));
}

void History::append(Entry entry) {
    forget(entries_.begin() + std::ptrdiff_t(position_), entries_.end());
    if (clean_ && *clean_ > position_) clean_.reset();
    entries_.push_back(std::move(entry));
    ++position_;
    hold_to_budget();
}

void History::end_gesture() {
    gesture_.clear();
    for (const Entry& entry : redo_before_) {
        own_bytes_ -= entry.bytes;
        count_shared(entry.edit, -1);
    }
    redo_before_.clear();
}

bool History::cancel_gesture(Scene& scene) {
    if (gesture_.empty() || position_ == 0) return false;
    apply(scene, inverse(entries_[position_ - 1].edit));
    forget(entries_.begin() + std::ptrdiff_t(--position_), entries_.end());
    std::ranges::move(redo_before_, std::back_inserter(entries_)); // restored, and so is the saved state
    redo_before_.clear();
    clean_ = clean_before_;
    end_gesture();
    return true;
}

bool History::undo(Scene& scene) {
    end_gesture();
    if (position_ == 0) return false;
    const Entry& entry = entries_[--position_];
    ++scene.clock;
    apply(scene, inverse(entry.edit));
    if (entry.replaces) beside_ = entry.before;
    return true;
}

bool History::redo(Scene& scene) {
    end_gesture();
    if (position_ == entries_.size()) return false;
    const Entry& entry = entries_[position_++];
    ++scene.clock;
    apply(scene, entry.edit);
    if (entry.replaces) beside_ = entry.after;
    return true;
}

void History::mark_clean() {
    clean_ = position_;
    end_gesture();
}

} // namespace restage::scene
