#include "tools/formats/media/track_labels.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace animeme::media {
namespace {

constexpr std::size_t kLongestLanguageTag = 35, kLongestSpeakerLabel = 60;

TrackLabels& wanted_here() {
  thread_local TrackLabels wanted;
  return wanted;
}

bool same_letters(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  });
}

// "pt" is "pt-BR", too.
bool includes(std::string_view wide, std::string_view narrow) {
  return narrow.size() >= wide.size() && same_letters(wide, narrow.substr(0, wide.size())) &&
         (narrow.size() == wide.size() || narrow[wide.size()] == '-');
}

}  // namespace

bool is_language_tag(std::string_view tag) {
  if (tag.empty() || tag.size() > kLongestLanguageTag) return false;
  bool first = true;
  while (!tag.empty()) {
    const std::string_view part = tag.substr(0, tag.find('-'));
    const bool letters = std::all_of(part.begin(), part.end(), [&](unsigned char c) {
      return c < 0x80 && (first ? std::isalpha(c) != 0 : std::isalnum(c) != 0);
    });
    if (!letters || part.size() > 8 || part.size() < (first ? 2u : 1u)) return false;
    if (part.size() == tag.size()) return true;
    tag.remove_prefix(part.size() + 1);
    if (tag.empty()) return false;
    first = false;
  }
  return true;
}

std::string next_label(std::string_view& rest) {
  std::string part;
  std::size_t at = 0;
  for (; at < rest.size() && rest[at] != ','; ++at) {
    const bool escape =
        rest[at] == '\\' && at + 1 < rest.size() && (rest[at + 1] == ',' || rest[at + 1] == '\\');
    if (escape) ++at;
    part += rest[at];
  }
  // A comma at the end stays, so that there is an empty part behind it.
  const bool last = at > 0 && at + 1 == rest.size();
  rest.remove_prefix(last ? at : std::min(at + 1, rest.size()));
  return part;
}

Result<TrackLabels> parse_track_labels(std::string_view text) {
  TrackLabels labels;
  const auto wrong = [&](const std::string& why) {
    return make_error(Code::invalid_argument,
                      why + "; write lang=de, speaker=Ann, or lang=de,speaker=Ann");
  };
  std::string_view rest = text;
  while (true) {
    const std::string one = next_label(rest);
    const std::size_t equals = one.find('=');
    const std::string name = one.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : one.substr(equals + 1);
    if (value.empty()) return wrong("'" + one + "' is no label of a track");
    if (name == "lang") {
      std::string tag = value;  // locales are written with underscores: "pt_BR"
      std::replace(tag.begin(), tag.end(), '_', '-');
      if (!is_language_tag(tag)) return wrong("'" + value + "' is no language tag");
      labels.language = std::move(tag);
    } else if (name == "speaker") {
      if (value.size() > kLongestSpeakerLabel) return wrong("the name of a speaker is too long");
      labels.speaker = value;
    } else {
      return wrong("'" + name + "' is no label of a track");
    }
    if (rest.empty()) return labels;
  }
}

bool is_wanted(const TrackLabels& wanted, const TrackLabels& track) {
  if (!wanted.speaker.empty() && !same_letters(wanted.speaker, track.speaker)) return false;
  if (wanted.language.empty()) return true;
  if (!track.language.empty()) {
    // A track may say "deu" where "de" is asked for.
    const bool is_code = wanted.language.size() == 3 && !track.code.empty();
    return includes(wanted.language, track.language) ||
           (is_code && same_letters(wanted.code, track.code)) ||
           (!wanted.code.empty() && wanted.language.find('-') == std::string::npos &&
            includes(wanted.code, track.language));
  }
  return !track.code.empty() && same_letters(wanted.code, track.code);
}

TrackScope::TrackScope(TrackLabels wanted)
    : before_(std::exchange(wanted_here(), std::move(wanted))) {}

TrackScope::~TrackScope() { wanted_here() = std::move(before_); }

const TrackLabels& wanted_track() { return wanted_here(); }

}  // namespace animeme::media
