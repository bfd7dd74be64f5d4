// SPDX-License-Identifier: Apache-2.0
// Structs that grow at their end (restage/plugin.h): how the host reads structs of plugins built with another SDK,
// and fills structs for them. For the adapters in plugin/ and io/.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace restage::plugin {

// Bytes of a struct up to and including a member: the part common to every revision.
#define RESTAGE_SIZE_UP_TO(type, member) (offsetof(type, member) + sizeof(type::member))

// "" or why a table is too short to read.
inline std::string too_short(std::uint32_t size, std::size_t needed, const char* interface_id) {
    if (size >= needed) return "";
    return std::string("its table ") + interface_id + " has " + std::to_string(size) + " bytes, " +
           std::to_string(needed) + " are needed: rebuild it with this SDK";
}

// Members missing from a shorter struct keep their defaults; the excess of a longer one is ignored.
template <class T>
T sized(const T& given) {
    static_assert(std::is_trivially_copyable_v<T>);
    T out{};
    std::memcpy(static_cast<void*>(&out), &given, std::min<std::size_t>(given.size, sizeof out));
    out.size = sizeof out;
    return out;
}

// Element i of an array built with another SDK.
template <class T>
T element(const T* array, std::size_t i) {
    return sized(*reinterpret_cast<const T*>(reinterpret_cast<const char*>(array) + i * array->size));
}

// Fills the members that the caller knows: at most out->size bytes, keeping `size`. Nothing if the caller left it 0.
template <class T>
void give(T* out, T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    value.size = out->size;
    std::memcpy(static_cast<void*>(out), &value, std::min<std::size_t>(out->size, sizeof value));
}

} // namespace restage::plugin
