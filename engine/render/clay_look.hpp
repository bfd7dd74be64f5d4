// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace restage::render {

// What a picture of first hits shows; see clay.hpp.
enum class ClayLook : std::uint8_t {
    clay,  // the shape
    wires, // the edges of triangles, without those behind surfaces, and outlines of objects
    uv,    // texture coordinates: chequers of 1/8, redder with u and greener with v; blue where a mesh has none
};

} // namespace restage::render
