// SPDX-License-Identifier: Apache-2.0
// XXH64 after the algorithm description of the xxHash project (doc/xxhash_spec.md, revision 0.1.1), one-shot form.
#include "base/file.hpp"

#include <bit>
#include <cstring>

namespace restage {

namespace {

constexpr std::uint64_t prime1 = 0x9E3779B185EBCA87ull;
constexpr std::uint64_t prime2 = 0xC2B2AE3D27D4EB4Full;
constexpr std::uint64_t prime3 = 0x165667B19E3779F9ull;
constexpr std::uint64_t prime4 = 0x85EBCA77C2B2AE63ull;
constexpr std::uint64_t prime5 = 0x27D4EB2F165667C5ull;

static_assert(std::endian::native == std::endian::little, "hash64 reads little-endian words in place");

template <class T>
std::uint64_t load(const unsigned char* p) {
    T x;
    std::memcpy(&x, p, sizeof x);
    return x;
}

std::uint64_t round(std::uint64_t lane, std::uint64_t input) { return std::rotl(lane + input * prime2, 31) * prime1; }

std::uint64_t merge(std::uint64_t hash, std::uint64_t lane) { return (hash ^ round(0, lane)) * prime1 + prime4; }

} // namespace

std::uint64_t hash64(const void* data, std::size_t size, std::uint64_t seed) {
    auto p = static_cast<const unsigned char*>(data);
    const unsigned char* const end = p + size;
    std::uint64_t hash = seed + prime5;
    if (size >= 32) {
        std::uint64_t lane[4] = {seed + prime1 + prime2, seed + prime2, seed, seed - prime1};
        for (; end - p >= 32; p += 32)
            for (int i = 0; i < 4; ++i)
                lane[i] = round(lane[i], load<std::uint64_t>(p + 8 * i));
        hash = std::rotl(lane[0], 1) + std::rotl(lane[1], 7) + std::rotl(lane[2], 12) + std::rotl(lane[3], 18);
        for (const std::uint64_t l : lane)
            hash = merge(hash, l);
    }
    hash += size;
    for (; end - p >= 8; p += 8)
        hash = std::rotl(hash ^ round(0, load<std::uint64_t>(p)), 27) * prime1 + prime4;
    if (end - p >= 4) {
        hash = std::rotl(hash ^ (load<std::uint32_t>(p) * prime1), 23) * prime2 + prime3;
        p += 4;
    }
    for (; p != end; ++p)
        hash = std::rotl(hash ^ (*p * prime5), 11) * prime1;
    hash = (hash ^ (hash >> 33)) * prime2;
    hash = (hash ^ (hash >> 29)) * prime3;
    return hash ^ (hash >> 32);
}

std::uint64_t hash64(std::string_view bytes, std::uint64_t seed) { return hash64(bytes.data(), bytes.size(), seed); }

} // namespace restage
