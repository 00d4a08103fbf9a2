#include "tools/speech/talking/cue_voice.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "tools/formats/media/stretch.h"

namespace animeme::speech {
namespace {

constexpr double kShortestFittedPause = 0.06;  // seconds that stay of a pause
constexpr double kGapOfCues = 0.04;            // seconds
constexpr double kFitSlack = 0.01;             // seconds that nobody hears
constexpr int kFitAttempts = 4;                // to meet a length by the speed
constexpr double kLongestFitted = 86400;
constexpr double kEarly = 0.15, kLate = 0.1;  // seconds by which a recorded cue may be off

// UTF-8.
std::size_t characters_of(const std::string& text) {
  return std::size_t(std::count_if(text.begin(), text.end(),
                                   [](char c) { return (std::uint8_t(c) & 0xC0) != 0x80; }));
}

bool is_long_pause(const dam::Phone& phone) {
  return phone.label == dam::kSilence && phone.duration() > kShortestFittedPause;
}

// Takes up to `wanted` seconds from the pauses of a speech, from each the same share. Returns what
// it took.
double shorten_pauses(voice::Speech& speech, double wanted) {
  double possible = 0;
  for (const dam::Phone& phone : speech.script.phones)
    if (is_long_pause(phone)) possible += phone.duration() - kShortestFittedPause;
  if (!(possible > 0) || !(wanted > 0)) return 0;
  const double share = std::min(1.0, wanted / possible);
  const double rate = speech.audio.sample_rate;
  std::vector<float> samples;
  std::size_t from = 0;
  double taken = 0;
  const auto place = [&](double seconds) {
    return std::min(std::size_t(std::llround(seconds * rate)), speech.audio.samples.size());
  };
  for (dam::Phone& phone : speech.script.phones) {
    const dam::Phone before = phone;
    phone.start -= taken;
    if (is_long_pause(before)) {
      // From its middle, where it is most silent.
      const double cut = share * (before.duration() - kShortestFittedPause);
      const double middle = (before.start + before.end) / 2;
      const std::size_t first = place(middle - cut / 2), last = place(middle + cut / 2);
      samples.insert(samples.end(), speech.audio.samples.begin() + std::ptrdiff_t(from),
                     speech.audio.samples.begin() + std::ptrdiff_t(first));
      from = last;
      taken += double(last - first) / rate;
    }
    phone.end = before.end - taken;
  }
  samples.insert(samples.end(), speech.audio.samples.begin() + std::ptrdiff_t(from),
                 speech.audio.samples.end());
  speech.audio.samples = std::move(samples);
  for (dam::MoodSpan& span : speech.moods) {
    span.start = std::max(0.0, span.start - taken);
    span.end = std::max(span.start, span.end - taken);
  }
  return taken;
}

// All of a speech faster, at its pitch.
void hasten(voice::Speech& speech, double more) {
  voice::Speech part =
      stretched_part(speech.audio, speech.script, 0, speech.audio.duration(), more);
  speech.audio = std::move(part.audio);
  speech.script = std::move(part.script);
  for (dam::MoodSpan& span : speech.moods) span.start /= more, span.end /= more;
  for (voice::SpokenLanguage& one : speech.languages) one.start /= more, one.end /= more;
}

// Speech of a cue, as near to `wanted` seconds as the range allows.
Result<voice::Speech> speak_within(std::size_t cue, double wanted, const SpeakAtSpeed& speak,
                                   const FitRange& range, FittedCue& fitted) {
  Result<voice::Speech> speech = speak(cue, 1);
  if (!speech) return speech;
  double speed = 1;
  for (int attempt = 0;; ++attempt) {
    const double seconds = speech->audio.duration();
    voice::Speech shorter = *speech;
    const double taken = shorten_pauses(shorter, seconds - wanted);
    const double left = seconds - taken;
    const bool slow = left < wanted - kFitSlack && speed > range.slowest;
    const bool fast = left > wanted + kFitSlack && speed < range.fastest;
    bool ended = (!slow && !fast) || attempt + 1 == kFitAttempts || !(wanted > 0);
    if (!ended) {
      // A voice that is asked for twice the speed need not be twice as fast: again from what it
      // was.
      const double next = std::clamp(speed * left / wanted, range.slowest, range.fastest);
      Result<voice::Speech> other = speak(cue, next);
      if (!other) return other;
      ended = std::abs(other->audio.duration() - seconds) < 1e-6;  // it cannot
      if (!ended) {
        speech = std::move(other);
        speed = next;
        continue;
      }
    }
    fitted.speed = speed;
    fitted.shortened = taken;
    // Voices round their speed, or have one alone: what is missing is stretched.
    if (fast && wanted > 0) {
      const double more = std::min(left / wanted, range.fastest / speed);
      hasten(shorter, more);
      fitted.speed = speed * more;
      fitted.shortened = taken / more;
    }
    return shorter;
  }
}

// Appends a speech that begins at `start` seconds. `given`: samples that are no longer in `all`.
void place_speech(voice::Speech& all, voice::Speech one, double start, std::size_t given) {
  const double rate = all.audio.sample_rate;
  const auto first = std::max(given, std::size_t(std::llround(start * rate)));
  all.audio.samples.resize(std::max(all.audio.samples.size(), first - given), 0.0f);
  const double at = double(first) / rate;
  if (at > all.script.duration()) {
    all.script.phones.push_back({all.script.duration(), at, std::string(dam::kSilence), {}});
  }
  all.audio.samples.insert(all.audio.samples.end(), one.audio.samples.begin(),
                           one.audio.samples.end());
  for (dam::Phone& phone : one.script.phones) {
    phone.start += at;
    phone.end += at;
    if (!all.script.phones.empty()) {
      dam::Phone& last = all.script.phones.back();
      phone.start = std::max(phone.start, last.end);
      if (phone.label == dam::kSilence && last.label == dam::kSilence) {
        last.end = std::max(last.end, phone.end);
        continue;
      }
    }
    if (phone.end > phone.start) all.script.phones.push_back(std::move(phone));
  }
  for (dam::MoodSpan& span : one.moods) {
    span.start += at, span.end += at;
    all.moods.push_back(std::move(span));
  }
  for (voice::SpokenLanguage& part : one.languages) {
    part.start += at, part.end += at;
    all.languages.push_back(std::move(part));
  }
  for (std::string& text : one.warnings) {
    if (std::find(all.warnings.begin(), all.warnings.end(), text) == all.warnings.end())
      all.warnings.push_back(std::move(text));
  }
  if (all.voice.empty()) all.voice = one.voice;
}

Result<void> check_cues(const std::vector<Cue>& cues, const FitRange& range) {
  const auto wrong = [](const std::string& what) {
    return make_error(Code::invalid_argument, what);
  };
  if (cues.empty()) return wrong("there are no subtitles to speak");
  if (!(range.slowest >= 0.5 && range.slowest <= 1 && range.fastest >= 1 && range.fastest <= 2))
    return wrong("a voice is fitted within 0.5 to 1 and 1 to 2 of its speed");
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const bool ascends = cues[i].end > cues[i].start && cues[i].start >= 0 &&
                         (i == 0 || cues[i].start >= cues[i - 1].start);
    if (!ascends) return wrong("subtitle " + std::to_string(i + 1) + " has no time of its own");
    if (!(cues[i].end <= kLongestFitted))
      return make_error(Code::out_of_range, "the subtitles last longer than a day");
  }
  return {};
}

}  // namespace

