#include "tools/speech/text/late_internal.h"

namespace animeme::text {

const Result<const TextFunctions*>& late_text() {
  static const Result<const TextFunctions*> none = make_error(
      Code::unsupported,
      "this build lacks a library for text by script and language; install the Debian packages "
      "libicu-dev, libmecab-dev, libcld2-dev and mecab-ipadic-utf8 and configure again");
  return none;
}

}  // namespace animeme::text
