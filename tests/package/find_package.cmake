# Builds and runs programs of others that find COMPONENTS (by commas) of the installed animeme,
# without Eigen, and without the packages that HIDDEN names: these components do not need them.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
set(consumer ${configure} -S ${TESTS}/consumer -DCMAKE_PREFIX_PATH=${PREFIX}
  -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
string(REPLACE "," ";" hidden "${HIDDEN}")
foreach(package IN LISTS hidden)
  list(APPEND consumer -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
step("configure" ${consumer} -B ${WORK}/build -DCOMPONENTS=${COMPONENTS})
step("build" ${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
string(REPLACE "," ";" components "${COMPONENTS}")
foreach(component IN LISTS components)
  step("run ${component}" ${WORK}/build/${component}/use_${component})
endforeach()

message(STATUS "ask for an unknown component")
execute_process(COMMAND ${consumer} -B ${WORK}/unknown -DCOMPONENTS=nonsense
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(status EQUAL 0 OR NOT output MATCHES "no component nonsense")
  message(FATAL_ERROR "the message has to name the component (${status}): ${output}")
endif()
