#include "tools/speech/voice/alignment_report.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "tools/speech/voice/confidence.h"

namespace animeme::voice {

namespace {

constexpr std::size_t kMostNamed = 10;    // of one kind of warning
constexpr std::size_t kMostSpelled = 3;   // words in a row; of more the first and the last
constexpr std::size_t kPhonesNamed = 12;  // of a put-in stretch

std::string in_seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string quoted(const AlignedWord& word) { return "'" + word.text + "'"; }

// Where it is, for somebody who has the text before him: `first` to `end` are not counted.
std::string place_of(const std::vector<AlignedWord>& words, std::size_t first, std::size_t end) {
  const bool none = first == 0;
  if (none && end == words.size()) return "";
  if (none) return "before " + quoted(words[end]) + ", ";
  if (end == words.size()) return "after " + quoted(words[first - 1]) + ", ";
  return "between " + quoted(words[first - 1]) + " and " + quoted(words[end]) + ", ";
}

void add_rest(std::size_t count, const char* what, Alignment& alignment) {
  if (count <= kMostNamed) return;
  alignment.warnings.push_back("and " + std::to_string(count - kMostNamed) + " more " + what);
}

std::string phones_of(const PutIn& one) {
  std::string phones;
  for (std::size_t k = 0; k < one.phones.size() && k < kPhonesNamed; ++k) {
    phones += (k > 0 ? " " : "") + one.phones[k];
  }
  return phones + (one.phones.size() > kPhonesNamed ? " ..." : "");
}

std::string span_of(const PutIn& one) {
  return in_seconds(one.start) + " to " + in_seconds(one.end) + " s";
}

// What is said where the words from `first` on are not: another word, or they sound otherwise than
// the dictionary has them.
std::string instead_of(const Alignment& alignment, std::size_t first) {
  std::string what;
  for (const PutIn& one : alignment.put_in) {
    if (one.before != first) continue;
    what += (what.empty() ? "; there is " : ", ") + phones_of(one) + " (" + span_of(one) + ")";
  }
  return what;
}

void warn_of_left_out(Alignment& alignment) {
  const auto& words = alignment.words;
  std::size_t count = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].said || !words[i].known) continue;
    std::size_t end = i + 1;
    while (end < words.size() && !words[end].said) ++end;
    std::string what = quoted(words[i]);
    if (end - i > kMostSpelled) {
      what = std::to_string(end - i) + " words from " + what + " to " + quoted(words[end - 1]);
    } else {
      for (std::size_t k = i + 1; k < end; ++k) what += " " + quoted(words[k]);
    }
    if (++count <= kMostNamed) {
      alignment.warnings.push_back(what + (end - i > 1 ? " are" : " is") + " not said (" +
                                   place_of(words, i, end) + in_seconds(words[i].start) + " s)" +
                                   instead_of(alignment, i));
    }
    i = end - 1;
  }
  add_rest(count, "places with omitted words", alignment);
}

void warn_of_put_in(Alignment& alignment) {
  std::size_t count = 0;
  for (const PutIn& one : alignment.put_in) {
    const auto& words = alignment.words;
    if (one.before < words.size() && !words[one.before].said && words[one.before].known) continue;
    if (++count > kMostNamed) continue;
    alignment.warnings.push_back("there is speech that is not in the transcript (" +
                                 place_of(words, one.before, one.before) + span_of(one) +
                                 "); the face uses the recognised phones, about " + phones_of(one));
  }
  add_rest(count, "places with additional speech", alignment);
}

void warn_of_doubts(Alignment& alignment) {
  std::string list;
  std::size_t count = 0;
  for (const AlignedWord& word : alignment.words) {
    if (!word.said || !word.known || word.confidence >= kDoubtful) continue;
    if (++count > kMostNamed) continue;
    list += (list.empty() ? "" : ", ") + word.text + " (" + in_seconds(word.start) + " s)";
  }
  if (count == 0) return;
  if (count > kMostNamed) list += " and " + std::to_string(count - kMostNamed) + " more";
  alignment.warnings.push_back("the sound hardly fits these words; were they said? " + list);
}

}  // namespace

void add_script(const std::vector<Segment>& segments, const std::vector<SpokenWord>& words,
                double duration, Alignment& alignment) {
  dam::Script& script = alignment.script;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const double start = i == 0 ? 0.0 : script.phones.empty() ? 0.0 : script.phones.back().end;
    const double next = i + 1 == segments.size() ? duration : segments[i + 1].start;
    const double end = std::min(next, duration);
    if (end <= start) continue;
    const bool silent = segment.label == dam::kSilence;
    if (silent && !script.phones.empty() && script.phones.back().label == dam::kSilence) {
      script.phones.back().end = end;
    } else {
      script.phones.push_back(
          {start, end, segment.label,
           silent || segment.word == kNoWord ? std::string() : words[segment.word].text});
      alignment.confidences.push_back(alignment.approximate ? 0 : rate_phone(segment));
    }
  }
  if (!script.phones.empty()) script.phones.back().end = duration;
}

// Stretches of speech that belong to no word.
void add_put_in(const std::vector<Segment>& segments, double duration, Alignment& alignment) {
  std::size_t before = 0;
  bool open = false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    if (segment.word != kNoWord) before = segment.word + 1;
    const bool speech =
        segment.foreign && segment.word == kNoWord && segment.label != dam::kSilence;
    if (!segment.foreign || segment.word != kNoWord) open = false;
    if (!speech) continue;
    if (!open) alignment.put_in.push_back({segment.start, 0, {}, before});
    open = true;
    PutIn& one = alignment.put_in.back();
    one.end = std::min(i + 1 < segments.size() ? segments[i + 1].start : duration, duration);
    one.phones.push_back(segment.label);
  }
}

void add_warnings(Alignment& alignment) {
  warn_of_left_out(alignment);
  warn_of_put_in(alignment);
  warn_of_doubts(alignment);
}

}  // namespace animeme::voice
