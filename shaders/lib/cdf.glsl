// SPDX-License-Identifier: Apache-2.0
// Drawing from a distribution's table; render/cdf_table.hpp.
#ifndef RESTAGE_LIB_CDF
#define RESTAGE_LIB_CDF
#include "lib/scene.glsl"

uint scaled_index(uint bits, uint count) { // 32 random bits to [0, count)
    uint high, low;
    umulExtended(bits, count, high, low);
    return high;
}

struct CdfDraw {
    uint index;
    uint start, end; // the numbers that draw it: [start, end)
};

float cdf_left(CdfDraw d, uint bits) { // the place of `bits` between start and end, [0, 1)
    return min(float(min(bits, CDF_TOTAL - 1u) - d.start) / float(d.end - d.start), 0.99999994);
}
uint cdf_end(address table, uint count, uint i) { return i + 1u < count ? CdfArray(table).at[i + 1u].start : CDF_TOTAL; }

// By 32 random bits among `count` entries. All 32, because a float's 24 never reach some texels of an 8192 x 4096 sky.
CdfDraw cdf_draw(address table, uint count, uint bits) {
    bits = min(bits, CDF_TOTAL - 1u);
    CdfDraw d;
    d.index = CdfArray(table).at[scaled_index(bits, count)].guide;
    d.start = CdfArray(table).at[d.index].start;
    d.end = cdf_end(table, count, d.index);
    while (d.end <= bits) {
        ++d.index;
        d.start = d.end;
        d.end = cdf_end(table, count, d.index);
    }
    return d;
}

#endif
