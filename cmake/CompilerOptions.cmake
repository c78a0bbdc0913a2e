# SPDX-License-Identifier: MIT
# One set of compiler options for everything that is built here.
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

find_program(ccache_program ccache)
if(ccache_program AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${ccache_program})
endif()

add_library(roomscribe_options INTERFACE)
target_compile_options(roomscribe_options INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow
    # The same bits on every machine: no fused multiply-add behind our back.
    -ffp-contract=off
    # GCC 12 sees overlapping copies in std::string's operator+ where there are none (GCC bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    $<$<BOOL:${ROOMSCRIBE_WERROR}>:-Werror>)
