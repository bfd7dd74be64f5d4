// SPDX-License-Identifier: Apache-2.0
// Entry point of the importer of PLY and STL files: interface "restage.importer/1".
#include "load.hpp"

#include <cstring>

namespace {

const RestageImporter1 importer = {
    .size = sizeof(RestageImporter1),
    .format = "mesh",
    .label = "PLY or STL mesh",
    .extensions = "ply|ply.gz|stl",
    .probe = restage::mesh::probe,
    .load = restage::mesh::load,
};

const void* query(const char* id, uint32_t index) {
    return std::strcmp(id, RESTAGE_IMPORTER1) == 0 && index == 0 ? &importer : nullptr;
}

} // namespace

extern "C" {
RESTAGE_EXPORT extern const RestagePlugin restage_plugin;
const RestagePlugin restage_plugin = {
    .abi = RESTAGE_ABI,
    .size = sizeof(RestagePlugin),
    .id = "org.restage.importer.mesh",
    .version = "0.1.0",
    .init = nullptr,
    .shutdown = nullptr,
    .query = query,
};
}
