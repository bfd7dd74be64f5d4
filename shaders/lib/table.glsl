// SPDX-License-Identifier: Apache-2.0
// Tables: words that a plugin made of a file (restage/table.h), seen by the GLSL of materials as parameters of type
// Table. There is nothing past their end but 0.
#ifndef RESTAGE_LIB_TABLE
#define RESTAGE_LIB_TABLE

#include "lib/scene.glsl"

struct Table {
    uint64_t words;
    uint size; // how many
};

uint table_size(Table t) { return t.size; }
uint table_word(Table t, uint i) { return i < t.size ? UintArray(t.words).at[i] : 0u; }
float table_float(Table t, uint i) { return uintBitsToFloat(table_word(t, i)); }

#endif
