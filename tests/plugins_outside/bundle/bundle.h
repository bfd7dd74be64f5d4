/* SPDX-License-Identifier: Apache-2.0 */
/* A bundle of one plugin of each kind, in C11, for tests/ui/test_bundle.py. */
#ifndef BUNDLE_H
#define BUNDLE_H

#include <restage/action.h>
#include <restage/denoiser.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/sky.h>
#include <restage/texture.h>

extern const RestageMaterial1 chalk; /* looks.c */
extern const RestageTexture1 stripes;
extern const RestageSky1 dusk;
extern const RestageImporter1 towers_in; /* files.c */
extern const RestageExporter1 towers_out;
extern const RestageDenoiser1 blur;

#endif
