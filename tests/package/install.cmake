# Installs the build tree and moves it: the package has to work where it is found, not where it was
# made.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
step("install" ${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${WORK}/made)
file(REMOVE_RECURSE ${PREFIX})
file(RENAME ${WORK}/made ${PREFIX})

file(GLOB_RECURSE headers RELATIVE ${PREFIX}/include ${PREFIX}/include/*.h)
list(LENGTH headers count)
list(FILTER headers INCLUDE REGEX "_internal\\.h$|/detail/|/kinds/|/maths/")
if(headers OR count EQUAL 0)
  message(FATAL_ERROR "${count} headers, internal ones among them: ${headers}")
endif()

# Whatever is exported has a consumer.
file(GLOB_RECURSE targets ${PREFIX}/animemeTargets.cmake)
file(STRINGS ${targets} lines REGEX "^add_library\\(animeme::")
foreach(line IN LISTS lines)
  string(REGEX REPLACE "^add_library\\(animeme::([a-z_]+) .*" "\\1" component "${line}")
  if(NOT EXISTS ${TESTS}/consumer/${component}.cpp)
    message(FATAL_ERROR "nobody uses the component ${component}: write consumer/${component}.cpp")
  endif()
endforeach()
