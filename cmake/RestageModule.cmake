# SPDX-License-Identifier: Apache-2.0
# restage_add_module(NAME <name> DEPENDS <modules> [LINK <public third-party>] [LINK_PRIVATE <private third-party>])
# Defines restage_<name> from the *.cpp of the calling folder. DEPENDS defines who may include whom: it is the complete
# list of engine modules whose headers the module may see (tests/scripts/test_layers.py enforces it).
function(restage_add_module)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME" "DEPENDS;LINK;LINK_PRIVATE")
    if(NOT arg_NAME OR arg_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "restage_add_module: NAME is required; unknown arguments: ${arg_UNPARSED_ARGUMENTS}")
    endif()
    set(target restage_${arg_NAME})
    file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/*.c")
    list(TRANSFORM arg_DEPENDS PREPEND restage_)
    if(sources)
        add_library(${target} STATIC ${sources})
        target_include_directories(${target} PUBLIC "${CMAKE_SOURCE_DIR}/engine" "${CMAKE_SOURCE_DIR}/shaders")
        target_link_libraries(${target} PUBLIC ${arg_DEPENDS} ${arg_LINK} PRIVATE ${arg_LINK_PRIVATE} restage_warnings)
    else() # headers only
        add_library(${target} INTERFACE)
        target_include_directories(${target} INTERFACE "${CMAKE_SOURCE_DIR}/engine" "${CMAKE_SOURCE_DIR}/shaders")
        target_link_libraries(${target} INTERFACE ${arg_DEPENDS} ${arg_LINK})
    endif()
endfunction()
