// SPDX-License-Identifier: Apache-2.0
// Thread priority: what somebody waits for (a window) goes before what fills the time (rendering).
#pragma once

namespace restage {

// Lowers the calling thread, and every thread it starts afterwards, by `steps` (nice levels, 1..19). A Vulkan device or
// a Jobs pool made by such a thread works at that priority. Where it cannot be done it does nothing. [any]
void lower_thread_priority(int steps);

} // namespace restage
