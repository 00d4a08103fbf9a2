# One test of CTest a suite of GoogleTest: most tests take less time than their program to start.
#
# suites_of(TARGET PREFIX [FILTER] [CORE] [LABELS ...] [PROPERTIES ...]): FILTER as of
# --gtest_filter, either tests to run or, behind "-", tests to leave out. CORE is a filter, too:
# suites with a test that it matches get the label "core" (all of their tests run in the plain
# round). The suites are listed when the program has been linked. A suite that fails prints which of
# its tests did, one that skips some is passed, and tests/skipped.sh tells them.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(suites_script ${CMAKE_CURRENT_LIST_FILE})
  function(suites_of target prefix)
    cmake_parse_arguments(PARSE_ARGV 2 ARG "" "FILTER;CORE" "LABELS;PROPERTIES")
    string(MD5 key "${prefix}${ARG_FILTER}")
    string(SUBSTRING ${key} 0 6 key)
    set(file ${CMAKE_CURRENT_BINARY_DIR}/${target}_${key}_suites.cmake)
    add_custom_command(TARGET ${target} POST_BUILD
      COMMAND ${CMAKE_COMMAND} -D "program=$<TARGET_FILE:${target}>" -D "prefix=${prefix}" -D
      "filter=${ARG_FILTER}"
        -D "core=${ARG_CORE}" -D "labels=${ARG_LABELS}" -D "properties=${ARG_PROPERTIES}" -D
        "file=${file}" -P ${suites_script}
      VERBATIM)
    # Until it is built, the program itself is what fails.
    file(WRITE ${file}.missing.cmake
      "if(EXISTS \"${file}\")\n  include(\"${file}\")\nelse()\n  add_test(${prefix}NOT_BUILT ${target}_NOT_BUILT)\nendif()\n")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file}.missing.cmake)
  endfunction()
  return()
endif()

cmake_policy(VERSION 3.25)

# suites(FILTER RESULT): the suites with tests that a filter matches.
function(suites filter result)
  execute_process(COMMAND ${program} --gtest_list_tests --gtest_filter=${filter}
    OUTPUT_VARIABLE list RESULT_VARIABLE failed TIMEOUT 120)
  if(failed)
    message(FATAL_ERROR "${program} does not list its tests: ${failed}")
  endif()
  string(REGEX MATCHALL "[^\n]+" lines "${list}")
  set(found)
  foreach(line IN LISTS lines)
    # "Suite.", for suites of types or values with a comment behind it; tests are indented.
    if(line MATCHES "^([^ .]+)\\.( .*)?$")
      list(APPEND found ${CMAKE_MATCH_1})
    endif()
  endforeach()
  if(NOT found)
    message(FATAL_ERROR "${program} has no test for the filter ${filter}")
  endif()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

suites("${filter}" all)
set(core_suites)
if(core)
  suites("${core}" core_suites)
endif()
set(left_out)
if(filter MATCHES "^-")
  set(left_out ${filter})
endif()
set(text)
foreach(suite IN LISTS all)
  set(own ${labels})
  if(suite IN_LIST core_suites)
    list(APPEND own core)
  endif()
  string(APPEND text
    "add_test([=[${prefix}${suite}]=] [=[${program}]=] [=[--gtest_filter=${suite}.*${left_out}]=])\n"
    "set_tests_properties([=[${prefix}${suite}]=] PROPERTIES LABELS [=[${own}]=] ${properties})\n")
endforeach()
file(WRITE ${file} "${text}")
