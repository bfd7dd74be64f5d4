// SPDX-License-Identifier: Apache-2.0
// What an import could not read and stays in the scene as a placeholder: images without pixels, and meshes whose
// primitive is "missing LINE": one triangle without area, which nothing hits, and the line of the file it stands for,
// `Shape "plymesh" ...` or `Include "more.pbrt"`. They are listed, found again, and written back where they were.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <string>
#include <vector>

namespace restage::scene {

bool is_missing(const Mesh&);
std::string missing_line(const Mesh&); // the line; "" = it is not missing

struct Missing {
    std::string kind; // "image", "mesh"
    std::string name, file; // file: where it was looked for; or, of what is no file, the line itself
    bool operator==(const Missing&) const = default;
};
std::vector<Missing> missing_things(const Scene&);

// A missing mesh is this file's: `data` was read from it. Not for lines such as Include, which are no meshes.
Result<Edit> find_mesh(const Scene&, Id<Mesh>, std::string file, std::shared_ptr<const MeshData> data);

} // namespace restage::scene
