// SPDX-License-Identifier: Apache-2.0
// Tables: words that a plugin has made from a file (restage/table.h); in the GLSL of materials they are parameters of type
// Table. Words past the end are 0. The members of Table are private to the host.
#ifndef RESTAGE_V1_TABLE
#define RESTAGE_V1_TABLE

struct Table {
    uint64_t words;
    uint size; // number of words
};

uint table_word(Table t, uint i); // lib/table.glsl, after the plugin's code
uint table_size(Table t) { return t.size; }
float table_float(Table t, uint i) { return uintBitsToFloat(table_word(t, i)); }

#endif
