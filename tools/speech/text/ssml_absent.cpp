// Stands in for ssml.cpp where the library was not there at build time.
#include "tools/speech/text/ssml.h"

namespace animeme::text {

Result<Document> read_ssml(std::string_view) {
  return make_error(Code::unsupported,
                    "this build cannot read SSML; install the Debian package libexpat1-dev and "
                    "configure again with -DANIMEME_WITH_EXPAT=ON");
}

}  // namespace animeme::text
