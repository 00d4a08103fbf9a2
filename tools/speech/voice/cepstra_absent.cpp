#include "tools/speech/voice/cepstra.h"

namespace animeme::voice {

namespace {

Error no_ears() {
  return make_error(Code::unsupported,
                    "this build cannot recognise speech: it was made without pocketsphinx");
}

}  // namespace

Result<std::unique_ptr<CepstraReader>> CepstraReader::open(const std::string&) { return no_ears(); }

Result<std::vector<double>> read_phone_pairs(const std::string&, const std::vector<std::string>&) {
  return no_ears();
}

}  // namespace animeme::voice
