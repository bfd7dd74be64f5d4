// SPDX-License-Identifier: Apache-2.0
// A glTF file as read by tinygltf, and typed reading of its accessors, every index and length checked: tinygltf checks
// neither. Faults are thrown as an ImportError that names the thing by its glTF index ("accessor 3").
#pragma once

#include "common/error.hpp"
#include "common/matrix.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#include <tiny_gltf.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace restage::gltf {

using namespace importing;

// Parses .gltf or .glb (distinguished by their first bytes) and reads its buffers. External pictures are not read.
tinygltf::Model parse_model(const std::filesystem::path&, std::string_view bytes, const RestageSceneWriter1&);

// "accessor 3" etc. of a vector, or an ImportError in which `who` refers to a missing one.
template <class T>
const T& at(const std::vector<T>& things, int index, const char* kind, const std::string& who) {
    if (index >= 0 && static_cast<std::size_t>(index) < things.size()) return things[static_cast<std::size_t>(index)];
    throw ImportError{
        who + " names " + kind + " " + std::to_string(index) + "; the file has " + std::to_string(things.size()),
        0,
        0,
        {}};
}

// The bytes of a buffer view.
std::span<const unsigned char> view_bytes(const tinygltf::Model&, int view, const std::string& who);

// All elements of an accessor, `components` numbers each, as floats (integers normalised if the accessor is
// normalized).
std::vector<float> read_floats(const tinygltf::Model&, int accessor, int components, const std::string& who);
// VEC3 or VEC4 alike, as colours: four numbers each, alpha 1 if there is none.
std::vector<float> read_colors(const tinygltf::Model&, int accessor, const std::string& who);
std::vector<std::uint32_t> read_integers(const tinygltf::Model&, int accessor, int components, const std::string& who);

std::string decode_uri(std::string_view); // %20 -> blank
// The file a URI in a file of `folder` means: percent-decoded, or, if no such file exists, as written.
std::filesystem::path find_named(const std::filesystem::path& folder, const std::string& uri);

} // namespace restage::gltf
