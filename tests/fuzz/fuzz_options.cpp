// Texts of options that have readers of their own: tracks, rates, ranges, looks, commands.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "dam/behaviour/behaviour.h"
#include "dam/behaviour/look.h"
#include "dam/script/mood.h"
#include "fap/rate_text.h"
#include "tests/fuzz/require.h"
#include "tools/formats/media/track_labels.h"
#include "tools/formats/programs/command_template.h"
#include "tools/speech/talking/cue_voice.h"
#include "tools/speech/talking/sound_bytes.h"
#include "tools/view/gltf/shape_rules.h"

using animeme::test::require;

namespace {

using namespace animeme;

template <class T>
bool says_why(const Result<T>& result) {
  require(result || !result.error().message.empty());
  return result.has_value();
}

void check_labels(const std::string& text) {
  const auto labels = media::parse_track_labels(text);
  if (!says_why(labels)) return;
  require(!labels->empty() && labels->speaker.size() <= 60);
  require(media::is_wanted(*labels, *labels) && media::is_wanted({}, *labels));
  require(labels->language.empty() || media::is_language_tag(labels->language));
  std::string again = labels->language.empty() ? "" : "lang=" + labels->language;
  if (!labels->speaker.empty()) {
    again += (again.empty() ? "" : ",") + std::string("speaker=") + labels->speaker;
  }
  const auto back = media::parse_track_labels(again);
  require(back && *back == *labels);
}

// A text never becomes an option of a program, unless the command line says "--" before it.
void check_command(std::string_view line, const std::string& text) {
  const auto arguments = tools::split_arguments(line);
  if (!says_why(arguments)) return;
  tools::CommandTemplate command{*arguments};
  const tools::Place places[] = {{"text", text}, {"wav", "/a.wav"}};
  const auto filled = tools::fill_in(command, places);
  if (!says_why(filled)) return;
  require(filled->size() == arguments->size());
  bool behind = false;
  for (std::size_t i = 0; i < filled->size(); ++i) {
    const std::string& before = (*arguments)[i];
    if ((*filled)[i].starts_with('-') && !before.starts_with('-')) require(behind);
    behind = behind || before == "--";
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 4000) return 0;
  const std::string text(reinterpret_cast<const char*>(data), size);
  check_labels(text);
  const std::size_t line = std::min(text.find('\n'), text.size());
  check_command(text.substr(0, line), text.substr(std::min(line + 1, text.size())));
  if (const auto rate = fap::parse_rate(text); says_why(rate)) {
    require(rate->num > 0 && rate->den > 0);
  }
  if (const auto range = speech::parse_fit_range(text); says_why(range)) {
    require(range->slowest >= 0.5 && range->slowest <= 1);
    require(range->fastest >= 1 && range->fastest <= 2);
  }
  if (const auto bare = speech::parse_bare_sound(text); says_why(bare)) {
    require(bare->sample_rate >= 4000 && bare->channels >= 1 && bare->channels <= 16);
  }
  if (const auto mood = dam::read_mood(text); says_why(mood)) {
    require(mood->intensity >= 0 && mood->intensity <= 1);
  }
  if (const auto look = dam::parse_look(text); says_why(look)) {
    require(look->yaw - look->yaw == 0 && look->pitch - look->pitch == 0);
    require(look->x - look->x == 0 && look->y - look->y == 0 && look->z - look->z == 0);
  }
  says_why(dam::parse_still(text));
  says_why(gltf::parse_shape_rule(text));
  says_why(gltf::read_shape_rules(text));
  return 0;
}
