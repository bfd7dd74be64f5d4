// SPDX-License-Identifier: Apache-2.0
// Entry point of the importer of OBJ files.
#include "load.hpp"

#include <restage/scene_io.h>

static const RestageImporter1 importer = {
    .size = sizeof(RestageImporter1),
    .format = "obj",
    .label = "Wavefront OBJ model",
    .extensions = "obj",
    .probe = restage::obj::probe,
    .load = restage::obj::load,
};

RESTAGE_PLUGIN("org.restage.importer.obj", "0.1.0", {RESTAGE_IMPORTER1, &importer})
