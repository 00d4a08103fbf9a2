# Builds and runs a foreign project that has animeme as a subdirectory, with Eigen hidden: only what
# its program needs is compiled, all of it by the compiler launcher that it chose.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
file(WRITE ${WORK}/launcher "#!/bin/sh\necho \"$*\" >>'${WORK}/log'\nexec ${LAUNCHER} \"$@\"\n")
file(CHMOD ${WORK}/launcher PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
list(APPEND configure -DCMAKE_CXX_COMPILER_LAUNCHER=${WORK}/launcher)
# As one unit a library: to compile fast, and because users may.
step("configure" ${configure} -S ${TESTS}/subdirectory -B ${WORK}/build
  -DANIMEME_DIR=${ANIMEME_DIR} -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0)
step("build" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)

file(STRINGS ${WORK}/log compiled REGEX " -c ")
set(objects)
foreach(command IN LISTS compiled)
  string(REGEX REPLACE "^.* -o ([^ ]*) .*$" "\\1" object "${command}")
  list(APPEND objects ${object})
endforeach()
set(expected "animeme/codec/|animeme/fap/CMakeFiles/animeme_fap|CMakeFiles/consumer.dir/")
set(others ${objects})
list(FILTER others EXCLUDE REGEX "^(${expected})")
list(LENGTH objects count)
if(others OR count LESS 3)
  message(FATAL_ERROR "compiled by the launcher, where fap, codec and the consumer were expected: ${objects}")
endif()

file(GLOB_RECURSE programs ${WORK}/build/consumer ${WORK}/build/*/consumer)
list(FILTER programs EXCLUDE REGEX "CMakeFiles")
list(LENGTH programs count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "expected one program, found: ${programs}")
endif()
step("run" ${programs})
