// SPDX-License-Identifier: Apache-2.0
// Access to the words of a Table.
#ifndef RESTAGE_LIB_TABLE
#define RESTAGE_LIB_TABLE
#include "lib/scene.glsl"
#include <restage/v1/table.glsl>

uint table_word(Table t, uint i) { return i < t.size ? UintArray(t.words).at[i] : 0u; }

#endif
