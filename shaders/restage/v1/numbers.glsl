// SPDX-License-Identifier: Apache-2.0
// Classifies a float by its bits (IEEE 754). If a device does not guarantee to preserve NaN and infinity, its compiler
// may assume that every value is a number: isnan() is then false, and !(x > 0.0) the same as x <= 0.0.
#ifndef RESTAGE_V1_NUMBERS
#define RESTAGE_V1_NUMBERS

const uint EXPONENT_BITS = 0x7f800000u;

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > EXPONENT_BITS; }
bool finite(float x) { return (floatBitsToUint(x) & EXPONENT_BITS) != EXPONENT_BITS; }
// A sum is finite if all its terms are and it does not overflow, which nothing here comes close to: one test instead of
// three.
bool finite(vec3 c) { return finite(c.x + c.y + c.z); }
bool positive(float x) { return floatBitsToUint(x) - 1u < EXPONENT_BITS; } // true for infinity; false for NaN, 0 and -0

#endif
