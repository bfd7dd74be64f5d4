// SPDX-License-Identifier: Apache-2.0
// Spectral mode, shared by shaders and C++: which wavelengths a path carries, and how records store spectra.
//
// A colour of a record is a vec3. In RGB mode it is the colour; in spectral mode its bits are three words, `stored`:
//   two   coefficients of a smooth spectrum, 21 bits each: the sign, exponent and 12 digits of a float
//         (Jakob and Hanika 2019, "A Low-Dimensional Function Space for Efficient Spectral Upsampling"),
//         or CURVE_BIT in the second word and in the first the index of a measured spectrum;
//   one   a float, by which the spectrum is multiplied.
// Light is carried relative to the standard illuminant D65, with which the film's weights are multiplied once; so an
// RGB light is a spectrum like an absorption coefficient.
#ifndef RESTAGE_SHARED_SPECTRAL_H
#define RESTAGE_SHARED_SPECTRAL_H
#include "shared/functions.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(SPECTRAL_FIRST, 360u); // [nm]
RESTAGE_UINT(SPECTRAL_LAST, 830u);
RESTAGE_UINT(SPECTRAL_CURVE, 471u);   // entries of a measured spectrum, 1 nm apart: its value, and the next one's
RESTAGE_UINT(SPECTRAL_CELLS, 64u);    // nodes along each axis of the coefficients' table
RESTAGE_UINT(SPECTRAL_BINS, 1024u);   // of the film's weights, over the numbers that choose a wavelength
RESTAGE_UINT(CURVE_BIT, 0x80000000u);
RESTAGE_UINT(CURVE_NUMBER, 0x7fc00000u); // a parameter with these bits (not a number), plus the index of a curve
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

// The wavelength [nm] that a number in [0, 1) chooses, with density 0.0039398042 / cosh^2(0.0072 (nm - 538)).
// Radziszewski et al. 2009, "An Improved Technique for Full Spectral Rendering"; constants of pbrt 4ed, 4.5.4.
RESTAGE_INLINE float visible_wavelength(float u) {
    float x = 0.85691062f - 1.82750197f * u;
    return 538.0f - 69.4444445f * log((1.0f + x) / (1.0f - x));
}

// Coefficients from two words.
RESTAGE_INLINE vec3 unpack_coefficients(uint low, uint high) {
    return vec3(uintBitsToFloat(low << 11), uintBitsToFloat(((low >> 21) << 11) | (high << 22)),
                uintBitsToFloat((high << 1) & 0xfffff800u));
}

RESTAGE_SHARED_END
#endif
