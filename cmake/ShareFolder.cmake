# SPDX-License-Identifier: Apache-2.0
# restage_share_folder(<folder> [AS <name>]): provides the source folder as share/restage/<name> in the build tree and the
# installed tree; the name defaults to the folder's own. In the build tree it is a link: edits need no build.
function(restage_share_folder folder)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "AS" "")
    set(source "${CMAKE_SOURCE_DIR}/${folder}")
    if(NOT arg_AS)
        set(arg_AS "${folder}")
    endif()
    set(place "share/restage/${arg_AS}")
    if(NOT EXISTS "${source}")
        return()
    endif()
    if(CMAKE_HOST_UNIX)
        file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/share/restage")
        file(CREATE_LINK "${source}" "${CMAKE_BINARY_DIR}/${place}" SYMBOLIC)
    else()
        file(GLOB_RECURSE files CONFIGURE_DEPENDS "${source}/*")
        set(stamp "${CMAKE_BINARY_DIR}/${arg_AS}.stamp")
        add_custom_command(OUTPUT "${stamp}" DEPENDS ${files}
            COMMAND ${CMAKE_COMMAND} -E copy_directory "${source}" "${CMAKE_BINARY_DIR}/${place}"
            COMMAND ${CMAKE_COMMAND} -E touch "${stamp}")
        add_custom_target(restage_share_${arg_AS} ALL DEPENDS "${stamp}")
    endif()
    install(DIRECTORY "${source}/" DESTINATION "${place}")
endfunction()
