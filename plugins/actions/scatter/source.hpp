// SPDX-License-Identifier: Apache-2.0
// What is scattered: an object, or all objects of a group as one unit.
#pragma once

#include "vec.hpp"

#include <restage/scene_io.h>
#include <string>
#include <vector>

namespace scatter {

struct Source {
    std::string name;
    RestageHandle group = 0; // that contains all of it; 0: a single object
    std::vector<RestageInstance> objects;
    Vec foot; // in world space: the centre of its bounds, at its lowest point along up
};

// Of the selected objects: a group whose objects are all among them is one source. Empty if none has geometry.
std::vector<Source> sources_of(const RestageSceneReader1& scene, const std::vector<RestageHandle>& selected, Vec up);

} // namespace scatter
