# SPDX-License-Identifier: Apache-2.0
# Third-party libraries, under our own names dep::<x>: a package with a CMake config first (vcpkg, Debian), else the
# headers Debian installs without one, else the sources tools/setup unpacked into RESTAGE_DEPS_DIR.
# Libraries compiled from source (imgui and related, volk) are built only if something links them.
set(RESTAGE_HOW_TO_GET "On Debian run tools/setup; elsewhere configure with vcpkg's toolchain file (see vcpkg.json).")

# find_package and find_path for required dependencies, with a hint how to get missing ones.
macro(restage_find_package name)
    find_package(${name} ${ARGN} QUIET)
    if(NOT ${name}_FOUND)
        message(FATAL_ERROR "The package ${name} was not found. ${RESTAGE_HOW_TO_GET}")
    endif()
endmacro()
macro(restage_find_path variable file)
    find_path(${variable} "${file}" ${ARGN})
    if(NOT ${variable})
        message(FATAL_ERROR "${file} was not found. ${RESTAGE_HOW_TO_GET}")
    endif()
endmacro()

set(THREADS_PREFER_PTHREAD_FLAG ON)
restage_find_package(Threads)

# dep::<name> = the first of the given targets that exists, with its headers taken as system headers.
function(restage_dep name)
    foreach(candidate IN LISTS ARGN)
        if(TARGET ${candidate})
            add_library(dep_${name} INTERFACE)
            target_link_libraries(dep_${name} INTERFACE ${candidate})
            add_library(dep::${name} ALIAS dep_${name})
            return()
        endif()
    endforeach()
    message(FATAL_ERROR "dep::${name}: none of the targets ${ARGN} exists. ${RESTAGE_HOW_TO_GET}")
endfunction()

# dep::<name> = headers found by one of them, and optionally a library.
function(restage_dep_headers name header) # [SUFFIXES ..] [LIBRARY ..]
    cmake_parse_arguments(PARSE_ARGV 2 arg "" "LIBRARY" "SUFFIXES")
    restage_find_path(RESTAGE_${name}_INCLUDE "${header}" PATH_SUFFIXES ${arg_SUFFIXES})
    mark_as_advanced(RESTAGE_${name}_INCLUDE)
    add_library(dep_${name} INTERFACE)
    target_include_directories(dep_${name} SYSTEM INTERFACE "${RESTAGE_${name}_INCLUDE}")
    if(arg_LIBRARY)
        find_library(RESTAGE_${name}_LIBRARY "${arg_LIBRARY}")
        if(NOT RESTAGE_${name}_LIBRARY)
            message(FATAL_ERROR "The library ${arg_LIBRARY} was not found. ${RESTAGE_HOW_TO_GET}")
        endif()
        mark_as_advanced(RESTAGE_${name}_LIBRARY)
        target_link_libraries(dep_${name} INTERFACE "${RESTAGE_${name}_LIBRARY}")
    endif()
    add_library(dep::${name} ALIAS dep_${name})
endfunction()

# --- Vulkan -----------------------------------------------------------------------------------------------------------
restage_find_package(VulkanHeaders CONFIG)
restage_dep(vulkan_headers Vulkan::Headers)

find_package(volk CONFIG QUIET)
if(NOT TARGET volk::volk)
    restage_find_path(RESTAGE_volk_SOURCE volk.c)
    add_library(restage_volk STATIC EXCLUDE_FROM_ALL "${RESTAGE_volk_SOURCE}/volk.c")
    target_link_libraries(restage_volk PUBLIC Vulkan::Headers ${CMAKE_DL_LIBS})
    target_compile_definitions(restage_volk PUBLIC VK_NO_PROTOTYPES)
endif()
restage_dep(volk volk::volk restage_volk)

restage_find_package(VulkanMemoryAllocator CONFIG)
restage_dep(vma GPUOpen::VulkanMemoryAllocator)

# GLSL to SPIR-V at run time. The pieces are one library each up to glslang 12 and fewer after that.
find_package(SPIRV-Tools-opt CONFIG QUIET)
restage_find_package(glslang CONFIG)
add_library(dep_glslang INTERFACE)
foreach(piece glslang MachineIndependent GenericCodeGen OGLCompiler OSDependent SPIRV glslang-default-resource-limits)
    if(TARGET glslang::${piece})
        target_link_libraries(dep_glslang INTERFACE glslang::${piece})
    elseif(TARGET ${piece})
        target_link_libraries(dep_glslang INTERFACE ${piece})
    endif()
endforeach()
foreach(piece SPIRV-Tools-opt SPIRV-Tools-static SPIRV-Tools)
    if(TARGET ${piece})
        target_link_libraries(dep_glslang INTERFACE ${piece})
    endif()
