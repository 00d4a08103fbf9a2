# Helpers of the package tests. Every step that fails ends the test with its output.
# Given by -D: CXX (compiler), LAUNCHER (compiler launcher or empty), GENERATOR, WORK (a folder of
# this test alone), PREFIX (where animeme is installed), BINARY_DIR and ANIMEME_DIR (its build and
# source trees), TESTS (this folder).
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

function(step title)
  message(STATUS "${title}")
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${title} failed (${status}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

set(configure ${CMAKE_COMMAND} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX}
  -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_FLAGS=-O0)  # to compile fast
if(LAUNCHER)
  list(APPEND configure -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})
endif()
