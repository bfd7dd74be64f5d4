// SPDX-License-Identifier: Apache-2.0
// Between Python and the engine: errors become exceptions, sequences and numpy arrays become glm, and back.
#pragma once

#include "base/result.hpp"
#include "scene/techniques.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <glm/glm.hpp>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

namespace nb = nanobind;
using namespace nb::literals;

namespace restage::python {

// restage.Error in Python.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// restage.Cancelled, a restage.Error: requested by a callback.
struct Stopped : Failure {
    using Failure::Failure;
};

template <class T>
T take(Result<T> result) {
    if (!result && result.error().cancelled()) throw Stopped(result.error().message);
    if (!result) throw Failure(result.error().message);
    if constexpr (!std::is_void_v<T>) return std::move(*result);
}

// auto, on or off, for `option`; else throws Failure.
scene::Technique technique(const char* option, const std::string& name);

using Three = std::array<double, 3>;               // in: any sequence of three numbers
using Triple = std::tuple<double, double, double>; // out

inline glm::dvec3 vec(const Three& v) { return {v[0], v[1], v[2]}; }
inline Triple triple(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
// The double that prints as the float does: 0.3, not 0.30000001192092896.
double exact(float);
inline Triple triple(const glm::vec3& v) { return {exact(v.x), exact(v.y), exact(v.z)}; }

using Matrix = nb::ndarray<nb::numpy, double, nb::shape<4, 4>, nb::c_contig>;
using Box = nb::ndarray<nb::numpy, double, nb::shape<2, 3>, nb::c_contig>;
Matrix to_numpy(const glm::dmat4&);
Box to_numpy(const glm::dvec3& lower, const glm::dvec3& upper);
// Anything that numpy can convert to a 4x4 array, for column vectors: m @ (x, y, z, 1). The last row must be 0 0 0 1.
glm::dmat4 to_matrix(nb::handle);

} // namespace restage::python

// Also accepts numpy arrays as three numbers, and declares this to type checkers.
namespace nanobind::detail {
template <>
struct type_caster<restage::python::Three> : array_caster<restage::python::Three, double, 3> {
    static constexpr auto Name = io_name("numpy.typing.ArrayLike", "list[float]");
};
} // namespace nanobind::detail
