// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "view/live_view.hpp"

#include <string>

namespace restage::editor {

// What is said at the picture's corner. `compiling`: a material whose code is not ready; "" = none.
std::string picture_note(const view::Frame& shown, const std::string& compiling, bool beside_camera);

} // namespace restage::editor
