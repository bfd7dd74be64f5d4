// SPDX-License-Identifier: Apache-2.0
// In a separate file, so that compilers see only pairs of new and delete elsewhere.
#include "allocations.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::uint64_t> made{0};
}

void* operator new(std::size_t bytes) {
    made.fetch_add(1, std::memory_order_relaxed);
    if (void* memory = std::malloc(bytes ? bytes : 1)) return memory;
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace restage::bench {

std::uint64_t allocations_made() { return made; }

} // namespace restage::bench
