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
  list(FILTER headers EXCLUDE REGEX "/(detail|kinds|maths|rig)/|_internal\\.h$")
  if(folder STREQUAL "fap")
    list(FILTER headers EXCLUDE REGEX "^fap/(head|xml)/")
  endif()
  list(SORT headers)
  set(${result} ${headers} PARENT_SCOPE)
endfunction()

# animeme_install_if_built(NAME component FILE): `cmake --install` leaves out the rest of the rules
# of this folder unless
# FILE is there, and says so at the end. A component that is asked for by its name has to be there.
function(animeme_install_if_built name component file)
  install(CODE "if(NOT EXISTS \"${file}\")
  if(CMAKE_INSTALL_COMPONENT)
    message(FATAL_ERROR \"${name} is not built: run cmake --build ${PROJECT_BINARY_DIR} first\")
  endif()
  list(APPEND animeme_not_built \"${name}\")
  return()
endif()" COMPONENT ${component})
endfunction()

# animeme_library(NAME folder FILES...): a library with alias animeme::NAME, exported as component
# NAME of the package, with the public headers of the folder ("": it has none).
function(animeme_library name folder)
  add_library(animeme_${name} ${ARGN})
  add_library(animeme::${name} ALIAS animeme_${name})
  target_include_directories(animeme_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(animeme_${name} PUBLIC cxx_std_20)
  target_link_libraries(animeme_${name} PRIVATE $<BUILD_INTERFACE:animeme_build>)
  # C++ interfaces change with every minor version, as the CMake package says, too
  # (SameMinorVersion).
  set_target_properties(animeme_${name} PROPERTIES EXPORT_NAME ${name} VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  animeme_install_if_built("library ${name}" ${name} $<TARGET_FILE:animeme_${name}>)
  install(TARGETS animeme_${name} EXPORT animeme_${name} COMPONENT ${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT animeme_${name} NAMESPACE animeme:: FILE animeme-${name}.cmake COMPONENT ${name}
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/animeme)
  set_property(GLOBAL APPEND PROPERTY ANIMEME_COMPONENTS ${name})

  set(headers "")
  if(folder)
    animeme_public_headers(${folder} headers)
  endif()
  set_property(GLOBAL PROPERTY ANIMEME_HEADERS_${name} "${headers}")
  install(CODE "include(\"${PROJECT_BINARY_DIR}/install_headers.cmake\")
animeme_install_headers(${name} \"${CMAKE_INSTALL_INCLUDEDIR}\" \"${PROJECT_BINARY_DIR}/public\")" COMPONENT ${name})
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

# animeme_requires(NAME [COMPONENTS names...] [PACKAGES names...] [MODULES lines...] [LIBRARIES
# names...]): what has to be found before component NAME is: other components, all of them; packages
# of CMake; modules of pkg-config, a line each: the prefix of their target, then their names;
# libraries that are linked by name.
function(animeme_requires name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "COMPONENTS;PACKAGES;MODULES;LIBRARIES")
  set_property(GLOBAL APPEND PROPERTY ANIMEME_BELOW_${name} ${arg_COMPONENTS})
  foreach(kind PACKAGES MODULES LIBRARIES)
    set_property(GLOBAL APPEND PROPERTY ANIMEME_${kind}_${name} ${arg_${kind}})
  endforeach()
endfunction()

# Installs the CMake package once all libraries are known.
function(animeme_install_package)
  include(CMakePackageConfigHelpers)
  get_property(animeme_components GLOBAL PROPERTY ANIMEME_COMPONENTS)
  set(animeme_table "")
  foreach(name IN LISTS animeme_components)
    foreach(kind below packages modules libraries)
      string(TOUPPER ${kind} property)
      get_property(needed GLOBAL PROPERTY ANIMEME_${property}_${name})
      if(needed)
        string(APPEND animeme_table "set(animeme_${kind}_${name} \"${needed}\")\n")
      endif()
    endforeach()
  endforeach()
  configure_package_config_file(${PROJECT_SOURCE_DIR}/tools/release/packaging/animeme-config.cmake.in
    animeme-config.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/animeme)
  write_basic_package_version_file(animeme-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/animeme-config.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/animeme-config-version.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/animeme COMPONENT package)

  set(animeme_table "")
  foreach(name IN LISTS animeme_components)
    get_property(headers GLOBAL PROPERTY ANIMEME_HEADERS_${name})
    string(APPEND animeme_table "set(animeme_headers_${name} ${headers})\n")
  endforeach()
  string(REPLACE ";" " " animeme_components "${animeme_components}")
  configure_file(${PROJECT_SOURCE_DIR}/tools/release/packaging/install_headers.cmake.in
    ${PROJECT_BINARY_DIR}/install_headers.cmake @ONLY)

  # The last rule: what the rules above left out.
  install(CODE "if(\"\${animeme_not_built}\" MATCHES \"^library fap;\")
  message(FATAL_ERROR \"Nothing is built yet: run cmake --build ${PROJECT_BINARY_DIR} first\")
elseif(animeme_not_built)
  list(JOIN animeme_not_built \", \" animeme_not_built)
  message(STATUS \"Not built, so not installed: \${animeme_not_built} (cmake --build ${PROJECT_BINARY_DIR} builds all)\")
endif()")
endfunction()
