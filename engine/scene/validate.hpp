// SPDX-License-Identifier: Apache-2.0
// validate: what is wrong with a scene, as sentences. `error` = it must not be rendered or saved as it is (a dangling
// id, an index out of range, NaN); `warning` = odd, but it has a meaning (a transform that flattens, a black light).
#pragma once

#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace restage::scene {

struct Problem {
    enum class Severity { warning, error } severity;
    std::string sentence; // 'instance "chair": material 7 does not exist'
    bool operator==(const Problem&) const = default;
};

// The sentence of a scene that cannot be rendered yet, and nothing else.
inline constexpr const char* no_camera = "there is no camera to look through";

// In the order of the tables. Of one kind of problem in many places the first few are listed and the rest counted.
std::vector<Problem> validate(const Scene&);
// Of one mesh: 'vertex 17 is not a finite number', or "" when all is well. Importers' data goes through here.
std::string check_mesh(const MeshData&);
bool is_finite(const glm::dmat4&);

} // namespace restage::scene
