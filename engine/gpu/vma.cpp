// SPDX-License-Identifier: Apache-2.0
// The one place where VulkanMemoryAllocator's code is compiled. Functions come from volk at run time.
#include <volk.h>

#define VMA_STATIC_VULKAN_FUNCTIONS 0
#define VMA_DYNAMIC_VULKAN_FUNCTIONS 1
#define VMA_IMPLEMENTATION
#include <vk_mem_alloc.h>
