// SPDX-License-Identifier: Apache-2.0
// Every panel, menu and dialog, one after the other, for tests that look at their layout or take pictures.
#pragma once

#include "headless.hpp"

#include <functional>
#include <string>

namespace restage::tests {

// Calls `look` for each state, with its name and that of the window of interest ("" = the topmost popup). The document
// is not changed except by what the states need.
using Look = std::function<void(ImGuiTestContext*, const std::string& state, const std::string& window)>;
void tour_of_panels(Headless& h, const Look& look);

} // namespace restage::tests
