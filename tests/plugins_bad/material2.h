/* SPDX-License-Identifier: Apache-2.0 */
/* A possible second revision of the material interface, for tests, with little in common with the first. */
#pragma once

#include <restage/plugin.h>

#define TEST_MATERIAL2 "restage.material/2"

typedef struct TestMaterial2 {
    RESTAGE_SIZE(TestMaterial2);
    const char* code; /* the GLSL file; without its extension it is type and prefix */
    const char* title;
    const char* colors; /* "tint=0.8 0.4 0.2", several with '|' between */
} TestMaterial2;
