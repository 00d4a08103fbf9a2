#include "tools/speech/voice/align.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "dam/script/timings.h"
#include "dam/script/words.h"
#include "tools/speech/voice/confidence.h"
#include "tools/speech/voice/parted_words.h"
#include "tools/speech/voice/pronunciation.h"
#include "tools/speech/voice/recogniser.h"
#include "tools/speech/voice/speech_part.h"

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

// The position in the transcript, in words for the reader: `first` to `end` are not counted.
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

std::string phones_of(const Insertion& one) {
  std::string phones;
  for (std::size_t k = 0; k < one.phones.size() && k < kPhonesNamed; ++k) {
    phones += (k > 0 ? " " : "") + one.phones[k];
  }
  return phones + (one.phones.size() > kPhonesNamed ? " ..." : "");
}

std::string span_of(const Insertion& one) {
  return in_seconds(one.start) + " to " + in_seconds(one.end) + " s";
}

// What is said where the words from `first` on are not: another word, or they sound otherwise than
// the dictionary has them.
std::string instead_of(const Alignment& alignment, std::size_t first) {
  std::string what;
  for (const Insertion& one : alignment.inserted) {
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

void warn_of_insertions(Alignment& alignment) {
  std::size_t count = 0;
  for (const Insertion& one : alignment.inserted) {
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

// Fills Alignment::script and confidences; silences that touch are one.
void add_script(const std::vector<Segment>& segments, const std::vector<SpokenWord>& words,
                double duration, Alignment& alignment) {
  dam::Script& script = alignment.script;
  std::size_t before = kNoWord;
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
      const bool in_word = !silent && segment.word != kNoWord;
      const bool begins = in_word && segment.word != before;
      if (in_word) before = segment.word;
      script.phones.push_back(
          {start, end, segment.label, in_word ? words[segment.word].text : std::string()});
      if (in_word) dam::link_phone(script.phones, script.phones.size() - 1, begins);
      alignment.confidences.push_back(alignment.approximate ? 0 : rate_phone(segment));
    }
  }
  if (!script.phones.empty()) script.phones.back().end = duration;
}

// Stretches of speech that belong to no word.
// Fills Alignment::inserted.
void add_insertions(const std::vector<Segment>& segments, double duration, Alignment& alignment) {
  std::size_t before = 0;
  bool open = false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    if (segment.word != kNoWord) before = segment.word + 1;
    const bool speech =
        segment.foreign && segment.word == kNoWord && segment.label != dam::kSilence;
    if (!segment.foreign || segment.word != kNoWord) open = false;
    if (!speech) continue;
    if (!open) alignment.inserted.push_back({segment.start, 0, {}, before});
    open = true;
    Insertion& one = alignment.inserted.back();
    one.end = std::min(i + 1 < segments.size() ? segments[i + 1].start : duration, duration);
    one.phones.push_back(segment.label);
  }
}

// Says which words are not said, which speech the text does not have, and which words hardly fit.
void add_warnings(Alignment& alignment) {
  warn_of_left_out(alignment);
  warn_of_insertions(alignment);
  warn_of_doubts(alignment);
}

constexpr double kMinSeconds = 0.1;
constexpr double kMinPhoneSeconds = 0.01;  // one frame: less cannot be

Result<void> check_audio(const media::Pcm& audio) {
  if (audio.sample_rate != kAlignRate) {
    return make_error(Code::invalid_argument, "the aligner needs audio of 16000 Hz, this has " +
                                                  std::to_string(audio.sample_rate) +
                                                  " Hz; resample it first");
  }
  if (audio.duration() < kMinSeconds) {
    return make_error(Code::truncated, "less than 0.1 s of audio to align; is the file complete?");
  }
  if (audio.duration() > kMaxAlignSeconds) {
    return make_error(Code::out_of_range, "more than four hours of sound to align; split it");
  }
  return {};
}

struct Stretch {
  double start = 0, end = 0;
};

// From the first to the last 20 ms that are louder than a twentieth of the loudest.
Stretch loud_part(const std::vector<float>& samples) {
  constexpr std::size_t kBlock = kAlignRate / 50;
  std::vector<double> levels;
  for (std::size_t at = 0; at + kBlock <= samples.size(); at += kBlock) {
    double sum = 0;
    for (std::size_t i = at; i < at + kBlock; ++i) sum += double(samples[i]) * samples[i];
    levels.push_back(std::sqrt(sum));
  }
  if (levels.empty()) return {0, double(samples.size()) / kAlignRate};
  const double threshold = 0.05 * *std::max_element(levels.begin(), levels.end());
  const auto loud = [&](double level) { return level >= threshold; };
  const auto first = std::find_if(levels.begin(), levels.end(), loud);
  const auto last = std::find_if(levels.rbegin(), levels.rend(), loud);
  const double seconds = double(kBlock) / kAlignRate;
  return {double(first - levels.begin()) * seconds, double(levels.rend() - last) * seconds};
}

std::vector<Segment> spread_evenly(const SpeechPart& part, const std::vector<SpokenWord>& words) {
  double total = 0;
  for (const SpokenWord& word : words) {
    if (word.variants.empty()) continue;
    for (const std::string& label : word.variants[0]) {
      if (label != dam::kSilence) total += dam::usual_duration(label);
    }
  }
  Stretch loud = loud_part(part.samples);
  const double first = double(part.first) / kAlignRate;
  loud.start += first;
  loud.end += first;
  std::vector<Segment> segments;
  if (loud.start > 0) segments.push_back({0, std::string(dam::kSilence), kNoWord, 0, 1});
  double done = 0;
  for (std::size_t w = 0; w < words.size(); ++w) {
    if (words[w].variants.empty()) continue;
    for (const std::string& label : words[w].variants[0]) {
      if (label == dam::kSilence) continue;  // between the words of a reading
      segments.push_back({loud.start + (loud.end - loud.start) * done / total, label, w, 0, 1});
      done += dam::usual_duration(label);
    }
  }
  segments.push_back({loud.end, std::string(dam::kSilence), kNoWord, 0, 1});
  return segments;
}

std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// The number of words that were found helps to locate the mistake.
Error refusal(const Alignment& found, const AlignOptions& options) {
  std::size_t unsaid = 0;
  std::string first;
  for (const AlignedWord& word : found.words) {
    if (word.said || !word.known) continue;
    if (++unsaid == 1) first = word.text;
  }
  std::string what = "the transcript does not fit the recording (confidence " +
                     two_digits(found.confidence) + ", at least " +
                     two_digits(options.least_confidence) + "): ";
  if (unsaid > 0) {
    what += std::to_string(unsaid) + " of " + std::to_string(found.words.size()) +
            (unsaid == 1 ? " words is" : " words are") + " not found in it, the first is '" +
            first + "'; ";
  }
  return make_error(Code::out_of_range, what + "a different text, too much noise, or no speech");
}

// Noise makes right texts fit as badly as wrong ones do in quiet, but better than wrong texts do in
// the same noise. What they explain (Placement::explained) is chosen on every twelfth sentence of
// grid_s1 in noise of 5 dB; other voices are reported (tools/speech/voice/measured.md).
bool may_be_the_text(double confidence, double explained, const std::vector<double>& wrong,
                     double snr) {
  constexpr double kNoisy = 18;  // dB
  constexpr double kLeastInQuiet = 0.15, kAheadInQuiet = 0.02;
  // The less sure it is by itself, the further ahead it has to be.
  constexpr struct {
    double confidence, ahead;
  } kInNoise[] = {{0.1, -0.02}, {0.04, 0.02}, {0.01, 0.06}};
  const double ahead = explained - *std::max_element(wrong.begin(), wrong.end());
  if (snr >= kNoisy) return ahead >= kAheadInQuiet && confidence >= kLeastInQuiet;
  return std::any_of(std::begin(kInNoise), std::end(kInNoise), [&](const auto& least) {
    return confidence >= least.confidence && ahead >= least.ahead;
  });
}

std::size_t least_phones(const std::vector<SpokenWord>& words) {
  std::size_t count = 0;
  for (const SpokenWord& word : words) {
    const auto phones = [](const Labels& labels) {
      return labels.size() - std::size_t(std::count(labels.begin(), labels.end(), dam::kSilence));
    };
    std::size_t least = word.variants.empty() ? 0 : phones(word.variants[0]);
    for (const Labels& variant : word.variants) least = std::min(least, phones(variant));
    count += least;
  }
  return count;
}

}  // namespace

