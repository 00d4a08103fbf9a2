#include "tools/live/webrtc/detail/load.h"

#include <dlfcn.h>

#include "tools/formats/common/module.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {
namespace {

constexpr const char* kModule = "animeme_webrtc.so";

Result<const Functions*> load_once() {
  std::string problem;
  void* module = tools::load_module(kModule, ANIMEME_MODULE_FOLDER, RTLD_NOW, problem);
  void* entry = module == nullptr ? nullptr : dlsym(module, "animeme_webrtc_functions");
  if (entry == nullptr) {
    return make_error(Code::unsupported, "WebRTC is not there (" + problem +
                                             "); install GStreamer (Debian: "
                                             "libgstreamer-plugins-bad1.0-dev) and build again");
  }
  const Functions* found = reinterpret_cast<const Functions* (*)()>(entry)();
  const std::string missing = found->begin();
  if (!missing.empty()) return make_error(Code::unsupported, missing);
  return found;
}

}  // namespace

Result<const Functions*> functions() {
  static const Result<const Functions*> loaded = load_once();
  return loaded;
}

bool is_there() {
  std::error_code ignored;
  const std::filesystem::path folder =
      std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  return std::filesystem::exists(folder / kModule, ignored) ||
         std::filesystem::exists(folder / ANIMEME_MODULE_FOLDER / kModule, ignored);
}

Result<void> load() {
  const Result<const Functions*> loaded = functions();
  if (!loaded) return loaded.error();
  return {};
}

}  // namespace animeme::webrtc
