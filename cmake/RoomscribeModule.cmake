# SPDX-License-Identifier: MIT
# roomscribe_module(NAME [DEPENDS module...] [PUBLIC library...] [PRIVATE library...])
#
# Declares one module: a static library made of every source in and below the current folder.
# DEPENDS names the roomscribe modules it may include from, all of them on lower floors
# (docs/architecture.md); `./dev lint` holds the #include lines against it. Every header compiles
# alone: a source includes its own header first, and of headers without a source the set lone_headers
# makes sources (target all_verify_interface_header_sets).
function(roomscribe_module name)
    cmake_parse_arguments(arg "" "" "DEPENDS;PUBLIC;PRIVATE" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS *.hpp)

    set(target roomscribe_${name})
    add_library(${target} STATIC ${sources})
    add_library(roomscribe::${name} ALIAS ${target})
    set(lone_headers ${headers})
    foreach(source IN LISTS sources)
        string(REGEX REPLACE "[.]cpp$" ".hpp" own_header ${source})
        list(REMOVE_ITEM lone_headers ${own_header})
    endforeach()
    list(REMOVE_ITEM headers ${lone_headers})
    target_sources(${target} PUBLIC
        FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${headers}
        FILE_SET lone_headers TYPE HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${lone_headers})
    target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(${target}
        PUBLIC ${arg_PUBLIC} PRIVATE roomscribe_options ${arg_PRIVATE})
    foreach(dependency IN LISTS arg_DEPENDS)
        target_link_libraries(${target} PUBLIC roomscribe::${dependency})
    endforeach()
    set_target_properties(${target} PROPERTIES
        POSITION_INDEPENDENT_CODE ON VERIFY_INTERFACE_HEADER_SETS ON
        INTERFACE_HEADER_SETS_TO_VERIFY lone_headers LINKER_LANGUAGE CXX)
endfunction()
