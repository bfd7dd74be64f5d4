// SPDX-License-Identifier: Apache-2.0
// How commands read scenes and projects: with a progress bar, until Ctrl+C, in a separate process if `--isolate` says
// so.
#pragma once

#include "base/result.hpp"
#include "document/document.hpp"

namespace restage::app {

class Context;
class ProgressBar;

// The bar has to outlive the options. Interrupts are caught from here on.
Result<document::ReadOptions> reading_with(const Context&, ProgressBar&);

} // namespace restage::app
