// SPDX-License-Identifier: Apache-2.0
// Entry point of the importer of PLY and STL files.
#include "load.hpp"

#include "common/options.hpp"

#include <restage/scene_io.h>

static const RestageParam options[] = {restage::importing::units_option, restage::importing::up_option};

static const RestageImporter1 importer = {
    .size = sizeof(RestageImporter1),
    .format = "mesh",
    .label = "PLY or STL mesh",
    .extensions = "ply|ply.gz|stl",
    .probe = restage::mesh::probe,
    .load = restage::mesh::load,
    .options = options,
    .option_count = RESTAGE_COUNT(options),
};

RESTAGE_PLUGIN("org.restage.importer.mesh", "0.1.0", {RESTAGE_IMPORTER1, &importer})
