// SPDX-License-Identifier: Apache-2.0
// Entry point of the importer of glTF.
#include "common/picture.hpp"
#include "load.hpp"

#include "common/options.hpp"

#include <restage/scene_io.h>

static const RestageParam options[] = {
    restage::importing::units_option,
    restage::importing::up_option,
    RESTAGE_TEXT_PARAM("scene", "Scene", 0,
                       "The scene to read, by its name or its number from 1. Empty: the file's default"),
    RESTAGE_TEXT_PARAM(
        "variant", "Variant", 0,
        "The variant of the materials, by its name or its number from 1. Empty: the file's own materials"),
};

static const RestageImporter1 importer = {
    .size = sizeof(RestageImporter1),
    .format = "gltf",
    .label = "glTF 2.0 scene (glTF, GLB)",
    .extensions = "gltf|glb",
    .probe = restage::gltf::probe,
    .load = restage::gltf::load,
    .options = options,
    .option_count = RESTAGE_COUNT(options),
};

RESTAGE_PLUGIN_INIT("org.restage.importer.gltf", "0.1.0", restage::importing::use_host_pictures, NULL,
                    {RESTAGE_IMPORTER1, &importer})
