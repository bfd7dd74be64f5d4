# SPDX-License-Identifier: Apache-2.0
# Dear ImGui (docking) with its GLFW and Vulkan backends, test engine, ImGuizmo and ImPlot, compiled from the
# sources in RESTAGE_DEPS_DIR, or taken from vcpkg. None of it is built unless a target links it.
set(bundle "${RESTAGE_DEPS_DIR}/imgui-bundle/external")
if(NOT EXISTS "${bundle}/imgui/imgui/imgui.h")
    restage_find_package(imgui CONFIG) # vcpkg's; else the sources unpacked by tools/setup
    restage_dep(imgui imgui::imgui)
    restage_find_package(imguizmo CONFIG)
    restage_dep(imguizmo imguizmo::imguizmo)
    restage_find_package(implot CONFIG)
    restage_dep(implot implot::implot)
    return()
endif()

function(restage_imgui_library name folder) # sources..., relative to the folder
    list(TRANSFORM ARGN PREPEND "${folder}/" OUTPUT_VARIABLE sources)
    add_library(dep_${name} STATIC EXCLUDE_FROM_ALL ${sources})
    target_include_directories(dep_${name} SYSTEM PUBLIC "${folder}")
    target_compile_options(dep_${name} PRIVATE -w)
    add_library(dep::${name} ALIAS dep_${name})
endfunction()

restage_imgui_library(imgui "${bundle}/imgui/imgui"
    imgui.cpp imgui_demo.cpp imgui_draw.cpp imgui_tables.cpp imgui_widgets.cpp imgui_stacklayout.cpp
    misc/cpp/imgui_stdlib.cpp backends/imgui_impl_glfw.cpp backends/imgui_impl_vulkan.cpp)
target_include_directories(dep_imgui SYSTEM PUBLIC "${bundle}/imgui/imgui/backends" "${bundle}/imgui/imgui/misc/cpp")
target_link_libraries(dep_imgui PUBLIC dep::glfw dep::volk)
# Every user must see the same configuration: volk loads Vulkan; the test engine's hooks are compiled in if linked.
target_compile_definitions(dep_imgui PUBLIC IMGUI_IMPL_VULKAN_USE_VOLK IMGUI_DISABLE_OBSOLETE_FUNCTIONS)
if(RESTAGE_BUILD_TESTS)
    target_compile_definitions(dep_imgui PUBLIC IMGUI_ENABLE_TEST_ENGINE IMGUI_TEST_ENGINE_ENABLE_STD_FUNCTION=1
        IMGUI_TEST_ENGINE_ENABLE_COROUTINE_STDTHREAD_IMPL=1)
endif()

restage_imgui_library(imguizmo "${bundle}/ImGuizmo/ImGuizmo/src" ImGuizmo.cpp)
target_link_libraries(dep_imguizmo PUBLIC dep::imgui)

restage_imgui_library(implot "${bundle}/implot/implot" implot.cpp implot_items.cpp)
target_link_libraries(dep_implot PUBLIC dep::imgui)
# ImPlot instantiates every plot for ten number types; two are enough, and -O3 on that file takes minutes.
target_compile_definitions(dep_implot PUBLIC "IMPLOT_CUSTOM_NUMERIC_TYPES=(float)(double)")
target_compile_options(dep_implot PRIVATE -O1)

if(RESTAGE_BUILD_TESTS) # not needed in a wheel
    file(GLOB engine_sources RELATIVE "${bundle}/imgui_test_engine/imgui_test_engine/imgui_test_engine"
        "${bundle}/imgui_test_engine/imgui_test_engine/imgui_test_engine/*.cpp")
    restage_imgui_library(imgui_test_engine "${bundle}/imgui_test_engine/imgui_test_engine/imgui_test_engine" ${engine_sources})
    target_include_directories(dep_imgui_test_engine SYSTEM PUBLIC "${bundle}/imgui_test_engine/imgui_test_engine")
    target_link_libraries(dep_imgui_test_engine PUBLIC dep::imgui Threads::Threads)
    # Dear ImGui calls the engine's hooks and the engine calls Dear ImGui, so each links the other.
    target_link_libraries(dep_imgui PUBLIC dep_imgui_test_engine)
endif()
