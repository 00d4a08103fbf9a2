#include "tools/formats/common/module.h"
#include "tools/speech/voice/espeak_internal.h"

namespace animeme::voice {

const Result<const EspeakFunctions*>& espeak() {
  static const auto loaded = tools::load_functions<EspeakFunctions>(tools::kEspeakModule);
  return loaded;
}

}  // namespace animeme::voice
