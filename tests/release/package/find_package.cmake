# Builds and runs programs of others that find COMPONENTS (by commas) of the installed animeme, each
# without the packages that it does not need.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
step("configure" ${configure} -S ${TESTS}/consumer -B ${WORK}/build -DCMAKE_PREFIX_PATH=${PREFIX}
  -DCOMPONENTS=${COMPONENTS})
step("build" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
string(REPLACE "," ";" components "${COMPONENTS}")
foreach(component IN LISTS components)
  step("run ${component}" ${WORK}/build/${component}/use_${component})
endforeach()
