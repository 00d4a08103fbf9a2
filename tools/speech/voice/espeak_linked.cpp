// espeak-ng linked like any library; the program has tools/app/late/espeak_late.cpp instead.
#include "tools/speech/voice/espeak_internal.h"

namespace animeme::voice {

const Result<const EspeakFunctions*>& espeak() {
  static const Result<const EspeakFunctions*> linked = &kLinkedEspeak;
  return linked;
}

}  // namespace animeme::voice
