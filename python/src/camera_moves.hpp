// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "workspace.hpp"

namespace restage::python {

void bind_camera_moves(nb::module_&, nb::class_<Workspace>&);

} // namespace restage::python
