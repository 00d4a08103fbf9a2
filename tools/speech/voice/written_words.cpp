#include "tools/speech/voice/written_words.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "dam/script/words.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/voice_events.h"

namespace animeme::voice {
namespace {

// A run of characters without a blank.
struct Chunk {
  std::size_t first = 0, last = 0;  // in the source, one past the last
  bool spoken = false;              // it has more than signs that a voice passes over
  bool new_line = false;            // before it
};

constexpr std::size_t kLongest = 64;   // of a word; longer ones end where the voice begins another
constexpr std::size_t kMostSigns = 3;  // between the place of an event and its word

bool is_passed_over(char32_t c) {
  constexpr std::u32string_view kSigns =
      U"-.,;:!?\"'()[]{}*_~|"
      U"\u00A1\u00AB\u00B7\u00BB\u00BF\u3001\u3002\uFF01\uFF0C\uFF1A\uFF1B\uFF1F";
  return kSigns.find(c) != kSigns.npos || (c >= 0x2010 && c <= 0x2027) ||
         (c >= 0x3008 && c <= 0x301F) || (c >= 0xFF08 && c <= 0xFF09);
}

bool opens(char32_t c) {
  constexpr std::u32string_view kOpening =
      U"([{\u00AB\u2018\u201C\u3008\u300A\u300C\u300E\u3010\uFF08";
  return kOpening.find(c) != kOpening.npos;
}

bool is_blank(char32_t c) { return text::is_blank(c) || c == 0x3000; }

// How many characters without a blank there are in front of a place, at most kLongest.
std::size_t run_before(const std::u32string& source, std::size_t at) {
  std::size_t count = 0;
  while (count < kLongest && count < at && !is_blank(source[at - 1 - count])) ++count;
  return count;
}

// Where the voice begins a word that no blank precedes.
std::set<std::size_t> unspaced_starts(const std::vector<text::Place>& places,
                                      const std::u32string& source) {
  std::set<std::size_t> starts;
  for (const text::Place& place : places) {
    std::size_t at = place.first;
    if (place.last <= place.first || at == 0 || at >= source.size()) continue;
    const bool parted = dam::is_unspaced(source[at]) || dam::is_unspaced(source[at - 1]);
    if (!parted && run_before(source, at) < kLongest) continue;
    if (is_passed_over(source[at]) && !opens(source[at])) continue;
    while (at > 0 && opens(source[at - 1])) --at;
    starts.insert(at);
  }
  return starts;
}

std::vector<Chunk> chunks_of(const std::u32string& source, const std::set<std::size_t>& starts) {
  std::vector<Chunk> chunks;
  bool inside = false, new_line = false;
  for (std::size_t i = 0; i < source.size(); ++i) {
    if (is_blank(source[i])) {
      inside = false;
      new_line = new_line || source[i] == U'\n';
      continue;
    }
    if (!inside || starts.contains(i)) {
      chunks.push_back({i, i, false, new_line});
      new_line = false;
    }
    inside = true;
    chunks.back().last = i + 1;
    chunks.back().spoken = chunks.back().spoken || !is_passed_over(source[i]);
  }
  return chunks;
}

// One blank for any number of them; none at the ends.
std::string text_between(const std::u32string& source, std::size_t first, std::size_t last) {
  std::u32string out;
  for (std::size_t i = first; i < last; ++i) {
    if (!is_blank(source[i]))
      out += source[i];
    else if (!out.empty() && out.back() != U' ')
      out += U' ';
  }
  return text::utf8(out);
}

// The words in chunks `first` to `last`: signs go with the word before them.
std::vector<std::string> parts_of(const std::u32string& source, const std::vector<Chunk>& chunks,
                                  const std::vector<bool>& joins, std::size_t first,
                                  std::size_t last) {
  std::vector<std::string> parts;
  bool spoken = false;  // the part has a word
  std::size_t begin = first;
  for (std::size_t k = first; k < last; ++k) {
    if (chunks[k].spoken && spoken && !joins[k]) {
      parts.push_back(text_between(source, chunks[begin].first, chunks[k - 1].last));
      begin = k;
    }
    spoken = spoken || chunks[k].spoken;
  }
  parts.push_back(text_between(source, chunks[begin].first, chunks[last - 1].last));
  return parts;
}

// The chunk in which a place begins, or the next one that is spoken: the voice may name the sign
// before a word as its place.
std::size_t chunk_at(const std::vector<Chunk>& chunks, std::size_t place, std::size_t current) {
  const auto behind = [place](const Chunk& chunk) { return chunk.last <= place; };
  auto i = std::size_t(std::partition_point(chunks.begin(), chunks.end(), behind) - chunks.begin());
  for (std::size_t k = i; k < chunks.size() && chunks[k].first <= place + kMostSigns; ++k) {
    if (chunks[k].spoken) {
      i = k;
      break;
    }
  }
  return std::clamp(i, current, chunks.size() - 1);
}

}  // namespace

WrittenWords written_words(const RawSpeech& raw, const text::Utterance& utterance) {
  WrittenWords out;
  out.of_event.assign(raw.events.size(), kNoWritten);
  std::vector<text::Place> places(raw.events.size());
  for (std::size_t i = 0; i < raw.events.size(); ++i) {
    const VoiceEvent& event = raw.events[i];
    // Of markup there are words of no length.
    if (event.kind == EventKind::word && (!utterance.markup || event.text_length > 0))
      places[i] = place_of(event, utterance);
  }
  const std::u32string& source = utterance.source;
  const std::vector<Chunk> chunks = chunks_of(source, unspaced_starts(places, source));
  if (chunks.empty()) return out;

  // Chunks that a voice says, and those that it says together.
  std::vector<bool> begins(chunks.size(), false), joins(chunks.size(), false);
  std::vector<std::size_t> chunk_of(raw.events.size(), kNoWritten);
  std::size_t current = 0, now = kNoWritten;
  for (std::size_t i = 0; i < raw.events.size(); ++i) {
    if (places[i].last > places[i].first) {
      current = chunk_at(chunks, places[i].first, current);
      begins[current] = true;
      for (std::size_t k = current + 1; k < chunks.size() && chunks[k].first < places[i].last; ++k)
        joins[k] = chunks[k].spoken || joins[k];
      now = current;
    }
    chunk_of[i] = now;
  }
  std::vector<std::size_t> word_of(chunks.size());
  std::size_t first = 0;  // of the current word
  bool said = false;      // a voice says something of the current word
  for (std::size_t k = 0; k <= chunks.size(); ++k) {
    // A dash at the start of a line belongs to what follows.
    std::size_t spoken = k;
    while (spoken < chunks.size() && !chunks[spoken].spoken && chunks[k].new_line) ++spoken;
    const bool starts = spoken < chunks.size() && begins[spoken] && !joins[spoken];
    if (k == chunks.size() || (starts && said)) {
      out.words.push_back(parts_of(source, chunks, joins, first, k));
      first = k;
      said = false;
    }
    if (k == chunks.size()) break;
    word_of[k] = out.words.size();
    said = said || begins[k];
  }
  for (std::size_t i = 0; i < raw.events.size(); ++i)
    if (chunk_of[i] != kNoWritten) out.of_event[i] = word_of[chunk_of[i]];
  return out;
}

}  // namespace animeme::voice
