# Builds the codec as shared libraries, installs and moves them: each says its version in its name
# and finds the others where it lies, none shows what is internal, and a program of others runs with
# them.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
step("configure" ${configure} -S ${ANIMEME_DIR} -B ${WORK}/build -DBUILD_SHARED_LIBS=ON
  -DANIMEME_BUILD_DAM=OFF
  -DANIMEME_BUILD_TOOLS=OFF -DANIMEME_BUILD_C=OFF -DANIMEME_BUILD_TESTS=OFF
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16
  -DCMAKE_INSTALL_LIBDIR=lib)
step("build" ${CMAKE_COMMAND} --build ${WORK}/build --target animeme_fba --parallel 2)
foreach(component fap fba package)
  step("install ${component}" ${CMAKE_COMMAND} --install ${WORK}/build --prefix ${WORK}/made
    --component ${component})
endforeach()
file(RENAME ${WORK}/made ${WORK}/installed)

# Of a tree that is built in part, an installation has what is built, and says what is not.
step("install what is built" ${CMAKE_COMMAND} --install ${WORK}/build --prefix ${WORK}/part)
if(NOT output MATCHES "Not built, so not installed: library head"
  OR NOT EXISTS ${WORK}/part/lib/cmake/animeme/animeme-fba.cmake
    OR EXISTS ${WORK}/part/lib/cmake/animeme/animeme-head.cmake
    OR EXISTS ${WORK}/part/include/animeme/head)
  message(FATAL_ERROR "the library head was left out of the build:\n${output}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${WORK}/build --prefix ${WORK}/part
  --component head
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(status EQUAL 0 OR NOT output MATCHES "head is not built")
  message(FATAL_ERROR "a component that is not built was installed:\n${output}")
endif()

set(version "")
file(STRINGS ${ANIMEME_DIR}/CMakeLists.txt line REGEX "^project\\(animeme VERSION" LIMIT_COUNT 1)
string(REGEX MATCH "[0-9]+\\.[0-9]+" version "${line}")
foreach(library fap fba)
  set(file ${WORK}/installed/lib/libanimeme_${library}.so)
  step("look at ${library}" readelf -d ${file})
  if(NOT output MATCHES "SONAME[^\n]*libanimeme_${library}\\.so\\.${version}\\]")
    message(FATAL_ERROR "${file} has no version in its SONAME:\n${output}")
  endif()
  string(FIND "${output}" "path: [$ORIGIN" beside)
  string(FIND "${output}" "${WORK}" built)
  if(beside LESS 0 OR built GREATER_EQUAL 0)
    message(FATAL_ERROR
      "${file} does not find its neighbours, or finds them where it was built:\n${output}")
  endif()
endforeach()
step("names of fba" nm -DC --defined-only ${WORK}/installed/lib/libanimeme_fba.so)
string(REGEX MATCHALL "[^\n]*animeme::fba::internal::[^\n]*" names "${output}")
list(LENGTH names count)
if(count GREATER 0)
  message(FATAL_ERROR "${count} internal names are shown: ${names}")
endif()
if(NOT output MATCHES "animeme::fba::decode\\(")
  message(FATAL_ERROR "decode() is not shown")
endif()

file(WRITE ${WORK}/user/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES CXX)
find_package(animeme REQUIRED COMPONENTS fba)
add_executable(user ${TESTS}/consumer/fba.cpp)
target_link_libraries(user PRIVATE animeme::fba)
")
step("configure a user" ${configure} -S ${WORK}/user -B ${WORK}/user/build
  -DCMAKE_PREFIX_PATH=${WORK}/installed)
step("build a user" ${CMAKE_COMMAND} --build ${WORK}/user/build)
step("run a user" ${WORK}/user/build/user)
