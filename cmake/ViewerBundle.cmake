# SPDX-License-Identifier: MIT
# Sets viewer_bundle_source to a source that holds the 3D view of reports: bundled by esbuild where
# `./dev viewer` has installed it, else empty, and then reports are plain and say so.
set(viewer_folder ${PROJECT_SOURCE_DIR}/viewer)
set(viewer_bundle_source ${PROJECT_BINARY_DIR}/viewer_bundle.cpp)
set(viewer_esbuild ${viewer_folder}/node_modules/esbuild/bin/esbuild)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${viewer_folder})
find_program(ROOMSCRIBE_NODE node)
mark_as_advanced(ROOMSCRIBE_NODE)

if(ROOMSCRIBE_NODE AND EXISTS ${viewer_esbuild})
    file(GLOB viewer_sources CONFIGURE_DEPENDS ${viewer_folder}/src/* ${viewer_folder}/*.json)
    add_custom_command(OUTPUT ${viewer_bundle_source}
        COMMAND ${ROOMSCRIBE_NODE} ${viewer_folder}/bundle.mjs ${viewer_bundle_source}
        DEPENDS ${viewer_sources} ${viewer_folder}/bundle.mjs ${viewer_esbuild}
        COMMENT "Bundling the 3D view"
        VERBATIM)
    set_property(SOURCE ${viewer_bundle_source} APPEND PROPERTY
        COMPILE_OPTIONS $<$<CXX_COMPILER_ID:Clang>:-Wno-overlength-strings>)
else()
    message(STATUS "Reports will have no 3D view: ./dev viewer installs what bundles it")
    file(CONFIGURE OUTPUT ${viewer_bundle_source} CONTENT [[
#include "roomscribe/report/viewer_bundle.hpp"
std::string roomscribe::viewer_script() { return {}; }
std::string roomscribe::viewer_libraries() { return {}; }
]])
endif()
