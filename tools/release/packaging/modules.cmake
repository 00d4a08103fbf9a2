# Modules: shared objects that the program loads on first use of what they are linked with
# (tools/app/late/README.md).

# What everybody needs who includes tools/formats/common/module.h.
file(RELATIVE_PATH ANIMEME_MODULE_FOLDER ${CMAKE_INSTALL_FULL_BINDIR}
  ${CMAKE_INSTALL_FULL_LIBDIR}/animeme)
add_library(animeme_modules INTERFACE)
target_compile_definitions(animeme_modules
  INTERFACE ANIMEME_MODULE_FOLDER="${ANIMEME_MODULE_FOLDER}"
  ANIMEME_VERSION="${PROJECT_VERSION}")
target_link_libraries(animeme_modules INTERFACE ${CMAKE_DL_LIBS})

# animeme_module(NAME SOURCES files... LIBRARIES targets...): animeme_NAME.so, as target
# animeme_NAME_module.
function(animeme_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES")
  set(module animeme_${name}_module)
  add_library(${module} MODULE ${arg_SOURCES})
  set_target_properties(${module} PROPERTIES PREFIX "" OUTPUT_NAME animeme_${name}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  target_include_directories(${module} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${module} PRIVATE animeme_build animeme_modules ${arg_LIBRARIES})
  animeme_compile_briefly(${module})
  install(TARGETS ${module} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/animeme COMPONENT program
    OPTIONAL)
  set_property(GLOBAL APPEND PROPERTY ANIMEME_MODULES ${module})
endfunction()

# animeme_late_objects(LIBRARY files...): those files of a library that call what the program loads
# late, as target animeme_LIBRARY_late: the same objects become part of the library and of the
# module.
function(animeme_late_objects library)
  set(objects animeme_${library}_late)
  add_library(${objects} OBJECT ${ARGN})
  set_target_properties(${objects} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(NOT BUILD_SHARED_LIBS)
    set_target_properties(${objects} PROPERTIES CXX_VISIBILITY_PRESET hidden
      VISIBILITY_INLINES_HIDDEN ON)
  endif()
  target_include_directories(${objects} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${objects} PRIVATE animeme_build)
  animeme_compile_briefly(${objects})
  target_sources(animeme_${library} PRIVATE $<TARGET_OBJECTS:${objects}>)
endfunction()
