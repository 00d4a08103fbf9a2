#include "tools/speech/voice/align.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "dam/script/timings.h"
#include "tools/speech/voice/alignment_report.h"
#include "tools/speech/voice/confidence.h"
#include "tools/speech/voice/denoise.h"
#include "tools/speech/voice/parted_words.h"
#include "tools/speech/voice/pronunciation.h"
#include "tools/speech/voice/recogniser.h"
#include "tools/speech/voice/transcript.h"

namespace animeme::voice {
namespace {

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
  const double threshold = 0.05 * *std::max_element(levels.begin(), levels.end());
  const auto loud = [&](double level) { return level >= threshold; };
  const auto first = std::find_if(levels.begin(), levels.end(), loud);
  const auto last = std::find_if(levels.rbegin(), levels.rend(), loud);
  const double seconds = double(kBlock) / kAlignRate;
  return {double(first - levels.begin()) * seconds, double(levels.rend() - last) * seconds};
}

std::vector<Segment> spread_evenly(const std::vector<float>& samples,
                                   const std::vector<SpokenWord>& words) {
  double total = 0;
  for (const SpokenWord& word : words) {
    if (word.variants.empty()) continue;
    for (const std::string& label : word.variants[0]) {
      if (label != dam::kSilence) total += dam::usual_duration(label);
    }
  }
  const Stretch loud = loud_part(samples);
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

// How many words of the text are found is what helps whoever looks for the mistake.
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

Result<Alignment> align(const media::Pcm& audio, std::string_view transcript,
                        const AlignOptions& options) {
  if (auto good = check_audio(audio); !good) return good.error();
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
  if (double(least_phones(*words)) * kMinPhoneSeconds > audio.duration()) {
    return make_error(Code::out_of_range, "the audio is too short for its transcript of " +
                                              std::to_string(least_phones(*words)) +
                                              " phones; does the text belong to this recording?");
  }
  const auto samples = denoised(audio.samples);
  auto recognised = recognise(samples, *words, options);
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
    segments = spread_evenly(samples, *words);
  } else {
    result.confidence = rate_recording(*recognised, *words, is_english(options.language));
  }
  result.words = rate_words(segments, *words, audio.duration());
  if (result.confidence < options.least_confidence) return refusal(result, options);
  add_script(segments, *words, audio.duration(), result);
  add_put_in(segments, audio.duration(), result);
  if (result.approximate) {
    for (AlignedWord& word : result.words) word.confidence = 0;
  } else {
    add_warnings(result);
  }
  return result;
}

}  // namespace animeme::voice
