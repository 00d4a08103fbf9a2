# Writes a header that names the sources of heads by a sum of them, and the compiler: heads that
# wait in a cache are those of this build.
#   cmake -DOUTPUT=head_build.h -DROOT=... -DCOMPILER=... "-DFILES=a;b" -P head_build.cmake
set(sums "${COMPILER}")
foreach(file ${FILES})
  file(SHA256 ${ROOT}/${file} sum)
  string(APPEND sums " ${sum}")
endforeach()
string(SHA256 sum "${sums}")
file(WRITE ${OUTPUT} "#pragma once\n#include <string_view>\nnamespace animeme::studio {\n"
  "inline constexpr std::string_view kHeadBuild = \"animeme head 1 ${sum}\";\n}\n")
