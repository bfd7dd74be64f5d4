// SPDX-License-Identifier: Apache-2.0
// CopyOnWrite<T>: a value shared by its copies until one of them changes it. Each holder is used by one thread at a
// time, like any value; different holders of the same value may be read, changed and destroyed on different threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace restage {

template <class T>
class CopyOnWrite {
  public:
    CopyOnWrite() = default; // holds nothing
    explicit CopyOnWrite(T value) : box_(new Box{std::move(value)}) {}
    CopyOnWrite(const CopyOnWrite& other) : box_(other.box_) {
        if (box_) box_->holders.fetch_add(1, std::memory_order_relaxed);
    }
    CopyOnWrite(CopyOnWrite&& other) noexcept : box_(std::exchange(other.box_, nullptr)) {}
    CopyOnWrite& operator=(CopyOnWrite other) noexcept {
        std::swap(box_, other.box_);
        return *this;
    }
    ~CopyOnWrite() {
        if (box_ && box_->holders.fetch_sub(1, std::memory_order_acq_rel) == 1) delete box_;
    }

    explicit operator bool() const { return box_; }
    const T* get() const { return box_ ? &box_->value : nullptr; }
    const T& operator*() const { return box_->value; }
    const T* operator->() const { return &box_->value; }

    // The value for writing; copied first if shared. With a single holder no other can appear
    // meanwhile; `acquire` orders the last other holder's reads before our writes.
    T& own() {
        if (box_->holders.load(std::memory_order_acquire) != 1) *this = CopyOnWrite(box_->value);
        return box_->value;
    }
    void assign(T value) { // likewise, without copying the old value
        if (box_ && box_->holders.load(std::memory_order_acquire) == 1)
            box_->value = std::move(value);
        else
            *this = CopyOnWrite(std::move(value));
    }

  private:
    struct Box {
        T value;
        std::atomic<std::uint32_t> holders{1};
    };
    Box* box_ = nullptr;
};

} // namespace restage
