// FFmpeg with the first call of it: what the program has instead of linked.cpp. Linked before the
// library, it is what the linker takes.
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string>

#include "tools/exit_code.h"
#include "tools/media/detail/ffmpeg_functions.h"

namespace animeme::media::av {
namespace {

// Beside the program in the build tree, else where it was installed to; both may have been moved.
const Functions& load() {
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  std::string problem;
  for (const char* place : {"animeme_ffmpeg.so", ANIMEME_MODULE_FOLDER "/animeme_ffmpeg.so"}) {
    const std::string path = (folder / place).string();
    void* module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) {
      if (std::filesystem::exists(path, ignored) || problem.empty()) problem = dlerror();
      continue;
    }
    if (const auto entry = reinterpret_cast<ModuleEntry>(dlsym(module, kModuleEntry))) {
      return *entry();
    }
    problem = path + " is not of this version";
  }
  // Nothing that a caller could do about it, and no input that brings it about.
  std::fprintf(stderr,
               "animeme: what reads and writes sound and video does not load: %s; it belongs "
               "beside the program, or into " ANIMEME_MODULE_FOLDER " from there: install again\n",
               problem.c_str());
  std::_Exit(int(tools::kInternal));
}

}  // namespace

const Functions& functions() {
  static const Functions& table = load();
  return table;
}

}  // namespace animeme::media::av
