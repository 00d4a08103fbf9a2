# Writes the SPDX 2.3 document OUTPUT of PACKAGE: what the files LINKED and LOADED (by commas) need,
# as their tables of dynamic linking say, and CONTAINS, whose headers became part of them. Licences:
# libraries.tsv.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/libraries.cmake)
animeme_libraries(rows)

# The licence of FFmpeg is how it was configured: its library says so itself.
function(ffmpeg_licence object result)
  set(${result} NOASSERTION PARENT_SCOPE)
  set(path ${below})
  list(FILTER path INCLUDE REGEX "/${object}$")
  if(NOT path)
    return()
  endif()
  file(STRINGS "${path}" said REGEX "^lib[a-z]+ license: " LIMIT_COUNT 1)
  string(REGEX REPLACE "^lib[a-z]+ license: " "" said "${said}")
  foreach(row IN LISTS rows)
    string(REPLACE "|" ";" cells "${row}")
    list(GET cells 0 words)
    list(GET cells 1 mark)
    list(GET cells 2 licence)
    if(mark STREQUAL "?" AND words STREQUAL said)
      set(${result} ${licence} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# add(ROW OBJECT RELATIONSHIP): a package of the document. %1 is its id, %2 that of ours.
macro(add row object relationship)
  string(REPLACE "|" ";" cells "${row}")
  list(GET cells 0 name)
  list(GET cells 2 licence)
  list(GET cells 3 version)
  if(licence STREQUAL "FFmpeg")
    ffmpeg_licence("${object}" licence)
  endif()
  string(REGEX REPLACE "[^A-Za-z0-9.]+" "-" id "SPDXRef-${name}")
  string(REGEX REPLACE "-+$" "" id "${id}")
  if(NOT id IN_LIST ids)
    list(APPEND ids ${id})
    if(NOT licence IN_LIST licences)
      list(APPEND licences "${licence}")
    endif()
    string(APPEND text "\nPackageName: ${name}\nSPDXID: ${id}\n")
    if(NOT version STREQUAL "")
      string(APPEND text "PackageVersion: ${version}\n")
    endif()
    if(NOT "${object}" STREQUAL "")
      string(APPEND text "PackageFileName: ${object}\n")
    endif()
    string(APPEND text "PackageDownloadLocation: NOASSERTION\nFilesAnalyzed: false\n"
      "PackageLicenseConcluded: ${licence}\nPackageLicenseDeclared: ${licence}\nPackageCopyrightText: NOASSERTION\n")
    set(said "${relationship}")
    string(REPLACE "%1" "${id}" said "${said}")
    string(REPLACE "%2" "SPDXRef-${PACKAGE}" said "${said}")
    string(APPEND relationships "Relationship: ${said}\n")
  endif()
endmacro()

# The row of a shared object, or one that says nothing of it.
function(row_of object result)
  set(${result} "${object}|${object}|NOASSERTION|||" PARENT_SCOPE)
  foreach(row IN LISTS rows)
    string(REGEX REPLACE "^[^|]*\\|([^|]*)\\|.*" "\\1" stem "${row}")
    string(FIND "${object}" "${stem}." at)
    string(FIND "${object}" "${stem}-" at_dash)
    if(at EQUAL 0 OR at_dash EQUAL 0)
      set(${result} "${row}" PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

set(ids "")
set(licences MIT CC-BY-4.0)
set(text "")
set(relationships "Relationship: SPDXRef-DOCUMENT DESCRIBES SPDXRef-${PACKAGE}\n")
foreach(kind LINKED LOADED CONTAINS)
  string(REPLACE "," ";" ${kind} "${${kind}}")
endforeach()
foreach(kind LINKED LOADED)
  set(relationship "%2 DYNAMIC_LINK %1")
  if(kind STREQUAL "LOADED")
    set(relationship "%1 OPTIONAL_DEPENDENCY_OF %2")
  endif()
  foreach(file IN LISTS ${kind})
    execute_process(COMMAND ${READELF} -d ${file} OUTPUT_VARIABLE needed COMMAND_ERROR_IS_FATAL ANY)
    string(REPLACE "[" "<" needed "${needed}")  # an open bracket keeps lists together
    string(REGEX MATCHALL "\\(NEEDED\\)[^\n]*<[^]\n]*" needed "${needed}")
    file(GET_RUNTIME_DEPENDENCIES LIBRARIES ${file} RESOLVED_DEPENDENCIES_VAR below
      UNRESOLVED_DEPENDENCIES_VAR absent)
    foreach(line IN LISTS needed)
      string(REGEX REPLACE ".*<" "" object "${line}")
      row_of(${object} row)
      add("${row}" "${object}" "${relationship}")
    endforeach()
    # What these bring with them, where the table tells who does.
    foreach(path IN LISTS below)
      get_filename_component(object ${path} NAME)
      row_of(${object} row)
      if(row MATCHES "\\|[^|]+$")
        add("${row}" "${object}" "%1 RUNTIME_DEPENDENCY_OF %2")
      endif()
    endforeach()
  endforeach()
endforeach()
foreach(name IN LISTS CONTAINS)
  foreach(row IN LISTS rows)
    string(FIND "${row}" "${name}|-|" at)
    if(at EQUAL 0)
      add("${row}" "" "%2 CONTAINS %1")
    endif()
  endforeach()
endforeach()

list(TRANSFORM licences REPLACE "(.* OR .*|.* AND .*)" "(\\1)")
list(JOIN licences " AND " concluded)
string(TIMESTAMP created "%Y-%m-%dT%H:%M:%SZ" UTC)  # that of SOURCE_DATE_EPOCH if it is set
string(SHA256 digest "${VERSION}${text}${relationships}")
string(SUBSTRING ${digest} 0 32 digest)
set(extracted "")
if("LicenseRef-nonfree" IN_LIST licences)
  set(extracted "\nLicenseID: LicenseRef-nonfree\n")
  string(APPEND extracted
    "ExtractedText: <text>FFmpeg with --enable-nonfree: not to be passed on.</text>\n")
endif()
file(WRITE ${OUTPUT} "SPDXVersion: SPDX-2.3
DataLicense: CC0-1.0
SPDXID: SPDXRef-DOCUMENT
DocumentName: ${PACKAGE}-${VERSION}
DocumentNamespace: urn:animeme:spdx:${PACKAGE}-${VERSION}-${digest}
Creator: Organization: The Animeme authors
Created: ${created}

PackageName: ${PACKAGE}
SPDXID: SPDXRef-${PACKAGE}
PackageVersion: ${VERSION}
PackageDownloadLocation: NOASSERTION
FilesAnalyzed: false
PackageLicenseConcluded: ${concluded}
PackageLicenseDeclared: MIT AND CC-BY-4.0
PackageLicenseComments: <text>The sources are under MIT, the built-in model (from the GRID corpus) under CC-BY-4.0.
What is built falls under the licences of all that it is linked with.</text>
PackageCopyrightText: <text>Copyright (c) 2026 The Animeme authors</text>
${text}
${relationships}${extracted}")
