#include "tools/formats/common/module.h"
#include "tools/speech/text/late_internal.h"

namespace animeme::text {

const Result<const TextFunctions*>& late_text() {
  static const auto loaded = tools::load_functions<TextFunctions>(tools::kTextModule);
  return loaded;
}

}  // namespace animeme::text
