// Stands in for recogniser.cpp where the library was not there at build time.
#include "tools/voice/recogniser.h"

namespace animeme::voice {

Result<void> check_recogniser(const AlignOptions&) {
  return make_error(Code::unsupported,
                    "this build has no aligner; install the Debian packages libpocketsphinx-dev "
                    "and pocketsphinx-en-us and configure again with -DANIMEME_WITH_ALIGNER=ON");
}

Result<std::vector<Segment>> recognise(const std::vector<std::int16_t>&,
                                       const std::vector<SpokenWord>&,
                                       const AlignOptions& options) {
  return check_recogniser(options).error();
}

}  // namespace animeme::voice
