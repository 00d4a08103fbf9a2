# Every source file is as clang-format leaves it: cmake -DTOOL=clang-format -DSOURCE=dir -P this.
file(GLOB_RECURSE files ${SOURCE}/fap/*.h ${SOURCE}/fap/*.cpp ${SOURCE}/codec/*.h
  ${SOURCE}/codec/*.cpp
  ${SOURCE}/dam/*.h ${SOURCE}/dam/*.hpp ${SOURCE}/dam/*.cpp ${SOURCE}/tools/*.h
  ${SOURCE}/tools/*.cpp
  ${SOURCE}/conformance/*.h ${SOURCE}/conformance/*.cpp ${SOURCE}/tests/*.h ${SOURCE}/tests/*.cpp)
execute_process(COMMAND ${TOOL} --dry-run --Werror ${files} RESULT_VARIABLE result
  ERROR_VARIABLE said)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "run ${TOOL} -i on these files\n${said}")
endif()
