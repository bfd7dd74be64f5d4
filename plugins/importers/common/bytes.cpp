// SPDX-License-Identifier: Apache-2.0
#include "common/bytes.hpp"

#include "common/file.hpp"

#include <zlib.h>
#include <cerrno>
#include <cstring>

#if !defined(_WIN32)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace restage::importing {

namespace {

// Limits gzip bombs.
constexpr std::size_t max_inflated_size = std::size_t(2) << 30;

std::optional<std::vector<char>> inflate(std::string_view packed, std::string& reason) {
    std::vector<char> out;
    z_stream stream{};
    if (inflateInit2(&stream, 15 + 16) != Z_OK) {
        reason = "zlib could not be started";
        return std::nullopt;
    }
    std::size_t read = 0;
    int state = Z_OK;
    std::vector<char> block(std::size_t(1) << 18);
    while (true) {
        if (stream.avail_in == 0 && read < packed.size()) {
            const std::size_t n = std::min<std::size_t>(packed.size() - read, std::size_t(1) << 30);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + read));
            stream.avail_in = static_cast<uInt>(n);
            read += n;
        }
        stream.next_out = reinterpret_cast<Bytef*>(block.data());
        stream.avail_out = static_cast<uInt>(block.size());
        state = ::inflate(&stream, Z_NO_FLUSH);
        const std::size_t got = block.size() - stream.avail_out;
        out.insert(out.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got));
        if (out.size() > max_inflated_size) {
            reason = "it inflates to more than 2 GiB";
            break;
        }
        if (state == Z_STREAM_END) {
            if (stream.avail_in == 0 && read == packed.size()) break;
            if (inflateReset(&stream) != Z_OK) break; // several members, one after the other
            state = Z_OK;
            continue;
        }
        if (state != Z_OK || (got == 0 && stream.avail_in == 0 && read == packed.size())) {
            reason = state == Z_OK || state == Z_BUF_ERROR ? "the gzip data ends early" : "the gzip data is damaged";
            break;
        }
    }
    inflateEnd(&stream);
    if (!reason.empty()) return std::nullopt;
    return out;
}

} // namespace

FileBytes::FileBytes(FileBytes&& other) noexcept
    : data_(other.data_), size_(other.size_), mapped_(other.mapped_), owned_(std::move(other.owned_)) {
    other.mapped_ = false;
    other.data_ = nullptr;
    other.size_ = 0;
}

FileBytes::~FileBytes() {
#if !defined(_WIN32)
    if (mapped_) munmap(const_cast<char*>(data_), size_);
#endif
}

FileBytes FileBytes::from_memory(std::string text) {
    FileBytes bytes;
    bytes.owned_ = std::make_unique<std::vector<char>>(text.begin(), text.end());
    bytes.data_ = bytes.owned_->data();
    bytes.size_ = bytes.owned_->size();
    return bytes;
}

std::optional<FileBytes> FileBytes::open(const std::filesystem::path& path, std::string& reason) {
    reason.clear();
    FileBytes bytes;
    std::uint64_t size = 0;
#if !defined(_WIN32)
    const int fd = open_regular_file(path, size, reason);
    if (fd < 0) return std::nullopt;
    bytes.size_ = static_cast<std::size_t>(size);
    if (bytes.size_ > 0) {
        void* at = mmap(nullptr, bytes.size_, PROT_READ, MAP_PRIVATE, fd, 0);
        if (at == MAP_FAILED) {
            reason = std::strerror(errno);
            ::close(fd);
            bytes.size_ = 0;
            return std::nullopt;
        }
        bytes.data_ = static_cast<const char*>(at);
        bytes.mapped_ = true;
    }
    ::close(fd);
#else
    auto whole = read_file(path, reason);
    if (!whole) return std::nullopt;
    bytes = from_memory(std::move(*whole));
#endif
    const std::string_view view = bytes.view();
    if (view.size() >= 2 && view[0] == '\x1f' && view[1] == '\x8b') {
        auto plain = inflate(view, reason);
        if (!plain) return std::nullopt;
        FileBytes inflated;
        inflated.owned_ = std::make_unique<std::vector<char>>(std::move(*plain));
        inflated.data_ = inflated.owned_->data();
        inflated.size_ = inflated.owned_->size();
        return inflated;
    }
    return bytes;
}

} // namespace restage::importing
