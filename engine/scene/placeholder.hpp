// SPDX-License-Identifier: Apache-2.0
// Placeholders for what an import could not read: images without pixels, and meshes whose
// primitive is "missing LINE": one degenerate triangle, which no ray hits, and the file's line that it represents,
// `Shape "plymesh" ...` or `Include "more.pbrt"`. They are listed, relocated, and written back in place.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace restage::scene {

bool is_missing(const Mesh&);
std::string missing_line(const Mesh&); // the line; "" if not missing

struct Missing {
    std::string kind; // "image", "mesh"
    std::string name, file; // file: where it was searched; or, if not a file, the line itself
    bool operator==(const Missing&) const = default;
};
std::vector<Missing> missing_things(const Scene&);

// Resolves a missing mesh with this file, from which `data` was read. Not for lines such as Include.
Result<Edit> find_mesh(const Scene&, Id<Mesh>, std::string file, std::shared_ptr<const MeshData> data);

} // namespace restage::scene
