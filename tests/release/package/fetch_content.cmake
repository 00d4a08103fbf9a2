# Builds, runs and installs a foreign project that fetches animeme, with Eigen hidden: only what its
# program needs is compiled, all of it by the compiler launcher that it chose, and only the program
# is installed.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(WRITE ${WORK}/launcher "#!/bin/sh\necho \"$*\" >>'${WORK}/log'\nexec ${LAUNCHER} \"$@\"\n")
file(CHMOD ${WORK}/launcher PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
list(APPEND configure -DCMAKE_CXX_COMPILER_LAUNCHER=${WORK}/launcher)
# As one unit a library: to compile fast, and because users may.
step("configure" ${configure} -S ${TESTS}/fetched -B ${WORK}/build
  -DANIMEME_DIR=${ANIMEME_DIR} -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0)
step("build" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)

file(STRINGS ${WORK}/log compiled REGEX " -c ")
set(objects)
foreach(command IN LISTS compiled)
  string(REGEX REPLACE "^.* -o ([^ ]*) .*$" "\\1" object "${command}")
  list(APPEND objects ${object})
endforeach()
set(expected
  "_deps/animeme-build/codec/|_deps/animeme-build/fap/CMakeFiles/animeme_fap|CMakeFiles/consumer.dir/")
set(others ${objects})
list(FILTER others EXCLUDE REGEX "^(${expected})")
list(LENGTH objects count)
if(others OR count LESS 3)
  message(FATAL_ERROR
    "compiled by the launcher, where fap, codec and the consumer were expected: ${objects}")
endif()

file(GLOB_RECURSE programs ${WORK}/build/consumer ${WORK}/build/*/consumer)
list(FILTER programs EXCLUDE REGEX "CMakeFiles")
list(LENGTH programs count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "expected one program, found: ${programs}")
endif()
step("run" ${programs})

step("install" ${CMAKE_COMMAND} --install ${WORK}/build --prefix ${WORK}/installed)
file(GLOB_RECURSE installed RELATIVE ${WORK}/installed ${WORK}/installed/*)
if(NOT installed STREQUAL "bin/consumer")
  message(FATAL_ERROR "installed, where bin/consumer was expected: ${installed}")
endif()
