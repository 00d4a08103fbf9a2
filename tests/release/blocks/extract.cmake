# extract_blocks(OUT): writes the fenced code blocks of all pages below PROJECT_SOURCE_DIR into OUT,
# one file each, and
# OUT/list.txt with a line "PAGE LANGUAGE N FILE" for each of them.
function(extract_blocks out)
  file(GLOB_RECURSE pages RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/fap/*.md
    ${PROJECT_SOURCE_DIR}/codec/*.md
    ${PROJECT_SOURCE_DIR}/dam/*.md ${PROJECT_SOURCE_DIR}/conformance/*.md
    ${PROJECT_SOURCE_DIR}/tools/*.md
    ${PROJECT_SOURCE_DIR}/tests/*.md)
  list(APPEND pages README.md HACKING.md)
  list(FILTER pages EXCLUDE REGEX "node_modules")
  list(SORT pages)
  set(list "")
  foreach(page IN LISTS pages)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${page})
    file(READ ${PROJECT_SOURCE_DIR}/${page} text)
    # Characters that CMake's lists give a meaning.
    string(REPLACE ";" "@semicolon@" text "${text}")
    string(REPLACE "[" "@open@" text "${text}")
    string(REPLACE "]" "@close@" text "${text}")
    string(REPLACE "\\" "@slash@" text "${text}")
    string(REPLACE "\n" ";" lines "${text}")
    string(MAKE_C_IDENTIFIER ${page} name)
    foreach(language cpp c js python cmake html)
      set(count_${language} 0)
    endforeach()
    set(language "")
    foreach(line IN LISTS lines)
      if(language STREQUAL "" AND line MATCHES "^```(cpp|c|js|python|cmake|html)$")
        set(language ${CMAKE_MATCH_1})
        math(EXPR count_${language} "${count_${language}} + 1")
        set(block "")
      elseif(NOT language STREQUAL "" AND line MATCHES "^```")
        set(file ${name}.${language}.${count_${language}}.inc)
        string(REPLACE "@slash@" "\\" block "${block}")
        string(REPLACE "@close@" "]" block "${block}")
        string(REPLACE "@open@" "[" block "${block}")
        string(REPLACE "@semicolon@" ";" block "${block}")
        file(CONFIGURE OUTPUT ${out}/${file} CONTENT "${block}" @ONLY)
        string(APPEND list "${page} ${language} ${count_${language}} ${file}\n")
        set(language "")
      elseif(NOT language STREQUAL "" AND NOT (language MATCHES "^c(pp)?$"
        AND line MATCHES "^#include"))
        string(APPEND block "${line}\n")
      endif()
    endforeach()
  endforeach()
  file(CONFIGURE OUTPUT ${out}/list.txt CONTENT "${list}" @ONLY)
endfunction()
