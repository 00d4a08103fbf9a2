#include "tools/app/commands/track_option.h"

#include "fap/detail/text_scanner.h"
#include "tools/app/commands/options.h"
#include "tools/formats/media/language_codes.h"
#include "tools/speech/text/unicode.h"

namespace animeme::tools {

Result<media::TrackLabels> read_track_labels(const std::string& text) {
  if (text.empty()) return media::TrackLabels();
  auto labels = media::parse_track_labels(text);
  if (!labels) return labels;
  if (!labels->language.empty()) {
    const bool is_code = labels->language.size() == 3;
    labels->code = is_code ? media::terminological_code(fap::detail::lower_case(labels->language))
                           : text::language_code(labels->language);
    if (labels->code == "und") labels->code.clear();
  }
  return labels;
}

media::TrackLabels wanted_track_of(const std::string& text) {
  const auto labels = read_track_labels(text);
  return labels ? *labels : media::TrackLabels();
}

void add_track_option(OptionTable& cli, std::string& track) {
  cli.add("--track", track,
          "Language and person of a file with several: lang=de,speaker=Ann; default: that of the "
          "file")
      ->type("LABELS")
      ->check(problem_of<media::parse_track_labels>);
}

}  // namespace animeme::tools
