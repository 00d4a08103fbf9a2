# Sets rig_module: rig.wasm, which moves the heads of the page. Made by clang with a C++ library for WebAssembly; or as
# another build has made it; or empty, for pages without heads.
set(ANIMEME_RIG_MODULE "" CACHE FILEPATH "rig.wasm of another build of this version, where no clang has WebAssembly")
if(ANIMEME_RIG_MODULE)
  set(rig_module ${ANIMEME_RIG_MODULE})
  return()
endif()

set(flags --target=wasm32-wasi -std=c++20 -Os -fno-exceptions -fno-rtti -fno-threadsafe-statics -mexec-model=reactor
  -Wl,--strip-all -Wl,-z,stack-size=262144 -Wl,--stack-first)

# ANIMEME_WASM_CXX: the command that makes WebAssembly. Debian's clang knows where its library is; elsewhere it often lies
# in a folder of its own.
if(NOT ANIMEME_WASM_CXX)
  find_program(clang NAMES clang++-14 clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++ NO_CACHE)
  find_path(sysroot include/wasm32-wasi/stdlib.h NO_CACHE NO_CMAKE_FIND_ROOT_PATH
    PATH_SUFFIXES share/wasi-sysroot PATHS /opt/wasi-sdk /opt/homebrew /usr/local)
  set(trial ${CMAKE_CURRENT_BINARY_DIR}/trial.cpp)
  file(CONFIGURE OUTPUT ${trial} CONTENT
    "#include <vector>\nstd::vector<int> all;\nextern \"C\" void add(int i) { all.push_back(i); }\n")
  foreach(compiler "${clang}" "${clang};--sysroot=${sysroot}")
    if(clang AND NOT ANIMEME_WASM_CXX)
      execute_process(COMMAND ${compiler} ${flags} -Wl,--export=add -o ${trial}.wasm ${trial}
        RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE why)
      if(NOT failed)
        set(ANIMEME_WASM_CXX "${compiler}" CACHE STRING "clang++ that makes WebAssembly, and its options")
      endif()
    endif()
  endforeach()
  if(NOT ANIMEME_WASM_CXX)
    message(WARNING "Pages will show no heads: clang has no C++ library for WebAssembly here. Debian: apt install clang-14 lld-14 "
      "wasi-libc libc++-14-dev-wasm32 libclang-rt-14-dev-wasm32 (tools/setup.sh does). Elsewhere: "
      "\"-DANIMEME_WASM_CXX=clang++;--sysroot=/opt/wasi-sdk/share/wasi-sysroot\", or -DANIMEME_RIG_MODULE=rig.wasm of another "
      "build of this version.\n${why}")
    set(rig_module ${CMAKE_CURRENT_BINARY_DIR}/no_rig.wasm)
    file(CONFIGURE OUTPUT ${rig_module} CONTENT "")
    return()
  endif()
endif()

# One unit: its parts share headers, and nothing but the page calls it.
set(names fap/arkit fap/arkit_table fap/arkit_thrift fap/bounded_fit fap/expand fap/shape_fit fap/tables fap/viseme fap/wider
  fap/head/model fap/head/pose fap/head/vector fap/head/detail/geodesic fap/head/detail/normals fap/head/detail/stops
  fap/head/detail/targets fap/head/detail/teeth fap/head/detail/whole tools/view/viewer/rig/unpack tools/view/viewer/rig/module)
set(unit "")
foreach(name IN LISTS names)
  string(APPEND unit "#include \"${name}.cpp\"\n")
endforeach()
set(rig_module ${CMAKE_CURRENT_BINARY_DIR}/rig.wasm)
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/rig.cpp CONTENT "${unit}")
add_custom_command(OUTPUT ${rig_module}
  COMMAND ${ANIMEME_WASM_CXX} ${flags} -I${animeme_SOURCE_DIR} -MD -MF ${rig_module}.d -MT ${rig_module} -o ${rig_module} rig.cpp
  DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/rig.cpp DEPFILE ${rig_module}.d VERBATIM COMMENT "The page's rig as WebAssembly")
