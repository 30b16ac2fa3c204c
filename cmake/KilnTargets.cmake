# SPDX-License-Identifier: GPL-3.0-or-later
# Settings of every target: C++20, warnings as errors, one folder for executables, ccache.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
# Where programs and the runtime look for libkiln-openimageio.so (image/picture_codec.h).
set(CMAKE_BUILD_RPATH "$ORIGIN/../lib")
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/kiln")

find_program(KILN_CCACHE ccache)
if(KILN_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${KILN_CCACHE})
endif()

add_library(kiln_flags INTERFACE)
option(KILN_WARNINGS_AS_ERRORS "Stop at compilers' warnings; off for compilers that the house was not built with" ON)
target_compile_options(kiln_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow)
# Turns -Wrestrict off: GCC 12's misfires on std::string concatenation (GCC bug 105651).
target_compile_options(kiln_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(KILN_WARNINGS_AS_ERRORS)
  target_compile_options(kiln_flags INTERFACE -Werror)
endif()
target_include_directories(kiln_flags INTERFACE ${PROJECT_SOURCE_DIR}/stages/core ${PROJECT_SOURCE_DIR}/stages ${PROJECT_SOURCE_DIR})
target_compile_definitions(kiln_flags INTERFACE KILN_VERSION="${PROJECT_VERSION}")
# Turns -Wsubobject-linkage off in unity builds: GCC takes the files of a unit for headers.
if(CMAKE_UNITY_BUILD)
  target_compile_options(kiln_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(KILN_SANITIZE)
  # Turns -Wmaybe-uninitialized off: GCC takes the sanitizers' checks of values for uses of uninitialised ones (bug
  # 100016).
  target_compile_options(kiln_flags INTERFACE -fsanitize=${KILN_SANITIZE} -fno-omit-frame-pointer -Wno-maybe-uninitialized)
  target_link_options(kiln_flags INTERFACE -fsanitize=${KILN_SANITIZE})
endif()

# Compiles a target's code at -O1, in two thirds of the time: for what runs once, not for loops over triangles, texels or
# rays.
function(kiln_compile_quickly name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Defines kiln_library(NAME SOURCES... LINK libraries... [COLD]): a static library of Kiln's own; COLD compiles quickly.
function(kiln_library name)
  cmake_parse_arguments(ARG "COLD" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC kiln_flags ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK})
  if(ARG_COLD)
    kiln_compile_quickly(${name})
  endif()
endfunction()

# Defines kiln_program(NAME SOURCES... LINK libraries... [COLD]): an executable in build/<preset>/bin; COLD as above.
function(kiln_program name)
  cmake_parse_arguments(ARG "COLD" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE kiln_flags ${ARG_LINK})
  if(ARG_COLD)
    kiln_compile_quickly(${name})
  endif()
endfunction()
