// SPDX-License-Identifier: Apache-2.0
// Thread priority: interactive work (a window) goes before background work (rendering).
#pragma once

namespace restage {

// Lowers the calling thread, and every thread it starts afterwards, by `steps` (nice levels, 1..19). A Vulkan device or
// a Jobs pool created by such a thread runs at that priority. A no-op where unsupported. [any]
void lower_thread_priority(int steps);

} // namespace restage
