#include "tools/speech/voice/word_search.h"

namespace animeme::voice {

Result<std::unique_ptr<WordSearch>> WordSearch::open(const WordFiles&) {
  return make_error(Code::unsupported, "this program was built without pocketsphinx");
}

}  // namespace animeme::voice
