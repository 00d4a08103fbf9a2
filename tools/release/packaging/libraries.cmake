# What we are linked with and under which licences: the rows of libraries.tsv, and documents made of
# them.

# animeme_libraries(RESULT): the rows, each as "name|object|licence|version|use|by", with the
# versions installed.
function(animeme_libraries result)
  find_program(ANIMEME_PKG_CONFIG pkg-config)
  mark_as_advanced(ANIMEME_PKG_CONFIG)
  file(STRINGS ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/libraries.tsv lines REGEX "^[^#]")
  set(rows "")
  foreach(line IN LISTS lines)
    string(REPLACE "\t" ";" cells "${line}\t")
    list(GET cells 0 1 2 start)
    list(GET cells 3 module)
    list(GET cells 4 5 end)
    set(version "")
    if(ANIMEME_PKG_CONFIG AND NOT module STREQUAL "-")
      execute_process(COMMAND ${ANIMEME_PKG_CONFIG} --modversion ${module} OUTPUT_VARIABLE version
        OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    endif()
    string(REPLACE ";" "|" row "${start};${version};${end}")
    list(APPEND rows "${row}")
  endforeach()
  set(${result} "${rows}" PARENT_SCOPE)
endfunction()

# animeme_libraries_source(FILE): the same as C++, for the program (tools/app/commands/licences.h).
function(animeme_libraries_source file)
  animeme_libraries(rows)
  set(text "")
  foreach(row IN LISTS rows)
    string(REPLACE "|" "\", \"" row "${row}")
    string(APPEND text "    {\"${row}\"},\n")
  endforeach()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${PROJECT_SOURCE_DIR}/tools/release/packaging/libraries.tsv)
  file(CONFIGURE OUTPUT ${file} @ONLY CONTENT [[#include "tools/app/commands/licences.h"
namespace animeme::tools {
namespace {
constexpr Library kLibraries[] = {
@text@};
}  // namespace
std::span<const Library> known_libraries() { return kLibraries; }
}  // namespace animeme::tools
]])
endfunction()

# animeme_spdx(PACKAGE COMPONENT component [LINKED targets...] [LOADED targets...] [CONTAINS
# names...]): the SPDX document of a package: what the objects of LINKED targets are linked with,
# what LOADED ones (modules) need once they are asked for, and whose headers became part of them.
# Installed with `component`.
function(animeme_spdx package)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "COMPONENT" "LINKED;LOADED;CONTAINS")
  set(linked "")
  set(loaded "")
  foreach(kind linked loaded)
    string(TOUPPER ${kind} upper)
    foreach(target IN LISTS arg_${upper})
      if(TARGET ${target})
        list(APPEND ${kind} $<TARGET_FILE:${target}>)
        list(APPEND targets ${target})
      endif()
    endforeach()
  endforeach()
  set(document ${PROJECT_BINARY_DIR}/spdx/${package}.spdx)
  set(script ${PROJECT_SOURCE_DIR}/tools/release/packaging/spdx.cmake)
  string(REPLACE ";" "," contains "${arg_CONTAINS}")
  add_custom_command(OUTPUT ${document} COMMENT "SPDX document of ${package}" VERBATIM
    DEPENDS ${targets} ${script} ${PROJECT_SOURCE_DIR}/tools/release/packaging/libraries.tsv
    COMMAND ${CMAKE_COMMAND} -DPACKAGE=${package} -DVERSION=${PROJECT_VERSION}
    -DREADELF=${CMAKE_READELF}
      "-DLINKED=$<JOIN:${linked},,>" "-DLOADED=$<JOIN:${loaded},,>" -DCONTAINS=${contains}
      -DOUTPUT=${document}
      -P ${script})
  add_custom_target(spdx_${package} ALL DEPENDS ${document})
  install(FILES ${document} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/animeme
    COMPONENT ${arg_COMPONENT} OPTIONAL)
endfunction()

# The documents of the packages of tools/release/packaging/debian.
function(animeme_install_licences)
  if(NOT CMAKE_READELF OR CMAKE_CROSSCOMPILING OR NOT CMAKE_SYSTEM_NAME STREQUAL "Linux"
    OR ANIMEME_SANITIZE)
    return()
  endif()
  set(models)
  if(TARGET animeme_dam)
    set(models Eigen)
  endif()
  # part of the WebAssembly of tools/view/viewer/rig
  set(pages "libc++ (pages)" "wasi-libc (pages)")
  if(TARGET animeme)
    get_property(modules GLOBAL PROPERTY ANIMEME_MODULES)
    animeme_spdx(animeme COMPONENT program LINKED animeme LOADED ${modules}
      CONTAINS ${models} CLI11 nlohmann_json toml++ ${pages})
    set(tools nlohmann_json toml++ ${pages})
  endif()
  if(TARGET animeme_c)
    animeme_spdx(libanimeme0 COMPONENT c LINKED animeme_c CONTAINS ${models})
    animeme_spdx(libanimeme-dev COMPONENT package CONTAINS ${models} ${tools})
  endif()
  if(TARGET animeme_python)
    animeme_spdx(python3-animeme COMPONENT python LINKED animeme_python CONTAINS ${models} ${tools}
      pybind11)
  endif()
endfunction()
