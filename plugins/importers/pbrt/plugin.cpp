// SPDX-License-Identifier: Apache-2.0
// Entry point of the importer of pbrt scenes.
#include "load.hpp"

#include <restage/scene_io.h>

static const RestageImporter1 importer = {
    .size = sizeof(RestageImporter1),
    .format = "pbrt",
    .label = "pbrt scene (v3, v4)",
    .extensions = "pbrt|pbrt.gz",
    .probe = restage::pbrt::probe,
    .load = restage::pbrt::load,
};

RESTAGE_PLUGIN("org.restage.importer.pbrt", "0.1.0", {RESTAGE_IMPORTER1, &importer})
