// SPDX-License-Identifier: Apache-2.0
#include "convert.hpp"

#include <charconv>
#include <memory>

namespace restage::python {

scene::Technique technique(const char* option, const std::string& name) {
    if (const auto found = scene::find_technique(name)) return *found;
    throw Failure(std::string(option) + ": '" + name + "' is none of auto, on and off");
}

double exact(float x) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), x);
    double value = x;
    std::from_chars(text.data(), end.ptr, value);
    return value;
}

namespace {

template <class Array>
Array owned(std::unique_ptr<double[]> data) {
    double* at = data.release();
    nb::capsule owner(at, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    if constexpr (std::is_same_v<Array, Matrix>)
        return Array(at, {4, 4}, owner);
    else
        return Array(at, {2, 3}, owner);
}

} // namespace

Matrix to_numpy(const glm::dmat4& m) {
    auto data = std::make_unique<double[]>(16);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            data[std::size_t(row * 4 + column)] = m[column][row];
    return owned<Matrix>(std::move(data));
}

Box to_numpy(const glm::dvec3& lower, const glm::dvec3& upper) {
    auto data = std::make_unique<double[]>(6);
    for (int k = 0; k < 3; ++k) {
        data[std::size_t(k)] = lower[k];
        data[std::size_t(3 + k)] = upper[k];
    }
    return owned<Box>(std::move(data));
}

glm::dmat4 to_matrix(nb::handle h) {
    const nb::object array = nb::module_::import_("numpy").attr("ascontiguousarray")(h, "dtype"_a = "float64");
    nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu> view;
    if (!nb::try_cast(array, view)) throw Failure("a transform is a 4x4 matrix");
    glm::dmat4 m;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            m[column][row] = view(row, column);
    return m;
}

} // namespace restage::python
