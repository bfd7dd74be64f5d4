// SPDX-License-Identifier: Apache-2.0
// GpuArray<T>: a host vector and its buffer on the device. Change the vector, flush(): only differences are uploaded.
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
        if (first_ < last_) {
            const auto bytes =
                std::as_bytes(std::span(host_)).subspan(first_ * sizeof(T), (last_ - first_) * sizeof(T));
            RESTAGE_CHECK(device.upload(buffer_, first_ * sizeof(T), bytes));
            uploaded_bytes_ += bytes.size();
        }
        first_ = last_ = 0;
        return {};
    }
    std::size_t uploaded_bytes() const { return uploaded_bytes_; } // in total: tests check edits against it

  private:
    static bool same(const T* a, const T* b, std::size_t n) { return n == 0 || std::memcmp(a, b, n * sizeof(T)) == 0; }
    void touch(std::size_t first, std::size_t last) {
        if (first_ == last_) {
            first_ = first;
            last_ = last;
        } else {
            first_ = std::min(first_, first);
            last_ = std::max(last_, last);
        }
        last_ = std::min(last_, host_.size());
        first_ = std::min(first_, last_);
    }
    const char* name_;
    std::vector<T> host_;
    gpu::Buffer buffer_;
    std::size_t first_ = 0, last_ = 0, uploaded_bytes_ = 0;
};

} // namespace restage::render
