# A foreign project that fetches all of animeme: it knows COMPONENTS (by commas) and their headers, and builds none of
# them by itself.
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
