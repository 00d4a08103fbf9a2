// FFmpeg linked like any library: for users of animeme::media, and for the tests. The program has
// tools/app/late/ffmpeg_late.cpp instead.
#include "tools/formats/media/detail/ffmpeg/ffmpeg_functions.h"

namespace animeme::media::av {

const Functions& functions() {
  static const Functions table = linked_functions();
  return table;
}

}  // namespace animeme::media::av
