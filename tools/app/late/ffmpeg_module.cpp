#include "tools/formats/common/module.h"
#include "tools/formats/media/detail/ffmpeg/ffmpeg_functions.h"

namespace {
const animeme::media::av::Functions table = animeme::media::av::linked_functions();
}

ANIMEME_MODULE(table);