endforeach()
target_link_libraries(dep_glslang INTERFACE Threads::Threads)
add_library(dep::glslang ALIAS dep_glslang)

# --- geometry, scenes, images ---------------------------------------------------------------------------------------------
# Embree 3 on Debian 12, Embree 4 elsewhere: RESTAGE_EMBREE_MAJOR tells the code which API it has.
restage_find_package(embree CONFIG)
restage_dep(embree embree)
target_compile_definitions(dep_embree INTERFACE RESTAGE_EMBREE_MAJOR=${embree_VERSION_MAJOR})

restage_find_package(glm CONFIG)
restage_dep(glm glm::glm glm)
target_compile_definitions(dep_glm INTERFACE GLM_FORCE_DEPTH_ZERO_TO_ONE GLM_FORCE_CTOR_INIT)

restage_find_package(tl-expected CONFIG)
restage_dep(expected tl::expected)
restage_find_package(nlohmann_json CONFIG)
restage_dep(json nlohmann_json::nlohmann_json)
restage_find_package(OpenEXR CONFIG)
restage_dep(openexr OpenEXR::OpenEXR)
restage_find_package(ZLIB)
restage_dep(zlib ZLIB::ZLIB)
find_package(TinyGLTF CONFIG QUIET)
if(TARGET TinyGLTF::TinyGLTF)
    restage_dep(tinygltf TinyGLTF::TinyGLTF)
else()
    restage_dep_headers(tinygltf tiny_gltf.h)
endif()
restage_dep_headers(png spng.h LIBRARY spng)
restage_find_package(JPEG) # libjpeg-turbo
restage_dep(jpeg JPEG::JPEG)
restage_dep_headers(webp webp/decode.h LIBRARY webp)
restage_dep_headers(stb stb_image.h SUFFIXES stb) # headers; users of the code define STB_..._IMPLEMENTATION once

# --- program and tests ------------------------------------------------------------------------------------------------------
# CLI11 is header-only; compiled once here it costs each file that includes it 2 s instead of 8.
restage_find_package(CLI11 CONFIG)
restage_find_path(RESTAGE_cli11_IMPL CLI/impl/App_inl.hpp)
mark_as_advanced(RESTAGE_cli11_IMPL)
file(GLOB cli11_parts RELATIVE "${RESTAGE_cli11_IMPL}" "${RESTAGE_cli11_IMPL}/CLI/impl/*_inl.hpp")
list(TRANSFORM cli11_parts REPLACE "(.+)" "#include <\\1>")
list(JOIN cli11_parts "\n" cli11_parts)
file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/deps/cli11.cpp" CONTENT "${cli11_parts}\n" @ONLY)
add_library(dep_cli11 STATIC EXCLUDE_FROM_ALL "${CMAKE_BINARY_DIR}/deps/cli11.cpp")
target_link_libraries(dep_cli11 PUBLIC CLI11::CLI11)
target_compile_definitions(dep_cli11 PUBLIC CLI11_COMPILE)
add_library(dep::cli11 ALIAS dep_cli11)
restage_find_package(fmt CONFIG)
restage_dep(fmt fmt::fmt)
restage_find_package(glfw3 CONFIG)
restage_dep(glfw glfw)
target_compile_definitions(dep_glfw INTERFACE GLFW_INCLUDE_NONE)
if(RESTAGE_BUILD_TESTS)
    restage_find_package(Catch2 3 CONFIG)
    restage_dep(catch2 Catch2::Catch2WithMain)
    restage_dep(catch2_no_main Catch2::Catch2)
endif()

include(DepsImgui)

# --- Open Image Denoise: opened at run time, never linked ----------------------------------------------------------------
set(RESTAGE_OIDN_LIB_DIR "${RESTAGE_DEPS_DIR}/pyoidn/pyoidn/oidn/lib" CACHE PATH
    "Folder with libOpenImageDenoise.so.2 and the libraries it opens; it must be named 'lib'")

# --- a software Vulkan device for tests ----------------------------------------------------------------------------------
# The name of lavapipe's driver file differs between Mesa packages. Tests run on it, wherever it is installed.
file(GLOB lavapipe_files /usr/share/vulkan/icd.d/lvp_icd*.json /usr/local/share/vulkan/icd.d/lvp_icd*.json)
if(lavapipe_files)
    list(GET lavapipe_files 0 lavapipe_files)
endif()
set(RESTAGE_LAVAPIPE_ICD "${lavapipe_files}" CACHE FILEPATH "Driver file of Mesa's lavapipe; tests use it when set")
