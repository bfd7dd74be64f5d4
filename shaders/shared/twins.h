// SPDX-License-Identifier: Apache-2.0
// Twins: some of a film's pixels are rendered a second time, with other random numbers, in rows below the film's own.
// The difference between twins is the error that a pixel has, while the spread of its samples, which are stratified,
// claims more.
#ifndef RESTAGE_SHARED_TWINS_H
#define RESTAGE_SHARED_TWINS_H
#include "shared/hash.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(TWIN_ROWS, 32u); // of the film, for a row of twins: one pixel of 32 in each column
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

// The row of the pixel that is rendered again in this column and row of twins.
RESTAGE_INLINE uint twin_of(uint x, uint row, uint height) {
    uint first = row * TWIN_ROWS;
    return first + pcg_hash(x ^ pcg_hash(row)) % min(TWIN_ROWS, height - first);
}

RESTAGE_SHARED_END
#endif
