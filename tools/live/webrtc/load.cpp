#include "tools/live/webrtc/detail/load.h"

#include "tools/formats/common/module.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {
namespace {

Result<const Functions*> load_once() {
  const auto loaded = tools::load_functions<Functions>(tools::kWebrtcModule);
  if (!loaded) return loaded;
  const Functions* found = *loaded;
  const std::string missing = found->begin();
  if (!missing.empty()) return make_error(Code::unsupported, missing);
  return found;
}

}  // namespace

Result<const Functions*> functions() {
  static const Result<const Functions*> loaded = load_once();
  return loaded;
}

bool is_there() { return !tools::find_module(tools::kWebrtcModule).empty(); }

Result<void> load() {
  const Result<const Functions*> loaded = functions();
  if (!loaded) return loaded.error();
  return {};
}

}  // namespace animeme::webrtc
