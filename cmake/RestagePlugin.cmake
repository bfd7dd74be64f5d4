# SPDX-License-Identifier: Apache-2.0
# restage_add_plugin(NAME <name> KIND <kind> [SOURCES <files>] MANIFEST plugin.json
#                    [GLSL <files>] [FILES <files and folders>] [LINK <third-party targets>])
# <kind>: material, texture, importer, exporter, denoiser, sky, action or panel. For a bundle it is the main one, used
# only in the folder's name.
# The build system part of the SDK, here and (find_package(Restage)) for plugins outside this repository.
# Builds lib/restage/plugins/<kind>-<name>/ in the build tree: <name>.so, its manifest, its GLSL and files needed at
# run time (FILES). A plugin sees the SDK headers and the third-party targets it names, nothing of the engine.

# Puts files into a folder of the build tree: links, so that edits need no build; copies where links need privileges.
function(restage_place_files target folder)
    foreach(file IN LISTS ARGN)
        get_filename_component(source "${file}" ABSOLUTE)
        get_filename_component(name "${file}" NAME)
        if(CMAKE_HOST_UNIX)
            file(MAKE_DIRECTORY "${folder}")
            file(CREATE_LINK "${source}" "${folder}/${name}" SYMBOLIC)
        elseif(IS_DIRECTORY "${source}")
            add_custom_command(TARGET ${target} POST_BUILD
                COMMAND ${CMAKE_COMMAND} -E copy_directory "${source}" "${folder}/${name}")
        else()
            add_custom_command(OUTPUT "${folder}/${name}"
                COMMAND ${CMAKE_COMMAND} -E copy "${source}" "${folder}/${name}" DEPENDS "${source}")
            list(APPEND copies "${folder}/${name}")
        endif()
    endforeach()
    if(copies)
        add_custom_target(${target}_files ALL DEPENDS ${copies})
        add_dependencies(${target} ${target}_files)
    endif()
endfunction()

function(restage_add_plugin)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME;KIND;MANIFEST" "SOURCES;GLSL;FILES;LINK")
    set(usage "restage_add_plugin(NAME n KIND <kind> SOURCES .. MANIFEST plugin.json)")
    if(arg_UNPARSED_ARGUMENTS OR NOT arg_NAME OR NOT arg_MANIFEST)
        message(FATAL_ERROR "${usage}: incomplete, or unknown arguments: '${arg_UNPARSED_ARGUMENTS}'")
    endif()
    if(NOT arg_KIND MATCHES "^(material|texture|importer|exporter|denoiser|sky|action|panel)$")
        message(FATAL_ERROR "${usage}: plugin '${arg_NAME}' has the unknown kind '${arg_KIND}'")
    endif()
    set(target restage_${arg_KIND}_${arg_NAME})
    # One folder per plugin; an importer and an exporter may share a name, so the kind is part of it.
    set(folder "${RESTAGE_PLUGIN_DIR}/${arg_KIND}-${arg_NAME}")

    if(arg_SOURCES)
        add_library(${target} MODULE ${arg_SOURCES})
        target_link_libraries(${target} PRIVATE restage_sdk ${arg_LINK})
        if(TARGET restage_warnings)
            target_link_libraries(${target} PRIVATE restage_warnings)
        endif()
        set_target_properties(${target} PROPERTIES
            PREFIX "" OUTPUT_NAME "${arg_NAME}"
            C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
            LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${folder}")
        install(TARGETS ${target} LIBRARY DESTINATION "${folder}")
    else() # no native code
        add_custom_target(${target} ALL)
    endif()
    if(arg_SOURCES AND NOT arg_KIND MATCHES "^(importer|exporter|denoiser)$")
        # It may be reloaded. GNU unique symbols would pin the previous version in memory.
        target_compile_options(${target} PRIVATE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-gnu-unique>)
    endif()
    restage_place_files(${target} "${CMAKE_BINARY_DIR}/${folder}" ${arg_MANIFEST} ${arg_GLSL} ${arg_FILES})
    install(FILES ${arg_MANIFEST} ${arg_GLSL} DESTINATION "${folder}")
    foreach(file IN LISTS arg_FILES)
        get_filename_component(absolute "${file}" ABSOLUTE)
        if(IS_DIRECTORY "${absolute}")
            install(DIRECTORY "${file}" DESTINATION "${folder}")
        else()
            install(FILES "${file}" DESTINATION "${folder}")
        endif()
    endforeach()
    set_property(GLOBAL APPEND PROPERTY RESTAGE_PLUGINS ${target})
endfunction()
