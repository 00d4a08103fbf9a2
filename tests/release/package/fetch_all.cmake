# A foreign project that fetches all of animeme: it knows COMPONENTS (by commas) and their headers,
# and builds none of them by itself. With -DLINK=ON its programs are built and run, too, which
# compiles all of animeme once more:
# tests/run.sh elsewhere.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
step("configure" ${configure} -S ${TESTS}/fetched_all -B ${WORK}/build -DANIMEME_DIR=${ANIMEME_DIR}
  -DCOMPONENTS=${COMPONENTS})
step("build" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
file(GLOB_RECURSE objects ${WORK}/build/CMakeFiles/headers.dir/*.o)
if(NOT objects)
  message(FATAL_ERROR "the headers were not compiled")
endif()
file(GLOB_RECURSE libraries ${WORK}/build/*.a)
if(libraries)
  message(FATAL_ERROR "nobody asked for ${libraries}")
endif()
if(LINK)
  string(REPLACE "," ";" components "${COMPONENTS}")
  list(TRANSFORM components PREPEND use_ OUTPUT_VARIABLE programs)
  step("link" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2 --target ${programs})
  foreach(program IN LISTS programs)
    file(GLOB_RECURSE found ${WORK}/build/${program})
    list(FILTER found EXCLUDE REGEX "CMakeFiles")
    step("run ${program}" ${found})
  endforeach()
endif()
