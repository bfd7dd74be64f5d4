// SPDX-License-Identifier: Apache-2.0
#include "base/thread_priority.hpp"

#if defined(__linux__)
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#elif defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#endif

namespace restage {

void lower_thread_priority(int steps) {
#if defined(__linux__)
    // On Linux a nice value belongs to a thread, and new threads inherit it (sched(7)).
    const auto thread = static_cast<id_t>(syscall(SYS_gettid));
    setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + steps);
#elif defined(_WIN32)
    SetThreadPriority(GetCurrentThread(), steps > 5 ? THREAD_PRIORITY_LOWEST : THREAD_PRIORITY_BELOW_NORMAL);
#else
    static_cast<void>(steps);
#endif
}

} // namespace restage
