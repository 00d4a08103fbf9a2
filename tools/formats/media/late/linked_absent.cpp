// FFmpeg with the first call of it: what the program has instead of linked.cpp. Linked before the
// library, it is what the linker takes.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "tools/formats/common/exit_code.h"
#include "tools/formats/common/module.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg_functions.h"

namespace animeme::media::av {
namespace {

const Functions& load() {
  std::string problem;
  if (void* module = tools::load_module("animeme_ffmpeg.so", ANIMEME_MODULE_FOLDER,
                                        RTLD_NOW | RTLD_LOCAL, problem)) {
    if (const auto entry = reinterpret_cast<ModuleEntry>(dlsym(module, kModuleEntry))) {
      return *entry();
    }
    problem = "animeme_ffmpeg.so is not of this version";
  }
  // Nothing that a caller could do about it, and no input that brings it about.
  std::fprintf(
      stderr,
      "animeme: what reads and writes sound and video does not load: %s; if a library is "
      "missing, install FFmpeg (Debian: libavformat59 libswscale6); animeme_ffmpeg.so itself "
      "belongs next to the program, or into " ANIMEME_MODULE_FOLDER " from there\n",
      problem.c_str());
  std::_Exit(int(tools::kInternal));
}

}  // namespace

const Functions& functions() {
  static const Functions& table = load();
  return table;
}

}  // namespace animeme::media::av
