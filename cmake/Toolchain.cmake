# SPDX-License-Identifier: Apache-2.0
# Compiler launcher, linker, build types and sanitizers: settings common to every target, ours and third-party.
include(CheckLinkerFlag)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    check_linker_flag(CXX "-fuse-ld=mold" RESTAGE_HAVE_MOLD)
    if(RESTAGE_HAVE_MOLD)
        add_link_options("-fuse-ld=mold")
    endif()
    # Release is for users. RelWithDebInfo is for CI: assertions stay on, line tables for stack traces.
    set(CMAKE_C_FLAGS_RELEASE "-O3 -DNDEBUG")
    set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
    set(CMAKE_C_FLAGS_RELWITHDEBINFO "-O2 -g1")
    set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O2 -g1")
    # Nothing here reads errno after a math call or traps floating-point exceptions; NaN and Inf keep their meaning.
    add_compile_options(-fno-math-errno -fno-trapping-math)
    # Paths in messages and debug information are relative to the source tree: same objects in every clone, ccache hits.
    add_compile_options("-ffile-prefix-map=${CMAKE_SOURCE_DIR}/=")
    if(RESTAGE_SANITIZE)
        add_compile_options(-fsanitize=${RESTAGE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
        add_link_options(-fsanitize=${RESTAGE_SANITIZE})
    endif()
elseif(RESTAGE_SANITIZE)
    message(FATAL_ERROR "RESTAGE_SANITIZE needs GCC or Clang; this compiler is ${CMAKE_CXX_COMPILER_ID}.")
endif()
