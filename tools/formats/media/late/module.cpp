// animeme_ffmpeg.so: all that it is for is to be linked with FFmpeg.
#include "tools/formats/media/detail/ffmpeg/ffmpeg_functions.h"

extern "C" __attribute__((visibility("default"))) const animeme::media::av::Functions*
animeme_ffmpeg_functions() {
  static const animeme::media::av::Functions table = animeme::media::av::linked_functions();
  return &table;
}
