// Which lines a live head speaks when, and what becomes of those that it does not speak.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/formats/media/audio.h"
#include "tools/speech/talking/line_news_internal.h"
#include "tools/speech/talking/live_speaker_internal.h"

namespace animeme::speech {

namespace {

constexpr double kOpening = 0.1;     // seconds in which the mouth opens before sound that is late
constexpr double kLead = 0.5;        // seconds before its sound in which a piece bears on the mouth
constexpr double kLeastLead = 0.1;   // likewise, where more may be known of it until then
constexpr double kPatience = 0.1;    // seconds that a piece behind a pause waits for the same
constexpr float kAudible = 0.003F;   // of full scale
constexpr double kSoundFade = 0.02;  // seconds, of sound that is cut off
constexpr double kSettling = 0.2;    // seconds from there on until all is at rest
// Index of the first sample for which `audible` holds, the size if there is none.
template <class Audible>
std::int64_t first_sample(const std::vector<float>& samples, Audible audible) {
  return std::find_if(samples.begin(), samples.end(), audible) - samples.begin();
}

}  // namespace

// Presentation time at which all that has begun is over.
double LiveSpeaker::Impl::end_of_speech() const {
  return std::max(frame_due(), double(sound_end) / options.voice_rate);
}

void LiveSpeaker::Impl::collect(double now) {
  take_line();
  // After that: what is told of may stand in the way of the line that was taken.
  const double time = std::min(now, frame_due());
  for (const LineNews& news : lines->take_news()) follow(news, time);
}

// A line is taken when it can begin, so that all others can still be put in order.
void LiveSpeaker::Impl::take_line() {
  if (waiting || paused || held || face.closing()) return;
  const bool speaking = face.speaking();
  if (speaking && end_of_speech() >= frame_due() + kLead) return;
  // What is not known yet may come before it is too late.
  if (const auto since = lines->improvable_since()) {
    const double lead = speaking ? end_of_speech() - frame_due() : 0;
    if (lead >= kLeastLead) return;
    if (lead <= 0 && clock->now() < *since + kPatience) return;
  }
  while (auto line = lines->take(speaking)) {
    if (line->mark) {
      LineEvent mark{.what = LineEvent::What::mark, .time = end_of_speech(), .id = {}};
      mark.text = line->id;
      events.add(std::move(mark));
      continue;
    }
    const bool waited = speaking || line->arrived < silent_since;
    waiting = Waiting{std::move(*line), waited};
    return;
  }
}

void LiveSpeaker::Impl::follow(const LineNews& news, double time) {
  if (direct_face(face, news)) return;
  if (news.what == LineNews::What::word) {
    if (waiting && waiting->line.line == news.line && waiting->line.words) {
      waiting->line.words->push_back({news.start, news.start + news.duration, news.text});
    } else {
      events.add_word(news.line, news.start, news.text, news.duration);
    }
    return;
  }
  LineEvent event = event_of(news, time);
  if (news.what == LineNews::What::cancelled && news.part) {
    events.cancel_parts(std::move(event));
    return;
  }
  events.add(std::move(event));
  if (news.what == LineNews::What::paused) return pause();
  if (news.what == LineNews::What::resumed) paused = false;
  const bool all = news.what == LineNews::What::stopped;
  if (!all && news.what != LineNews::What::dropped) return;
  if (all) stop(news, time);
  if (waiting && waiting->line.line < news.line) {
    cancel(waiting->line, all ? "stopped" : "dropped");
    waiting.reset();
  }
}

void LiveSpeaker::Impl::cancel(const SpokenLine& line, const std::string& why) {
  LineEvent event{.what = LineEvent::What::cancelled, .time = frame_due(), .line = line.line};
  event.id = line.id;
  event.why = why;
  if (line.whole == 0) return events.add(std::move(event));
  event.line = line.whole;
  events.cancel_parts(std::move(event));
}

// The next frame is the first in which the mouth closes.
void LiveSpeaker::Impl::stop(const LineNews& news, double time) {
  const bool heard = sound && sound_end > sound->made();
  if (face.speaking() || heard) {
    fall_silent(news.at);  // what came with it or after it has not waited
    traces.stop();
  }
  paused = false;
  held.reset();
  events.cut(time, news.line, "stopped");
}

void LiveSpeaker::Impl::fall_silent(double at) {
  if (auto ok = face.cut(); !ok) warnings.push_back(ok.error().message);
  const auto fade = std::llround(kSoundFade * options.voice_rate);
  if (sound) sound->end_at(sound->made() + fade, fade);
  settled = frame_due() + kSettling;
  silent_since = at;
  sound_end = 0;
}

// As stop(), but what is left to say is kept, with its sound and its events.
void LiveSpeaker::Impl::pause() {
  paused = true;
  if (held) return;
  const bool heard = sound && sound_end > sound->made();
  if (!face.speaking() && !heard) return;
  Held rest;
  rest.at = std::max(frame_due(), sound_made());
  rest.script = face.rest(rest.at - frame_due());
  if (heard) {
    rest.samples = sound->rest();
    rest.length = sound_end - sound->made();
  }
  events.hold(rest.at);
  fall_silent(clock->now());
  held = std::move(rest);
}

// Lays what was held behind what has been made. False: it cannot begin yet.
bool LiveSpeaker::Impl::goes_on() {
  if (!held) return true;
  if (face.closing()) return false;
  Held rest = std::move(*held);
  held.reset();
  const double seconds = std::max(rest.script.duration(), double(rest.length) / options.voice_rate);
  if (rest.script.phones.empty()) {
    rest.script.phones.push_back({0, std::max(seconds, kOpening), std::string(dam::kSilence), {}});
  }
  const std::int64_t start = place_after_the_last();
  const double wait = std::max(double(start) / options.voice_rate - frame_due(), 0.0);
  if (auto shown = face.join(rest.script, wait, LineMoods{mood, {}}); !shown) {
    warnings.push_back("the face rests: " + shown.error().message);
  }
  if (sound) sound->add(start, std::move(rest.samples));
  sound_end = start + std::llround(seconds * options.voice_rate);
  events.go_on(double(start) / options.voice_rate - rest.at);
  return true;
}

// Where a line goes that joins the one before: at its end, if that has not been made.
std::int64_t LiveSpeaker::Impl::place_after_the_last() const {
  const auto now = std::llround(frame_due() * options.voice_rate);
  const std::int64_t made = sound ? sound->made() : 0;
  if (sound_end >= std::max<std::int64_t>(made, now) && sound_end > 0) return sound_end;
  return std::max<std::int64_t>(made, now + std::llround(kOpening * options.voice_rate));
}

// Gives where its first sign will be.
std::int64_t LiveSpeaker::Impl::lay(std::int64_t start, SpokenLine& line) {
  std::vector<float>& samples = line.speech.audio.samples;
  const double seconds = line.speech.script.duration();
  const auto length = std::max<std::int64_t>(std::int64_t(samples.size()),
                                             std::llround(seconds * options.voice_rate));
  sound_end = start + length;
  if (!sound) return 0;
  const auto audible = first_sample(samples, [](float x) { return std::abs(x) >= kAudible; });
  sound->add(start, std::move(samples));
  return std::llround(double(start + audible) / options.voice_rate * info.audio->sample_rate);
}

Result<void> LiveSpeaker::Impl::convert(media::Pcm& audio) const {
  if (audio.sample_rate == options.voice_rate || audio.samples.empty()) return {};
  Result<media::Pcm> converted = media::resample(audio, options.voice_rate);
  if (!converted) return converted.error();
  audio = std::move(*converted);
  return {};
}

// The first sound of a line must not lie where the sound has been made already.
bool LiveSpeaker::Impl::has_to_wait(const SpokenLine& line) const {
  if (face.closing()) return true;
  if (line.joins) return false;
  if (face.speaking()) return true;
  const media::Pcm& audio = line.speech.audio;
  const auto silence = first_sample(audio.samples, [](float x) { return x != 0; });
  return sound_made() - double(silence) / audio.sample_rate > frame_due();
}

// A line that cannot be shown is left out; the next one may be shown.
void LiveSpeaker::Impl::begin_lines(double now) {
  if (paused || !goes_on()) return;
  while (waiting && !has_to_wait(waiting->line)) {
    SpokenLine& line = waiting->line;
    LineTrace trace;
    trace.waited = waiting->waited;
    trace.arrived = line.arrived;
    trace.spoken = line.spoken;
    if (auto ok = begin(line, trace); !ok) {
      warnings.push_back("\"" + line.text.substr(0, 60) + "\" is left out: " + ok.error().message);
      cancel(line, ok.error().message);
    }
    waiting.reset();
    collect(now);
  }
}

Result<void> LiveSpeaker::Impl::begin(SpokenLine& line, LineTrace& trace) {
  trace.begun = clock->now();
  if (auto ok = convert(line.speech.audio); !ok) return ok;
  const dam::Script& script = line.speech.script;
  const LineMoods moods{line.mood, line.speech.moods};
  mood = line.mood;
  Result<Line> shown = Line{};
  std::int64_t start = 0;
  if (line.joins) {
    // Its face is made with that of the piece before, so that the mouth goes from one to the other
    // as within a sentence.
    start = place_after_the_last();
    const double wait = std::max(double(start) / options.voice_rate - frame_due(), 0.0);
    shown = face.join(script, wait, moods, &line.prosody, line.goes_on);
    if (!shown && !line.speech.audio.samples.empty()) {
      // Sound is heard in any case.
      warnings.push_back("the face rests: " + shown.error().message);
      const double seconds = line.speech.audio.duration();
      shown = face.join({{{0, seconds, std::string(dam::kSilence), {}}}}, wait);
    }
  } else {
    start = std::llround(frame_due() * options.voice_rate);
    shown = face.say(script, moods, &line.prosody);
  }
  if (!shown) return shown.error();
  const LineTraces::Signs signs{shown->first_moved * frame_ticks, lay(start, line)};
  events.begin(line, double(start) / options.voice_rate, double(sound_end) / options.voice_rate);
  trace.synthesised = clock->now();
  traces.add(trace, signs);
  return {};
}

}  // namespace animeme::speech
