// In place of mecab.cpp: in the program, and where MeCab was not there at build time.
#include "tools/speech/text/late_internal.h"

namespace animeme::text {

Result<std::vector<JapaneseWord>> japanese_words(std::u32string_view text,
                                                 const std::string& folder) {
  if (late_text()) return (*late_text())->japanese_words(text, folder);
  return make_error(Code::unsupported,
                    "Japanese with Chinese characters cannot be read here, kana can: " +
                        late_text().error().message);
}

}  // namespace animeme::text
