// FFmpeg as every library is linked: for users of animeme::media, and for the tests.
#include "tools/formats/media/detail/ffmpeg/ffmpeg_functions.h"

namespace animeme::media::av {

const Functions& functions() {
  static const Functions table = linked_functions();
  return table;
}

}  // namespace animeme::media::av
