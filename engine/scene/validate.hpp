// SPDX-License-Identifier: Apache-2.0
// validate: problems of a scene, as sentences. `error` = must not be rendered or saved as is (a dangling
// id, an index out of range, NaN); `warning` = odd but well-defined (a singular transform, a negative light).
// One set of rules for importers, editor and scripts: a file with an error is refused, and so is an edit that adds
// a new error or warning.
#pragma once

#include "base/result.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace restage::scene {

struct Problem {
    enum class Severity { warning, error } severity;
    std::string sentence; // 'instance "chair": material 7 does not exist'
    bool operator==(const Problem&) const = default;
};

// Issued only for a scene that cannot be rendered yet.
inline constexpr const char* no_camera = "there is no camera to look through";

// In table order. Of many problems of one kind the first few are listed and the rest counted.
std::vector<Problem> validate(const Scene&);

struct ValueProblem : Problem {
    const char* kind; // groups similar problems
};
// Problems of an item's own values, not of its references.
std::vector<ValueProblem> value_problems(const Mesh&);
std::vector<ValueProblem> value_problems(const Image&);
std::vector<ValueProblem> value_problems(const Texture&);
std::vector<ValueProblem> value_problems(const Material&);
std::vector<ValueProblem> value_problems(const Medium&);
std::vector<ValueProblem> value_problems(const Group&);
std::vector<ValueProblem> value_problems(const Instance&);
std::vector<ValueProblem> value_problems(const Light&);
std::vector<ValueProblem> value_problems(const Camera&);
std::vector<ValueProblem> value_problems(const Environment&);
std::vector<ValueProblem> value_problems(const Film&);
std::vector<ValueProblem> value_problems(const Settings&);

struct Edit;
// Refuses an edit that makes an item invalid: the first problem of this severity or worse of a kind it did not have
// before, so that items already invalid in the file can still be moved and renamed. Unread pixels are accepted.
Result<> check_edit(const Edit&, Problem::Severity least = Problem::Severity::warning);

// Of one mesh: 'vertex 17 is not a finite number', or "" if valid. Importers' data is checked here.
std::string check_mesh(const MeshData&);
bool is_finite(const glm::dmat4&);

} // namespace restage::scene
