# SPDX-License-Identifier: Apache-2.0
# restage_warnings: link it PRIVATE to every target of ours. Third-party code is compiled without it.
add_library(restage_warnings INTERFACE)
if(MSVC)
    target_compile_options(restage_warnings INTERFACE /W4 /permissive- $<$<BOOL:${RESTAGE_WERROR}>:/WX>)
else()
    target_compile_options(restage_warnings INTERFACE
        -Wall -Wextra -Wpedantic -Wshadow -Wcast-align -Wformat=2 -Wimplicit-fallthrough
        $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>
        # Vulkan and the SDK are filled with designated initialisers; unnamed members are zero on purpose.
        -Wno-missing-field-initializers
        $<$<BOOL:${RESTAGE_WERROR}>:-Werror>)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        # GCC bug 105651, and its like for std::optional and std::variant: false positives inside std::string of GCC 12.
        target_compile_options(restage_warnings INTERFACE -Wno-restrict $<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized>)
    endif()
endif()
