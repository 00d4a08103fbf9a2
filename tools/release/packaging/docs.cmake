# cmake --build build/release --target docs: with Doxygen, mkdocs and its theme Material the site
# (tools/release/site), start at build/release/site/index.html; with Doxygen alone its own manual of
# headers and pages, build/release/docs/index.html.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  message(STATUS "Manual: off (doxygen is missing)")
  return()
endif()
find_program(ANIMEME_MKDOCS mkdocs)
# That of Debian, which has its packages; another may come first in PATH.
find_program(ANIMEME_DEBIAN_PYTHON3 python3 PATHS /usr/bin NO_DEFAULT_PATH)
set(no_theme 1)
if(ANIMEME_MKDOCS AND ANIMEME_DEBIAN_PYTHON3 AND TARGET animeme AND NOT CMAKE_CROSSCOMPILING)
  execute_process(COMMAND ${ANIMEME_DEBIAN_PYTHON3}
    -c "from mkdocs import utils; utils.get_theme_dir('material')"
    RESULT_VARIABLE no_theme OUTPUT_QUIET ERROR_QUIET)
endif()

set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
# What is not installed, and what is data.
set(DOXYGEN_EXCLUDE_PATTERNS */detail/*.h */maths/*.h */kinds/*.h */rig/*.h */app/late/*.h
  *_internal.h */conformance/cases/*)
# Operators say all by their names.
set(DOXYGEN_EXCLUDE_SYMBOLS *operator*)
set(DOXYGEN_DISTRIBUTE_GROUP_DOC YES)
# A public thing without a word about it fails the target.
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_VERBATIM_HEADERS NO)
if(no_theme)
  message(STATUS "Site: off (mkdocs or mkdocs-material is missing)")
  set(DOXYGEN_HTML_OUTPUT docs)
  set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/README.md)
  set(DOXYGEN_IMAGE_PATH tools/release/pictures)
  set(DOXYGEN_FILE_PATTERNS *.h *.md)
  doxygen_add_docs(docs README.md HACKING.md fap codec dam conformance tools
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Manual")
  return()
endif()

set(DOXYGEN_GENERATE_HTML NO)
set(DOXYGEN_GENERATE_XML YES)
set(DOXYGEN_XML_PROGRAMLISTING NO)
set(DOXYGEN_FILE_PATTERNS *.h)
doxygen_add_docs(docs_headers fap codec dam conformance tools
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "What headers say")
# Under which name others include a header.
get_property(components GLOBAL PROPERTY ANIMEME_COMPONENTS)
set(table "c|tools/bindings/c/animeme.h\n")
foreach(component IN LISTS components)
  get_property(headers GLOBAL PROPERTY ANIMEME_HEADERS_${component})
  list(TRANSFORM headers PREPEND "${component}|")
  list(JOIN headers "\n" headers)
  string(APPEND table "${headers}\n")
endforeach()
file(WRITE ${PROJECT_BINARY_DIR}/pages/headers.txt "${table}")
add_custom_target(docs COMMENT "Site" VERBATIM USES_TERMINAL
  COMMAND ${ANIMEME_DEBIAN_PYTHON3} -B ${PROJECT_SOURCE_DIR}/tools/release/site/make.py
  ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}
    $<TARGET_FILE:animeme>)
add_dependencies(docs docs_headers animeme)
