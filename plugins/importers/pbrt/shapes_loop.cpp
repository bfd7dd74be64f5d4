// SPDX-License-Identifier: Apache-2.0
#include "mesh.hpp"
namespace restage::pbrt {
Mesh make_loop(Import&, const Directive& shape) { throw ImportError{shape.at, "loopsubdiv"}; }
} // namespace restage::pbrt
