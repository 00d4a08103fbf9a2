#include "tools/speech/talking/marks.h"

#include <algorithm>
#include <cmath>

#include "dam/script/script_text_internal.h"
#include "dam/script/textgrid.h"
#include "tools/formats/common/text.h"

namespace animeme::speech {

std::string write_marked_script(const dam::Script& script,
                                const std::vector<voice::SpeechMark>& marks,
                                std::string_view ending) {
  std::string text = dam::write_script(script, ending);
  if (marks.empty()) return text;
  const std::string kind = dam::lower_case(ending);
  if (kind == ".vtt") {
    for (const voice::SpeechMark& mark : marks) {
      const auto ms = std::llround(mark.time * 1000);
      std::string name = mark.name;
      std::replace(name.begin(), name.end(), '\n', ' ');
      // An arrow would end the comment.
      for (std::size_t at = 0; (at = name.find("-->", at)) != std::string::npos;) {
        name.replace(at, 3, "- ->");
      }
      text += tools::format("\nNOTE mark %02lld:%02lld:%02lld.%03lld ", (long long)(ms / 3600000),
                            (long long)(ms / 60000 % 60), (long long)(ms / 1000 % 60),
                            (long long)(ms % 1000)) +
              name + "\n";
    }
    return text;
  }
  if (kind != ".textgrid") return text;
  auto grid = dam::parse_textgrid(text);
  if (!grid) return text;
  dam::TextGridTier tier{"marks", true, {}};
  for (const voice::SpeechMark& mark : marks) {
    tier.items.push_back({mark.time, mark.time, mark.name, 0, 0});
  }
  grid->tiers.push_back(std::move(tier));
  return dam::format_textgrid(*grid);
}

}  // namespace animeme::speech