Result<FitRange> parse_fit_range(const std::string& text) {
  FitRange range;
  const std::size_t dash = text.find('-');
  const auto number = [](const std::string& part, double& value) {
    const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), value);
    return status == std::errc() && end == part.data() + part.size();
  };
  const bool read = dash != std::string::npos && number(text.substr(0, dash), range.slowest) &&
                    number(text.substr(dash + 1), range.fastest);
  if (!read || !(range.slowest >= 0.5 && range.slowest <= 1) ||
      !(range.fastest >= 1 && range.fastest <= 2)) {
    return make_error(Code::invalid_argument,
                      "'" + text + "' is not SLOWEST-FASTEST, such as 0.8-1.3");
  }
  return range;
}

Result<FittedSpeech> fit_cues(const std::vector<Cue>& cues, const SpeakAtSpeed& speak,
                              const FitRange& range, const TakeSound& take) {
  if (auto ok = check_cues(cues, range); !ok) return ok.error();
  FittedSpeech all;
  double free = 0;        // end of what is said
  std::size_t given = 0;  // samples that were taken
  for (std::size_t i = 0; i < cues.size(); ++i) {
    FittedCue fitted;
    fitted.cue = cues[i];
    // Behind one that is late it has less time.
    fitted.start = std::max(cues[i].start, i == 0 ? 0.0 : free + kGapOfCues);
    double end = cues[i].end;
    if (i + 1 < cues.size()) end = std::min(end, cues[i + 1].start - kGapOfCues);
    const double wanted = std::max(0.0, end - fitted.start);
    Result<voice::Speech> speech = speak_within(i, wanted, speak, range, fitted);
    if (!speech) {
      Error error = std::move(speech).error();
      error.message = "subtitle " + std::to_string(i + 1) + ": " + error.message;
      return error;
    }
    if (i == 0) {
      all.speech.audio.sample_rate = speech->audio.sample_rate;
      // At once: what grows by itself takes up to three times as much.
      const double longest = take ? 0 : cues.back().end + 1;
      all.speech.audio.samples.reserve(std::size_t(longest * speech->audio.sample_rate));
    }
    fitted.seconds = speech->audio.duration();
    fitted.late = std::max(0.0, fitted.start + fitted.seconds - cues[i].end);
    if (fitted.seconds > wanted + 2 * kFitSlack && fitted.seconds > 0) {
      const double share = std::clamp(1 - wanted / fitted.seconds, 0.0, 1.0);
      fitted.cut = std::size_t(std::ceil(share * double(characters_of(cues[i].text))));
    } else {
      fitted.late = fitted.late > 2 * kFitSlack ? fitted.late : 0;
    }
    free = fitted.start + fitted.seconds;
    place_speech(all.speech, std::move(*speech), fitted.start, given);
    if (take) {
      std::vector<float>& samples = all.speech.audio.samples;
      if (auto taken = take(samples, all.speech.audio.sample_rate); !taken) return taken.error();
      given += samples.size();
      samples.clear();
    }
    all.cues.push_back(std::move(fitted));
  }
  return all;
}

