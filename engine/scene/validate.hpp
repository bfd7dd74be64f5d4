// SPDX-License-Identifier: Apache-2.0
// validate: what is wrong with a scene, as sentences. `error` = it must not be rendered or saved as it is (a dangling
// id, an index out of range, NaN); `warning` = odd, but it has a meaning (a transform that flattens, a negative light).
// One set of rules for importers, editor and scripts: a file with an error is refused, and so is an edit that brings in
// an error or a warning that was not there.
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

// The sentence of a scene that cannot be rendered yet, and nothing else.
inline constexpr const char* no_camera = "there is no camera to look through";

// In the order of the tables. Of one kind of problem in many places the first few are listed and the rest counted.
std::vector<Problem> validate(const Scene&);

struct ValueProblem : Problem {
    const char* kind; // alike problems have the same
};
// Of what a thing holds itself, not of what it refers to.
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
// Refuses an edit that makes a thing bad: the first problem of this severity or worse that its kind did not have
// before, so that what a file brought along can still be moved and renamed. Pixels that were not read are let through.
Result<> check_edit(const Edit&, Problem::Severity least = Problem::Severity::warning);

// Of one mesh: 'vertex 17 is not a finite number', or "" when all is well. Importers' data goes through here.
std::string check_mesh(const MeshData&);
bool is_finite(const glm::dmat4&);

} // namespace restage::scene
