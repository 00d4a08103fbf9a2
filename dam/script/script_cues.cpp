#include "dam/script/script_cues_internal.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "dam/script/script_text_internal.h"
#include "dam/script/table_text_internal.h"

namespace animeme::dam {
namespace {

constexpr std::size_t kMostRolling = 16;  // lines that a cue shows again
constexpr double kTouching = 0.1;         // seconds between cues of captions that roll

std::string line_text(const CueLine& line) {
  std::string text;
  for (const CuePiece& piece : line) text += piece.text;
  return std::string(trimmed(text));
}

bool is_timed(const CueLine& line) {
  return std::any_of(line.begin(), line.end(), [](const CuePiece& p) { return p.start; });
}

// How many of the first lines of a cue the one before ended with.
std::size_t repeated_lines(const Cue& before, const Cue& cue) {
  if (cue.start > before.end + kTouching) return 0;
  const std::size_t most = std::min({before.lines.size(), cue.lines.size(), kMostRolling});
  for (std::size_t count = most; count > 0; --count) {
    const std::size_t first = before.lines.size() - count;
    bool same = true;
    for (std::size_t i = 0; i < count && same; ++i) {
      same = line_text(before.lines[first + i]) == line_text(cue.lines[i]);
    }
    if (same) return count;
  }
  return 0;
}

struct CueKinds {
  bool timed = false, underlined = false, rolling = false;
};

// How a file marks words.
CueKinds cue_kinds(const std::vector<Cue>& cues) {
  CueKinds kinds;
  std::size_t of_more = 0, again = 0;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    for (const CueLine& line : cues[i].lines) {
      for (const CuePiece& piece : line) {
        kinds.timed = kinds.timed || piece.start;
        kinds.underlined = kinds.underlined || piece.underlined;
      }
    }
    if (i == 0 || cues[i].lines.size() < 2) continue;
    ++of_more;
    const std::size_t count = repeated_lines(cues[i - 1], cues[i]);
    again += count > 0 && count < cues[i].lines.size() ? 1 : 0;
  }
  // Somebody may say a line twice; who shows each one twice rolls.
  kinds.rolling = kinds.timed ? again > 0 : again > 1 && 2 * again >= of_more;
  return kinds;
}

// Letters of scripts that part words by blanks.
bool is_syllable(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte == '\'' || byte == '-' || ((byte | 0x20) >= 'a' && (byte | 0x20) <= 'z') ||
         (byte >= 0xC3 && byte < 0xE0) || (byte >= 0x80 && byte < 0xC0);
}

// Words with times of their own.
void add_timed(const Cue& cue, std::vector<TimedLabel>& labels) {
  const std::size_t first = labels.size();
  double start = cue.start;
  for (const CueLine& line : cue.lines) {
    bool apart = true;
    for (const CuePiece& piece : line) {
      if (piece.start) start = *piece.start;
      const bool open = labels.size() > first && labels.back().end <= labels.back().start;
      if (open) labels.back().end = start;
      if (trimmed(piece.text).empty()) {
        apart = apart || !piece.text.empty();
        continue;
      }
      // Karaoke times syllables: without a blank between them they are one word.
      const bool syllable = labels.size() > first && !apart && is_syllable(piece.text[0]);
      apart = !is_syllable(piece.text.back());
      if (syllable) {
        labels.back().label += trimmed(piece.text);
        labels.back().end = labels.back().start;  // ends where the next begins
        continue;
      }
      labels.push_back({start,
                        start,
                        std::string(trimmed(piece.text)),
                        {},
                        piece.line,
                        piece.column,
                        true,
                        Alphabet::automatic,
                        piece.speaker});
    }
  }
  if (labels.size() > first && labels.back().end <= labels.back().start) {
    labels.back().end = cue.end;
  }
}

// The words of a cue, or of each speaker in it.
void add_whole(const Cue& cue, const CueKinds& kinds, bool by_speaker,
               std::vector<TimedLabel>& labels) {
  const std::size_t first = labels.size();
  for (const CueLine& line : cue.lines) {
    for (const CuePiece& piece : line) {
      const std::string_view text = trimmed(piece.text);
      if (text.empty() || (kinds.underlined && !piece.underlined)) continue;
      const bool more =
          labels.size() > first && (!by_speaker || labels.back().speaker == piece.speaker);
      if (more) {
        const bool apart = &piece == &line.front() || piece.text.starts_with(' ') ||
                           (&piece)[-1].text.ends_with(' ') || (&piece)[-1].text.empty();
        labels.back().label += (apart ? " " : "") + std::string(text);
      } else {
        labels.push_back({cue.start,
                          cue.end,
                          std::string(text),
                          {},
                          cue.line,
                          1,
                          true,
                          Alphabet::automatic,
                          piece.speaker});
      }
    }
  }
}

}  // namespace

std::optional<double> parse_clock(std::string_view text) {
  std::string digits(trimmed(text));
  std::replace(digits.begin(), digits.end(), ',', '.');
  std::string_view rest = digits;
  double seconds = 0;
  for (int part = 0; part < 3; ++part) {
    const std::size_t colon = rest.find(':');
    const auto value = parse_number(rest.substr(0, colon));
    if (!value || !(*value >= 0) || !(*value < 1e6)) return std::nullopt;
    seconds = seconds * 60 + *value;
    if (colon == std::string_view::npos) {
      return part > 0 ? std::optional(seconds) : std::nullopt;
    }
    rest.remove_prefix(colon + 1);
  }
  return std::nullopt;
}

void add_words_of_cues(std::vector<Cue> cues, const ScriptOptions& options, Timings& timings) {
  std::stable_sort(cues.begin(), cues.end(),
                   [](const Cue& a, const Cue& b) { return a.start < b.start; });
  for (Cue& cue : cues) {
    std::erase_if(cue.lines, [](const CueLine& line) { return line_text(line).empty(); });
  }
  const CueKinds kinds = cue_kinds(cues);
  for (std::size_t i = 0; i < cues.size(); ++i) {
    Cue said = cues[i];
    if (kinds.rolling) {
      const bool first = i == 0 || said.start > cues[i - 1].end + kTouching;
      std::size_t again = first ? 0 : repeated_lines(cues[i - 1], cues[i]);
      // A file that was cut begins with a line that has been said before.
      const bool timed = std::any_of(said.lines.begin(), said.lines.end(), is_timed);
      while (first && timed && again < said.lines.size() && !is_timed(said.lines[again])) ++again;
      said.lines.erase(said.lines.begin(), said.lines.begin() + std::ptrdiff_t(again));
    }
    if (std::any_of(said.lines.begin(), said.lines.end(), is_timed)) {
      add_timed(said, timings.labels);
    } else {
      add_whole(said, kinds, options.everyone || !options.speaker.empty(), timings.labels);
    }
  }
}

}  // namespace animeme::dam
