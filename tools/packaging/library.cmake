# animeme_library(): a library of the package, with the names under which others use it.
#
#   in the tree      #include "codec/decode/decoder.h"      rooms may move
#   elsewhere        #include <animeme/fba/decoder.h>       the component and the file: these stay
#
# The installed headers are those of the tree with their includes rewritten; a project that has this
# tree as a subdirectory gets a header of one line for each.

# The public headers below a folder, sorted, without those of libraries that lie inside it.
function(animeme_public_headers folder result)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
    ${PROJECT_SOURCE_DIR}/${folder}/*.h)
  list(FILTER headers EXCLUDE REGEX "/(detail|kinds|maths)/|_internal\\.h$")
  if(folder STREQUAL "fap")
    list(FILTER headers EXCLUDE REGEX "^fap/(head|xml)/")
  endif()
  list(SORT headers)
  set(${result} ${headers} PARENT_SCOPE)
endfunction()

# animeme_library(NAME folder FILES...): a library with alias animeme::NAME, exported as component
# NAME of the package.
function(animeme_library name folder)
  add_library(animeme_${name} ${ARGN})
  add_library(animeme::${name} ALIAS animeme_${name})
  target_include_directories(animeme_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(animeme_${name} PUBLIC cxx_std_20)
  target_link_libraries(animeme_${name} PRIVATE $<BUILD_INTERFACE:animeme_build>)
  set_target_properties(animeme_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS animeme_${name} EXPORT animeme_${name} COMPONENT ${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT animeme_${name} NAMESPACE animeme:: FILE animeme-${name}.cmake COMPONENT ${name}
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/animeme)
  set_property(GLOBAL APPEND PROPERTY ANIMEME_COMPONENTS ${name})

  animeme_public_headers(${folder} headers)
  set_property(GLOBAL PROPERTY ANIMEME_HEADERS_${name} "${headers}")
  install(CODE "set(animeme_component ${name})\nset(animeme_destination \"${CMAKE_INSTALL_INCLUDEDIR}\")"
    COMPONENT ${name})
  install(SCRIPT ${PROJECT_BINARY_DIR}/install_headers.cmake COMPONENT ${name})
  if(NOT PROJECT_IS_TOP_LEVEL)
    foreach(header IN LISTS headers)
      get_filename_component(file ${header} NAME)
      file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/include/animeme/${name}/${file}
        CONTENT "#include \"${header}\"  // IWYU pragma: export\n")
    endforeach()
    target_include_directories(animeme_${name} INTERFACE
      $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>)
  endif()
endfunction()

# animeme_requires(NAME [COMPONENTS names...] [FIND lines...]): what has to be found before component
# NAME is: other components, and lines of CMake for the package.
function(animeme_requires name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "COMPONENTS;FIND")
  set_property(GLOBAL APPEND PROPERTY ANIMEME_STANDS_ON_${name} ${arg_COMPONENTS})
  foreach(line IN LISTS arg_FIND)
    set_property(GLOBAL APPEND_STRING PROPERTY ANIMEME_FIND_${name} "  ${line}\n")
  endforeach()
endfunction()

# Installs the CMake package once all libraries are known.
function(animeme_install_package)
  include(CMakePackageConfigHelpers)
  get_property(components GLOBAL PROPERTY ANIMEME_COMPONENTS)
  set(animeme_table "")
  set(animeme_spread "")
  set(animeme_load "")
  foreach(name IN LISTS components)
    get_property(below GLOBAL PROPERTY ANIMEME_STANDS_ON_${name})
    get_property(find GLOBAL PROPERTY ANIMEME_FIND_${name})
    list(REMOVE_DUPLICATES below)
    list(JOIN below " " below)
    # From the top down a component asks for those below it; from the bottom up all are read.
    if(below)
      string(PREPEND animeme_spread
        "if(${name} IN_LIST animeme_wanted)\n  list(APPEND animeme_wanted ${below})\nendif()\n")
    endif()
    string(APPEND animeme_load "if(${name} IN_LIST animeme_wanted AND EXISTS \"\${CMAKE_CURRENT_LIST_DIR}/animeme-${name}.cmake\")\n${find}  include(\"\${CMAKE_CURRENT_LIST_DIR}/animeme-${name}.cmake\")\nendif()\n")
    get_property(headers GLOBAL PROPERTY ANIMEME_HEADERS_${name})
    string(APPEND animeme_table "set(animeme_headers_${name} ${headers})\n")
  endforeach()
  set(animeme_components ${components})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/packaging/animeme-config.cmake.in
    animeme-config.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/animeme)
  write_basic_package_version_file(animeme-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/animeme-config.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/animeme-config-version.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/animeme COMPONENT package)
  string(REPLACE ";" " " animeme_components "${components}")
  configure_file(${PROJECT_SOURCE_DIR}/tools/packaging/install_headers.cmake.in
    ${PROJECT_BINARY_DIR}/install_headers.cmake @ONLY)
endfunction()
