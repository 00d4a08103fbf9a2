# Toolchain of preset "wasm": Emscripten, programs under node with the files of the machine.
find_program(ANIMEME_EM_CONFIG em-config)
if(NOT ANIMEME_EM_CONFIG)
  message(FATAL_ERROR "em-config is missing (Debian: emscripten)")
endif()
execute_process(COMMAND ${ANIMEME_EM_CONFIG} EMSCRIPTEN_ROOT OUTPUT_VARIABLE root
  OUTPUT_STRIP_TRAILING_WHITESPACE)
include(${root}/cmake/Modules/Platform/Emscripten.cmake)

# What runs out of memory ends as an error, for which C++ has exceptions.
set(CMAKE_CXX_FLAGS_INIT -fexceptions)
# Linked briefly (-O1): the compiler has optimised, and the optimiser of JavaScript takes modules of
# node that not every
# node finds. The module is read at once: Emscripten 3.1 would ask the fetch() of newer nodes for
# it, which knows no files.
set(CMAKE_EXE_LINKER_FLAGS_INIT
  "-O1 -fexceptions -sNODERAWFS=1 -sWASM_ASYNC_COMPILATION=0 -sALLOW_MEMORY_GROWTH=1 -sEXIT_RUNTIME=1")
