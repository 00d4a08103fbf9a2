// Stands in for espeak_process.cpp where the library was not there at build time.
#include "tools/speech/voice/espeak_process.h"

namespace animeme::voice {
namespace {

Error absent() {
  return make_error(Code::unsupported,
                    "this build has no text to speech; install the Debian packages "
                    "libespeak-ng-dev and espeak-ng-data and configure again with "
                    "-DANIMEME_WITH_ESPEAK=ON");
}

}  // namespace

Result<EspeakResult> run_espeak(const EspeakJob&) { return absent(); }
Result<VoiceLists> read_espeak_voices(const std::string&) { return absent(); }
void keep_voices() {}

}  // namespace animeme::voice
