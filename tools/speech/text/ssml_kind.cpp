#include "tools/speech/text/ssml.h"

#include <algorithm>

namespace animeme::text {

bool is_ssml(std::string_view text) {
  const auto skip = [&] {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  };
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  skip();
  // What XML allows before the root: a declaration, comments, a document type.
  while (text.starts_with("<?") || text.starts_with("<!")) {
    const std::string_view end = text.starts_with("<!--") ? "-->" : ">";
    // A document type may declare entities, in brackets.
    const std::size_t bracket = text.find('[');
    const bool inside = text.starts_with("<!DOCTYPE") && bracket < text.find('>');
    const std::size_t from = inside ? text.find(']') : 0;
    const std::size_t close = text.find(end, std::min(from, text.size()));
    if (close == std::string_view::npos) break;
    text.remove_prefix(close + end.size());
    skip();
  }
  if (!text.starts_with("<speak")) return false;
  return text.size() == 6 || std::string_view(" \t\r\n/>").find(text[6]) != std::string_view::npos;
}

}  // namespace animeme::text
