// SPDX-License-Identifier: Apache-2.0
// OpenEXR's streams over memory: files are read and written whole. Private to io.
#pragma once

#include <ImfIO.h>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace restage::io {

class ExrMemoryInput : public Imf::IStream {
  public:
    explicit ExrMemoryInput(std::string_view bytes) : IStream("EXR"), bytes_(bytes) {}
    bool read(char c[], int n) override {
        const auto count = static_cast<std::uint64_t>(n < 0 ? 0 : n);
        if (at_ > bytes_.size() || bytes_.size() - at_ < count)
            throw std::runtime_error("truncated: the file ends inside the picture (" + std::to_string(bytes_.size()) +
                                     " bytes)");
        std::memcpy(c, bytes_.data() + at_, count);
        at_ += count;
        return at_ < bytes_.size();
    }
    std::uint64_t tellg() override { return at_; }
    void seekg(std::uint64_t at) override { at_ = at; }

  private:
    std::string_view bytes_;
    std::uint64_t at_ = 0;
};

class ExrMemoryOutput : public Imf::OStream {
  public:
    ExrMemoryOutput() : OStream("EXR") {}
    void write(const char c[], int n) override {
        const auto count = static_cast<std::uint64_t>(n < 0 ? 0 : n);
        if (bytes_.size() < at_ + count) bytes_.resize(at_ + count);
        std::memcpy(bytes_.data() + at_, c, count);
        at_ += count;
    }
    std::uint64_t tellp() override { return at_; }
    void seekp(std::uint64_t at) override { at_ = at; }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
    std::uint64_t at_ = 0;
};

} // namespace restage::io
