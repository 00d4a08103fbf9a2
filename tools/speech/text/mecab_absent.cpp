// Stands in for mecab.cpp where the library was not there at build time.
#include "tools/speech/text/japanese.h"

namespace animeme::text {

Result<std::vector<JapaneseWord>> japanese_words(std::u32string_view, const std::string&) {
  return make_error(Code::unsupported,
                    "this build cannot read Japanese with Chinese characters; install the Debian "
                    "packages libmecab-dev and mecab-ipadic-utf8 and configure again with "
                    "-DANIMEME_WITH_MECAB=ON, or write it in kana");
}

}  // namespace animeme::text
