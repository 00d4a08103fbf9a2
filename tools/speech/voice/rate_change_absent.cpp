#include "tools/speech/voice/rate_change.h"

namespace animeme::voice {

Result<std::unique_ptr<RateChange>> RateChange::open(int) {
  return make_error(Code::unsupported,
                    "this build cannot recognise live sound: it was built without speexdsp");
}

}  // namespace animeme::voice
