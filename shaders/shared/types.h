// SPDX-License-Identifier: Apache-2.0
// Makes one struct text valid in C++ and GLSL. Layout is `scalar` (VK_EXT_scalar_block_layout) on both sides;
// structs holding an address are padded to 8 bytes by hand. Sizes are asserted in C++ (render/gpu_scene.cpp).
#ifndef RESTAGE_SHARED_TYPES_H
#define RESTAGE_SHARED_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
// Constants precede the structs and are in namespace restage itself.
#define RESTAGE_CONSTANTS_BEGIN namespace restage {
#define RESTAGE_CONSTANTS_END }
#define RESTAGE_SHARED_BEGIN namespace restage::shared {
#define RESTAGE_SHARED_END }
#define RESTAGE_UINT(name, value) inline constexpr std::uint32_t name = value
namespace restage::shared {
using uint = std::uint32_t;
using address = std::uint64_t;
using glm::mat3;
using glm::mat4x3; // 4 columns of 3 rows, as GLSL
using glm::vec2;
using glm::vec3;
using glm::vec4;
} // namespace restage::shared
#else
#define RESTAGE_CONSTANTS_BEGIN
#define RESTAGE_CONSTANTS_END
#define RESTAGE_SHARED_BEGIN
#define RESTAGE_SHARED_END
#define RESTAGE_UINT(name, value) const uint name = value
#endif

#endif
