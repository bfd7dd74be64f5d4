// SPDX-License-Identifier: Apache-2.0
// Makes one function text valid in C++ and GLSL: the GLSL names that shared functions use, mapped to GLM. Such
// headers are tested in both languages with the same inputs (tests/render/shared_test.cpp).
#ifndef RESTAGE_SHARED_FUNCTIONS_H
#define RESTAGE_SHARED_FUNCTIONS_H
#include "shared/types.h"

#ifdef __cplusplus
#include <bit>
#define RESTAGE_INLINE inline
#define RESTAGE_REAL double // where precision is free on the CPU
#define RESTAGE_REAL2 glm::dvec2
#define RESTAGE_REAL3 glm::dvec3
namespace restage::shared {
inline uint floatBitsToUint(float x) { return std::bit_cast<uint>(x); }
inline float uintBitsToFloat(uint x) { return std::bit_cast<float>(x); }
using glm::abs, glm::atan, glm::clamp, glm::cos, glm::dot, glm::log, glm::max, glm::min, glm::sin, glm::sqrt;
} // namespace restage::shared
#else
#define RESTAGE_INLINE
#define RESTAGE_REAL float
#define RESTAGE_REAL2 vec2
#define RESTAGE_REAL3 vec3
#endif

#endif
