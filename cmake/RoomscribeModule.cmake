# SPDX-License-Identifier: MIT
# roomscribe_module(NAME [DEPENDS module...] [PUBLIC library...] [PRIVATE library...])
#
# Declares one module: a static library made of every source in and below the current folder.
# DEPENDS names the roomscribe modules it may include from, all of them on lower floors
# (docs/architecture.md); `./dev lint` holds the #include lines against it, and the header set makes
# every header compile alone (target all_verify_interface_header_sets).
function(roomscribe_module name)
    cmake_parse_arguments(arg "" "" "DEPENDS;PUBLIC;PRIVATE" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS *.hpp)

    set(target roomscribe_${name})
    add_library(${target} STATIC ${sources})
    add_library(roomscribe::${name} ALIAS ${target})
    target_sources(${target} PUBLIC FILE_SET HEADERS
        BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${headers})
    target_include_directories(${target} PUBLIC ${PROJECT_SOURCE_DIR}/src)
    target_link_libraries(${target}
        PUBLIC ${arg_PUBLIC} PRIVATE roomscribe_options ${arg_PRIVATE})
    foreach(dependency IN LISTS arg_DEPENDS)
        target_link_libraries(${target} PUBLIC roomscribe::${dependency})
    endforeach()
    set_target_properties(${target} PROPERTIES
        POSITION_INDEPENDENT_CODE ON VERIFY_INTERFACE_HEADER_SETS ON LINKER_LANGUAGE CXX)
endfunction()