Result<Alignment> align(media::Pcm audio, std::string_view transcript,
                        const AlignOptions& options) {
  if (auto good = check_audio(audio); !good) return good.error();
  const double seconds = audio.duration();
  if (transcript.size() > kMostTranscript) {
    return make_error(Code::out_of_range, "a transcript of more than 1 MB; split it");
  }
  const auto parted = parted_words(transcript, options.language);
  if (!parted) return parted.error();
  Alignment result;
  if (parted->empty()) {
    return make_error(Code::invalid_argument, "the transcript has no words; give what is said");
  }
  if (auto good = check_recogniser(options); !good) return good.error();
  const auto words = find_pronunciations(*parted, options, result.warnings);
  if (!words) return words.error();
  if (std::all_of(words->begin(), words->end(),
                  [](const SpokenWord& word) { return word.variants.empty(); })) {
    return make_error(Code::invalid_argument,
                      "no word of the transcript can be pronounced; is "
                      "the language right?");
  }
  if (double(least_phones(*words)) * kMinPhoneSeconds > seconds) {
    return make_error(Code::out_of_range, "the audio is too short for its transcript of " +
                                              std::to_string(least_phones(*words)) +
                                              " phones; does the text belong to this recording?");
  }
  const SpeechPart part = find_speech(std::move(audio.samples));
  auto recognised = recognise(part, *words, options);
  if (!recognised) return recognised.error();
  auto& segments = recognised->segments;
  const bool any = std::any_of(segments.begin(), segments.end(), [](const Segment& segment) {
    return segment.word != kNoWord && !segment.foreign;
  });
  if (!any) {
    if (options.least_confidence > 0) {
      return make_error(Code::out_of_range,
                        "the recogniser cannot fit the transcript to the recording; check that the "
                        "text is what is said, and that there is speech");
    }
    result.approximate = true;
    result.warnings.push_back(
        "the recogniser cannot fit the transcript to the recording, so the phones are spread over "
        "its loud part; check that the text is what is said");
    segments = spread_evenly(part, *words);
  } else {
    result.confidence = rate_recording(*recognised, *words, is_english(options.language));
  }
  result.words = rate_words(segments, *words, seconds);
  if (result.confidence < options.least_confidence) {
    const auto wrong = explained_by_wrong_texts(part, *words, options);
    if (!wrong) return wrong.error();
    if (!may_be_the_text(result.confidence, recognised->explained, *wrong, part.snr)) {
      return refusal(result, options);
    }
    result.warnings.push_back("the transcript hardly fits the recording (confidence " +
                              two_digits(result.confidence) +
                              "), yet better than other texts do; check it, or record it again "
                              "with less noise");
  }
  add_script(segments, *words, seconds, result);
  add_insertions(segments, seconds, result);
  if (result.approximate) {
    for (AlignedWord& word : result.words) word.confidence = 0;
  } else {
    add_warnings(result);
  }
  return result;
}

}  // namespace animeme::voice
