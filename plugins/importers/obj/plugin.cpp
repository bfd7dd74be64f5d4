// SPDX-License-Identifier: Apache-2.0
// Entry point of the importer of OBJ files.
#include "common/picture.hpp"
#include "load.hpp"

#include "common/options.hpp"

#include <restage/scene_io.h>

static const RestageParam options[] = {
    restage::importing::units_option,
    restage::importing::up_option,
    RESTAGE_BOOL_PARAM("merge", "Merge", 0, 0,
                       "All faces of a material become one object, regardless of the file's objects"),
};

static const RestageImporter1 importer = {
    .size = sizeof(RestageImporter1),
    .format = "obj",
    .label = "Wavefront OBJ model",
    .extensions = "obj",
    .probe = restage::obj::probe,
    .load = restage::obj::load,
    .options = options,
    .option_count = RESTAGE_COUNT(options),
};

RESTAGE_PLUGIN_INIT("org.restage.importer.obj", "0.1.0", restage::importing::use_host_pictures, NULL,
                    {RESTAGE_IMPORTER1, &importer})
