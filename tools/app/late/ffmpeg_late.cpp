#include <cstdio>
#include <cstdlib>

#include "tools/formats/common/exit_code.h"
#include "tools/formats/common/module.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg_functions.h"

namespace animeme::media::av {
namespace {

const Functions& load() {
  const auto loaded = tools::load_functions<Functions>(tools::kFfmpegModule);
  if (loaded) return **loaded;
  // The calls of FFmpeg are too many to have an error each for what no input brings about.
  std::fprintf(stderr, "animeme: %s\n", loaded.error().message.c_str());
  std::_Exit(int(tools::kInternal));
}

}  // namespace

const Functions& functions() {
  static const Functions& table = load();
  return table;
}

}  // namespace animeme::media::av
