// SPDX-License-Identifier: Apache-2.0
// The importer without its entry point.
#pragma once

#include <restage/scene_io.h>
#include <cstddef>

namespace restage::mesh {

int probe(const char* path, const void* head, std::size_t head_size);
int load(const char* path, const RestageSceneWriter1* out); // 1 = done, 0 = stopped or broken; throws nothing

} // namespace restage::mesh
