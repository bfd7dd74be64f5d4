// SPDX-License-Identifier: Apache-2.0
// GpuArray<T>: a host vector and its buffer on the device. Change the vector, flush(): only differences are uploaded,
// item by item if they are few.
#pragma once

#include "gpu/device.hpp"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace restage::render {

template <class T>
class GpuArray {
  public:
    explicit GpuArray(const char* name) : name_(name) {}

    const std::vector<T>& host() const { return host_; }
    const T& operator[](std::size_t i) const { return host_[i]; }
    std::size_t size() const { return host_.size(); }
    std::uint64_t address() const { return buffer_.address(); }

    void assign(std::vector<T> values) {
        if (values.size() == host_.size() && same(values.data(), host_.data(), values.size())) return;
        host_ = std::move(values);
        touch(0, host_.size());
    }
    void resize(std::size_t n, const T& fill) {
        const std::size_t old = host_.size();
        host_.resize(n, fill);
        touch(std::min(old, n), n);
    }
    void set(std::size_t i, const T& value) {
        if (same(&value, &host_[i], 1)) return;
        host_[i] = value;
        touch(i, i + 1);
    }
    // Uploads what changed. No work that reads it may be running.
    Result<void> flush(gpu::Device& device) {
        if (!buffer_ || buffer_.size() < host_.size() * sizeof(T)) {
            // 1.5 times, so that inserting items one by one does not reallocate each time
            const std::size_t capacity = std::max<std::size_t>(host_.size() + host_.size() / 2, 4);
            RESTAGE_TRY(buffer_, device.create_buffer(capacity * sizeof(T), gpu::BufferKind::host, name_));
            touch(0, host_.size());
        }
        for (const Range& r : changed_) {
            const std::size_t last = std::min(r.last, host_.size()); // it may have shrunk since
            if (r.first >= last) continue;
            const auto bytes =
                std::as_bytes(std::span(host_)).subspan(r.first * sizeof(T), (last - r.first) * sizeof(T));
            RESTAGE_CHECK(device.upload(buffer_, r.first * sizeof(T), bytes));
            uploaded_bytes_ += bytes.size();
        }
        changed_.clear();
        return {};
    }
    std::size_t uploaded_bytes() const { return uploaded_bytes_; } // in total: tests check edits against it

  private:
    static bool same(const T* a, const T* b, std::size_t n) { return n == 0 || std::memcmp(a, b, n * sizeof(T)) == 0; }
    void touch(std::size_t first, std::size_t last) {
        if (first >= last) return;
        constexpr std::size_t most = 64; // then the last one grows
        const bool apart = changed_.empty() || first > changed_.back().last || last < changed_.back().first;
        if (apart && changed_.size() < most) {
            changed_.push_back({first, last});
            return;
        }
        Range& r = changed_.back();
        r.first = std::min(r.first, first);
        r.last = std::max(r.last, last);
    }
    const char* name_;
    std::vector<T> host_;
    gpu::Buffer buffer_;
    struct Range {
        std::size_t first, last;
    };
    std::vector<Range> changed_;
    std::size_t uploaded_bytes_ = 0;
};

} // namespace restage::render
