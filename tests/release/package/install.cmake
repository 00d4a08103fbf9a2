# Installs the build tree and moves it: the package has to work where it is found, not where it was
# made.
include(${CMAKE_CURRENT_LIST_DIR}/steps.cmake)
step("install" ${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${WORK}/made)
if(output MATCHES "Warning|Not built")
  message(FATAL_ERROR "all is built, and installed without a warning:\n${output}")
endif()
# Names of components are no names of variables.
foreach(component fba text)
  step("install ${component}" ${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${WORK}/parts
    --component ${component})
  if(output MATCHES "Warning")
    message(FATAL_ERROR "component ${component}:\n${output}")
  endif()
endforeach()
file(REMOVE_RECURSE ${PREFIX})
file(RENAME ${WORK}/made ${PREFIX})

file(GLOB_RECURSE headers RELATIVE ${PREFIX}/include ${PREFIX}/include/*.h)
list(LENGTH headers count)
list(FILTER headers INCLUDE REGEX "_internal\\.h$|/detail/|/kinds/|/maths/")
if(headers OR count EQUAL 0)
  message(FATAL_ERROR "${count} headers, internal ones among them: ${headers}")
endif()

# What is found is found on the machine of the user: no folder of this one. "/../" leads up from
# where a file lies.
file(GLOB_RECURSE files ${PREFIX}/*.cmake)
foreach(file IN LISTS files)
  file(STRINGS ${file} lines REGEX "(^|[^A-Za-z0-9_.}/>])/[A-Za-z]")
  list(FILTER lines EXCLUDE REGEX "^ *#")
  if(lines)
    message(FATAL_ERROR "${file} has paths of this machine: ${lines}")
  endif()
endforeach()

# Whatever is exported has a consumer.
file(GLOB_RECURSE exports ${PREFIX}/animeme-*.cmake)
list(FILTER exports INCLUDE REGEX "/animeme-[a-z_]+\\.cmake$")
list(FILTER exports EXCLUDE REGEX "/animeme-config\\.cmake$")
foreach(file IN LISTS exports)
  string(REGEX REPLACE ".*/animeme-([a-z_]+)\\.cmake$" "\\1" component ${file})
  if(NOT component STREQUAL "common" AND NOT EXISTS ${TESTS}/consumer/${component}.cpp)
    message(FATAL_ERROR "nobody uses the component ${component}: write consumer/${component}.cpp")
  endif()
endforeach()
