# The manual as HTML: cmake --build build/release --target docs, then build/release/docs/index.html.
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
  message(STATUS "Manual: off (doxygen is missing)")
  return()
endif()

set(DOXYGEN_HTML_OUTPUT docs)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE ${PROJECT_SOURCE_DIR}/README.md)
set(DOXYGEN_STRIP_FROM_PATH ${PROJECT_SOURCE_DIR})
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_IMAGE_PATH tools/pictures)
set(DOXYGEN_FILE_PATTERNS *.h *.md)
# What is not installed, and what is data.
set(DOXYGEN_EXCLUDE_PATTERNS */detail/*.h */maths/*.h */kinds/*.h *_internal.h */conformance/cases/*)
# Operators say all by their names.
set(DOXYGEN_EXCLUDE_SYMBOLS *operator*)
set(DOXYGEN_DISTRIBUTE_GROUP_DOC YES)
# A public thing without a word about it fails the target.
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
set(DOXYGEN_QUIET YES)
set(DOXYGEN_HAVE_DOT NO)
set(DOXYGEN_VERBATIM_HEADERS NO)
doxygen_add_docs(docs README.md HACKING.md fap codec dam conformance tools
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} COMMENT "Manual")
