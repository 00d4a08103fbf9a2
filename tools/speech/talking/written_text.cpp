#include "tools/speech/talking/written_text.h"

#include <utility>

#include "dam/script/marks.h"
#include "dam/script/script_text_internal.h"
#include "tools/speech/text/ssml.h"

namespace animeme::speech {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD", kApostrophe = "\xE2\x80\x99";

// What programs most often fail to convert is the apostrophe: "don\uFFFDt".
void restore_apostrophes(std::string& text) {
  for (std::size_t at = text.find(kReplacement); at != text.npos;
       at = text.find(kReplacement, at + 1)) {
    const std::size_t end = at + kReplacement.size();
    if (at == 0 || end == text.size() || !dam::is_letter(text[at - 1]) ||
        !dam::is_letter(text[end])) {
      continue;
    }
    text.replace(at, kReplacement.size(), kApostrophe);
  }
}

}  // namespace

std::string text_to_say(std::string_view bytes, bool speak_marks, const tools::Log& log) {
  dam::OddBytes odd;
  std::string text = dam::to_utf8(bytes, &odd);
  if (odd.count > 0) log.warn("line " + std::to_string(odd.line) + ": " + odd.describe());
  restore_apostrophes(text);
  if (speak_marks || text::is_ssml(text)) return text;
  dam::Unmarked unmarked = dam::without_marks(text, dam::MarksOf::prose);
  if (unmarked.count == 0) return text;
  log.warn("the mark \"" + unmarked.mark + "\" is not said (--speak-marks says such marks)" +
           (unmarked.count > 1 ? " (" + std::to_string(unmarked.count) + " in all)" : ""));
  return std::move(unmarked.text);
}

std::string_view without_stray_mark(std::string_view line, const tools::Log& log) {
  const bool marked = line.starts_with("\xFF\xFE") || line.starts_with("\xFE\xFF");
  if (!marked || line.find('\0') != line.npos) return line;
  log.warn("the byte order mark of UTF-16 before a line that is not UTF-16 is left out");
  return line.substr(2);
}

std::string line_to_say(std::string_view line, bool speak_marks, const tools::Log& log) {
  return text_to_say(without_stray_mark(line, log), speak_marks, log);
}

}  // namespace animeme::speech
