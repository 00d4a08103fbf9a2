# Builds and installs animeme into a prefix of its own, then builds and runs a foreign project that
# finds it there. COMPONENT is fba or dam; Eigen is hidden from the consumer in both cases, and
# from animeme itself for fba.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
set(no_eigen -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
if(COMPONENT STREQUAL "dam")
  set(parts -DANIMEME_BUILD_DAM=ON)
else()
  set(parts -DANIMEME_BUILD_DAM=OFF ${no_eigen})
endif()

step("configure animeme" ${configure} -S ${ANIMEME_DIR} -B ${WORK}/animeme ${parts}
  -DANIMEME_BUILD_TOOLS=OFF -DANIMEME_BUILD_TESTS=OFF)
step("build animeme" ${CMAKE_COMMAND} --build ${WORK}/animeme --parallel 2)
step("install animeme" ${CMAKE_COMMAND} --install ${WORK}/animeme --prefix ${WORK}/prefix)
# The package has to work where it is found, not where it was made.
file(RENAME ${WORK}/prefix ${WORK}/moved)
file(REMOVE_RECURSE ${WORK}/animeme)

file(GLOB_RECURSE leaked RELATIVE ${WORK}/moved ${WORK}/moved/include/*_internal.h
  ${WORK}/moved/include/*/detail/*.h)
if(leaked)
  message(FATAL_ERROR "internal headers are installed: ${leaked}")
endif()

set(consumer ${configure} -S ${TESTS}/consumer -DCMAKE_PREFIX_PATH=${WORK}/moved ${no_eigen})
step("configure the consumer" ${consumer} -B ${WORK}/consumer -DCOMPONENT=${COMPONENT})
step("build the consumer" ${CMAKE_COMMAND} --build ${WORK}/consumer)
step("run the consumer" ${WORK}/consumer/consumer)
if(NOT output MATCHES "${COMPONENT} consumer ok")
  message(FATAL_ERROR "the consumer said: ${output}")
endif()

step_that_fails("ask for an unknown component" ${consumer} -B ${WORK}/unknown -DCOMPONENT=nonsense)
if(NOT output MATCHES "nonsense")
  message(FATAL_ERROR "the message does not name the component: ${output}")
endif()
if(COMPONENT STREQUAL "fba")
  step_that_fails("ask for a part that was not built" ${consumer} -B ${WORK}/absent -DCOMPONENT=dam)
endif()
message(STATUS "ok")