voice::Speech stretched_part(const media::Pcm& audio, const dam::Script& script, double start,
                             double end, double speed) {
  voice::Speech part;
  part.audio.sample_rate = audio.sample_rate;
  const double rate = audio.sample_rate;
  const auto place = [&](double seconds) {
    return std::min(std::size_t(std::llround(std::max(0.0, seconds) * rate)), audio.samples.size());
  };
  const std::size_t first = place(start), last = std::max(first, place(end));
  const std::span<const float> samples(audio.samples.data() + first, last - first);
  if (speed == 1) {
    part.audio.samples.assign(samples.begin(), samples.end());
  } else {
    media::TimeStretch stretch(audio.sample_rate, 1, speed);
    stretch.push(samples, part.audio.samples);
    stretch.finish(part.audio.samples);
  }
  const double begin = double(first) / rate, stop = double(last) / rate;
  for (const dam::Phone& phone : script.phones) {
    if (phone.end <= begin || phone.start >= stop) continue;
    dam::Phone moved = phone;
    moved.start = (std::max(phone.start, begin) - begin) / speed;
    moved.end = (std::min(phone.end, stop) - begin) / speed;
    if (moved.end > moved.start) part.script.phones.push_back(std::move(moved));
  }
  return part;
}

std::vector<RecordedCue> find_cues(std::span<const std::string> texts,
                                   std::span<const voice::AlignedWord> words) {
  std::vector<RecordedCue> found(texts.size());
  std::vector<std::size_t> said(texts.size());
  std::size_t cue = 0, from = 0;
  for (const voice::AlignedWord& word : words) {
    for (std::size_t i = cue; i < texts.size(); ++i) {
      const std::size_t at = texts[i].find(word.text, i == cue ? from : 0);
      if (at == std::string::npos) continue;
      cue = i;
      from = at + word.text.size();
      break;
    }
    if (!word.said || cue >= texts.size() || !(word.end > word.start)) continue;
    RecordedCue& one = found[cue];
    const double before = one.confidence.value_or(0) * double(said[cue]);
    if (said[cue]++ == 0) one.start = word.start;
    one.end = std::max(one.end, word.end);
    one.confidence = (before + word.confidence) / double(said[cue]);
  }
  return found;
}

