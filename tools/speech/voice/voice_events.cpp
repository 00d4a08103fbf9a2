#include "tools/speech/voice/voice_events.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "dam/script/ipa.h"
#include "dam/script/script_text_internal.h"
#include "dam/script/words.h"
#include "tools/speech/text/unicode.h"
#include "tools/speech/voice/written_words.h"

namespace animeme::voice {
namespace {

using dam::IpaPhone;

constexpr double kMaxClosure = 0.2;        // seconds of silence before a burst that are closure
constexpr double kMaxFirstClosure = 0.08;  // the same after a pause: the rest is rest
constexpr double kMinPhone = 0.01;         // seconds that the phone before keeps

// A stretch of sound with its labels. No labels: silence.
struct VoicedSegment {
  std::int64_t start = 0, end = 0;
  std::vector<IpaPhone> labels;
  std::size_t word = kNoWritten;
};

// A pause comes as an empty name, just like a mark without a sound of its own; the ear decides.
bool is_mostly_silent(const std::vector<bool>& silent, std::int64_t start, std::int64_t end) {
  const auto first = silent.begin() + start, last = silent.begin() + end;
  return 2 * std::count(first, last, true) >= last - first;
}

// espeak-ng cuts names at 8 bytes, maybe inside a character.
std::string_view whole_characters(std::string_view ipa) {
  for (std::string_view rest = ipa; !rest.empty();) {
    const std::size_t at = ipa.size() - rest.size();
    if (dam::take_code_point(rest) == 0xFFFD) return ipa.substr(0, at);
  }
  return ipa;
}

std::vector<IpaPhone> labels_of(std::string_view ipa) {
  auto parsed = dam::parse_ipa(whole_characters(ipa));
  if (!parsed) return {{"AX", 1.0}};
  return *std::move(parsed);
}

void add_segment(std::vector<VoicedSegment>& segments, const RawSpeech& raw, VoicedSegment segment,
                 std::string_view ipa) {
  if (segment.end <= segment.start) return;
  const bool pause = ipa.starts_with('_');
  const bool language_switch = ipa.starts_with('(');
  if (!pause && !language_switch) segment.labels = labels_of(ipa);
  const bool silent =
      pause || (segment.labels.empty() && is_mostly_silent(raw.silent, segment.start, segment.end));
  if (silent) segment.word = kNoWritten;
  if (segment.labels.empty() && !silent && !segments.empty()) {
    segments.back().end = segment.end;  // a mark: the sound before it goes on
  } else {
    segments.push_back(std::move(segment));
  }
}

std::vector<VoicedSegment> cut(const RawSpeech& raw, const WrittenWords& written) {
  const auto size = std::int64_t(raw.silent.size());
  std::vector<VoicedSegment> segments;
  VoicedSegment current;
  std::string ipa = "_";
  for (std::size_t i = 0; i < raw.events.size(); ++i) {
    const VoiceEvent& event = raw.events[i];
    if (event.kind != EventKind::phoneme) continue;
    current.end = std::clamp(event.sample, current.start, size);
    const std::int64_t next = current.end;
    add_segment(segments, raw, std::move(current), ipa);
    current = {next, next, {}, written.of_event[i]};
    ipa = event.ipa;
  }
  current.end = size;
  add_segment(segments, raw, std::move(current), ipa);
  return segments;
}

bool begins_with_closure(const VoicedSegment& segment) {
  constexpr std::string_view kStops[] = {"P", "B", "T", "D", "K", "G", "CH", "JH"};
  return !segment.labels.empty() && std::find(std::begin(kStops), std::end(kStops),
                                              segment.labels[0].label) != std::end(kStops);
}

// The event of a stop is at its burst; the silence before it is the closure and belongs to it.
void move_stops_to_closure(std::vector<VoicedSegment>& segments, const RawSpeech& raw, int rate) {
  for (std::size_t i = 1; i < segments.size(); ++i) {
    if (!begins_with_closure(segments[i])) continue;
    VoicedSegment& before = segments[i - 1];
    const double reach = before.labels.empty() ? kMaxFirstClosure : kMaxClosure;
    const std::int64_t floor = std::max(segments[i].start - std::int64_t(reach * rate),
                                        before.start + std::int64_t(kMinPhone * rate));
    std::int64_t start = segments[i].start;
    while (start > floor && raw.silent[std::size_t(start - 1)]) --start;
    segments[i].start = before.end = start;
  }
}

void append(std::vector<dam::Phone>& phones, dam::Phone phone) {
  if (phone.label == dam::kSilence && !phones.empty() && phones.back().label == dam::kSilence) {
    phones.back().end = phone.end;
  } else {
    phones.push_back(std::move(phone));
  }
}

// Words that are announced together share their phones by their letters.
std::vector<std::size_t> shared(std::size_t phones, const std::vector<std::string>& words) {
  std::size_t letters = 0, before = 0;
  for (const std::string& word : words) letters += text::code_points(word).size();
  std::vector<std::size_t> out;
  for (std::size_t w = 0; w < words.size(); ++w) {
    before += text::code_points(words[w]).size();
    const std::size_t least = out.size() + 1, most = phones - (words.size() - 1 - w);
    const std::size_t end =
        w + 1 == words.size() ? phones : std::clamp(before * phones / letters, least, most);
    out.resize(end, w);
  }
  return out;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

void name_words(const std::vector<std::size_t>& entries, const WrittenWords& written,
                std::vector<dam::Phone>& phones) {
  for (std::size_t i = 0; i < phones.size();) {
    if (entries[i] >= written.words.size()) {
      ++i;
      continue;
    }
    // The phones of an entry; there may be pauses between them.
    std::vector<std::size_t> places;
    std::size_t end = i;
    for (; end < phones.size(); ++end) {
      if (entries[end] == entries[i])
        places.push_back(end);
      else if (entries[end] != kNoWritten)
        break;
    }
    const std::vector<std::string>& words = written.words[entries[i]];
    const bool apart = words.size() > 1 && places.size() >= words.size();
    const auto word_of =
        apart ? shared(places.size(), words) : std::vector<std::size_t>(places.size(), 0);
    for (std::size_t k = 0; k < places.size(); ++k) {
      phones[places[k]].word = apart ? words[word_of[k]] : joined(words);
      dam::link_phone(phones, places[k], k == 0 || word_of[k] != word_of[k - 1]);
    }
    i = end;
  }
}

}  // namespace

text::Place place_of(const VoiceEvent& event, const text::Utterance& utterance) {
  // Positions count characters of the input, from 1.
  const auto count = std::int64_t(utterance.input.size());
  const std::int64_t first = std::clamp<std::int64_t>(event.text_position - 1, 0, count);
  const std::int64_t last = std::clamp<std::int64_t>(first + event.text_length, first, count);
  text::Place all;
  for (std::int64_t i = first; i < last; ++i) {
    const text::Place place = utterance.input.places[std::size_t(i)];
    if (place.last <= place.first) continue;
    all.first = all.last == 0 ? place.first : std::min(all.first, place.first);
    all.last = std::max(all.last, place.last);
  }
  return all;
}

dam::Script make_voice_script(const RawSpeech& raw, int sample_rate, std::string_view text) {
  text::Utterance utterance;
  utterance.source = text::code_points(text);
  utterance.input = text::as_written(utterance.source);
  return make_voice_script(raw, sample_rate, utterance);
}

dam::Script make_voice_script(const RawSpeech& raw, int sample_rate,
                              const text::Utterance& utterance) {
  const WrittenWords written = written_words(raw, utterance);
  std::vector<VoicedSegment> segments = cut(raw, written);
  move_stops_to_closure(segments, raw, sample_rate);
  dam::Script script;
  std::vector<std::size_t> entries;  // of WrittenWords, for each phone
  const auto seconds = [&](double sample) { return sample / double(sample_rate); };
  for (const VoicedSegment& segment : segments) {
    const double start = seconds(double(segment.start)), end = seconds(double(segment.end));
    if (segment.labels.empty()) {
      append(script.phones, {start, end, std::string(dam::kSilence), {}});
    }
    double share = 0, from = start;
    for (std::size_t i = 0; i < segment.labels.size(); ++i) {
      share += segment.labels[i].share;
      const double to = i + 1 == segment.labels.size() ? end : start + share * (end - start);
      entries.resize(script.phones.size(), kNoWritten);
      append(script.phones, {from, to, std::string(segment.labels[i].label), {}});
      entries.resize(script.phones.size(), segment.word);
      from = to;
    }
  }
  entries.resize(script.phones.size(), kNoWritten);
  name_words(entries, written, script.phones);
  return script;
}

std::vector<dam::MoodSpan> find_moods(const RawSpeech& raw, int sample_rate,
                                      const text::Utterance& utterance, const dam::Script& script) {
  if (utterance.moods.empty()) return {};
  std::vector<text::TimedPlace> words;
  std::optional<text::Place> word;  // whose first sound has not come yet
  for (const VoiceEvent& event : raw.events) {
    if (event.kind == EventKind::word && event.text_length > 0) {
      const text::Place place = place_of(event, utterance);
      if (place.last > place.first) word = place;
    } else if (event.kind == EventKind::phoneme && word && !event.ipa.empty() &&
               !event.ipa.starts_with('_') && !event.ipa.starts_with('(')) {
      words.push_back({word->first, double(event.sample) / sample_rate});
      word.reset();
    }
  }
  double end = 0;
  for (const dam::Phone& phone : script.phones)
    if (phone.label != dam::kSilence) end = phone.end;
  return text::mood_spans(utterance.moods, words, end);
}

}  // namespace animeme::voice
