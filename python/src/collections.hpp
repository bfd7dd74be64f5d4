// SPDX-License-Identifier: Apache-2.0
// Collection<T>: one table of a scene, for Python.
#pragma once

#include "workspace.hpp"

namespace restage::python {

template <class T>
struct Collection {
    std::shared_ptr<Workspace> in;
};

// The most similar of these, or "".
std::string nearest_name(const std::vector<std::string>& names, const std::string& name);

void bind_collections(nb::module_&);

} // namespace restage::python