Result<FittedRecording> fit_recording(const std::vector<Cue>& cues,
                                      std::span<const RecordedCue> said, const media::Pcm& audio,
                                      const dam::Script& script, const FitRange& range) {
  if (auto ok = check_cues(cues, range); !ok) return ok.error();
  if (said.size() != cues.size()) {
    return make_error(Code::invalid_argument, "each subtitle has one place in the recording");
  }
  FittedRecording result;
  bool stays = true;
  std::vector<Cue> places = cues;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const bool silent = !(said[i].end > said[i].start);
    const bool in_time =
        silent || (said[i].start >= cues[i].start - kEarly && said[i].end <= cues[i].end + kLate);
    stays = stays && in_time;
    FittedCue one{cues[i]};
    one.start = silent ? cues[i].start : said[i].start;
    one.seconds = said[i].end - said[i].start;
    one.confidence = said[i].confidence;
    result.cues.push_back(std::move(one));
    if (in_time && !silent) {
      places[i].start = i == 0 ? said[i].start : std::max(said[i].start, places[i - 1].start);
      places[i].end = std::max({cues[i].end, said[i].end, places[i].start + kGapOfCues});
    } else if (i > 0) {
      places[i].start = std::max(places[i].start, places[i - 1].start);
    }
  }
  if (stays) return result;
  const auto speak = [&](std::size_t cue, double speed) -> Result<voice::Speech> {
    return stretched_part(audio, script, said[cue].start, said[cue].end, speed);
  };
  auto fitted = fit_cues(places, speak, {1, range.fastest});
  if (!fitted) return fitted.error();
  for (std::size_t i = 0; i < cues.size(); ++i) {
    FittedCue& one = fitted->cues[i];
    one.cue = cues[i];
    one.confidence = said[i].confidence;
    one.late = one.cut > 0 ? std::max(one.late, one.start + one.seconds - cues[i].end) : one.late;
  }
  result.cues = std::move(fitted->cues);
  result.speech = std::move(fitted->speech);
  return result;
}

Result<std::vector<Cue>> cues_of(const dam::Timings& timings) {
  std::vector<Cue> cues;
  std::int64_t line = 0;
  for (const dam::TimedLabel& label : timings.labels) {
    if (label.label.empty()) continue;
    if (!label.is_word) {
      return make_error(Code::unsupported,
                        "the script has phones, which are said already; give subtitles");
    }
    // Words of one cue touch, and come from one place of the file.
    const bool same = !cues.empty() && label.line != 0 && label.line == line &&
                      label.start <= cues.back().end + 1e-6;
    if (same) {
      cues.back().text += " " + label.label;
      cues.back().end = label.end;
    } else {
      cues.push_back({label.start, label.end, label.label});
    }
    line = label.line;
  }
  if (cues.empty()) return make_error(Code::unsupported, "there are no subtitles in the file");
  return cues;
}

}  // namespace animeme::speech
