// What the library has where pocketsphinx or speexdsp was not there at build time.
#include "tools/speech/voice/cepstra.h"
#include "tools/speech/voice/denoise.h"
#include "tools/speech/voice/rate_change.h"
#include "tools/speech/voice/word_search.h"

namespace animeme::voice {
namespace {

Error absent() {
  return make_error(Code::unsupported,
                    "this build can neither align nor recognise speech; install the Debian "
                    "packages libpocketsphinx-dev, libsphinxbase-dev, libspeexdsp-dev and "
                    "pocketsphinx-en-us and configure again with -DANIMEME_WITH_ALIGNER=ON");
}

}  // namespace

Result<std::unique_ptr<CepstraReader>> CepstraReader::open(const std::string&) { return absent(); }

Result<std::vector<double>> read_phone_pairs(const std::string&, const std::vector<std::string>&) {
  return absent();
}

void denoise(const std::vector<float>& samples, double,
             const std::function<void(std::span<const float>)>& take) {
  take(samples);
}

Result<std::unique_ptr<RateChange>> RateChange::open(int) { return absent(); }

Result<std::unique_ptr<WordSearch>> WordSearch::open(const WordFiles&) { return absent(); }

}  // namespace animeme::voice
