// Sound that is made elsewhere and does not come in time: the mouth rests, both go on together, and
// face and sound are as near to each other after ten minutes as at the begin. Clocks are the
// test's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "dam/model/builtin.h"
#include "tools/formats/media/audio.h"
#include "tools/speech/talking/line_queue.h"
#include "tools/speech/talking/live_speaker.h"
#include "tools/speech/talking/live_voice.h"
#include "tools/speech/talking/voice_driven_face.h"

namespace animeme::speech {
namespace underrun_test {

using media::LiveTrack;
using media::LiveUnit;

const dam::Model& character() {
  static const dam::Model model = std::move(*dam::builtin_model());
  return model;
}

// What was sent, decoded.
struct Received {
  fap::Sequence face;
  media::Pcm sound;
};

Received receive(media::LiveInput& input, const std::function<bool(double)>& before) {
  fba::AccessUnits units;
  media::EncodedAudio audio;
  audio.format = *input.info().audio;
  while (const auto due = input.next_due()) {
    if (!before(*due)) break;
    auto made = input.take(*due);
    EXPECT_TRUE(made);
    if (!made) break;
    for (const LiveUnit& unit : *made) {
      input.sent(unit, *due);
      if (unit.track == LiveTrack::face) {
        units.units.push_back({unit.bytes, unit.intra, 0, 1});
      } else {
        audio.packets.push_back({unit.bytes, unit.time, unit.duration});
      }
    }
  }
  Received got;
  const auto decoded = fba::decode(fba::join_access_units(units));
  EXPECT_TRUE(decoded);
  if (decoded) got.face = fba::face_sequence(*decoded);
  const auto pcm = media::decode_audio(audio);
  EXPECT_TRUE(pcm);
  if (pcm) got.sound = *pcm;
  return got;
}

double opening(const fap::Frame& frame) { return -(frame.value[4] + frame.value[5]); }

// Loudness of each millisecond.
std::vector<double> loudness(const media::Pcm& pcm) {
  std::vector<double> all;
  const int step = pcm.sample_rate / 1000;
  for (std::size_t at = 0; at + std::size_t(step) <= pcm.samples.size(); at += std::size_t(step)) {
    double sum = 0;
    for (int i = 0; i < step; ++i) sum += std::abs(pcm.samples[at + std::size_t(i)]);
    all.push_back(sum / step);
  }
  return all;
}

// Samples that a program sends in real time, but for a pause.
class PausingFeed : public SoundFeed {
 public:
  PausingFeed(const std::vector<float>& samples, int rate, const double& now, double pause_at,
              double pause, bool catches_up)
      : samples_(samples),
        rate_(rate),
        now_(now),
        from_(pause_at),
        to_(pause_at + pause),
        catches_up_(catches_up) {}
  std::vector<float> take(std::size_t most) override {
    const double sent = now_ < from_ ? now_
                        : now_ < to_ ? from_
                                     : now_ - (catches_up_ ? 0 : to_ - from_);
    const auto there = std::min(samples_.size(), std::size_t(std::max(0.0, sent + 0.02) * rate_));
    const std::size_t count = std::min(most, there - std::min(there, at_));
    const auto begin = samples_.begin() + std::ptrdiff_t(at_);
    at_ += count;
    return {begin, begin + std::ptrdiff_t(count)};
  }
  bool over() override { return at_ == samples_.size(); }

 private:
  const std::vector<float>& samples_;
  int rate_;
  const double& now_;
  double from_, to_;
  bool catches_up_;
  std::size_t at_ = 0;
};

// Seconds by which `late` follows `early` from `from` on (of late), where they agree best.
template <class Value>
double shift_of(const Value& early, const Value& late, double a_second, double from, double to,
                double most) {
  double best = 1e300, shift = 0;
  for (double by = 0; by <= most; by += 1 / a_second) {
    double sum = 0;
    for (double time = from; time < to; time += 1 / a_second) {
      sum += std::pow(late(time) - early(time - by), 2);
    }
    if (sum < best) best = sum, shift = by;
  }
  return shift;
}

TEST(Underrun, AVoiceThatPausesIsRestedAndGoesOnTogetherWithItsFace) {
  std::vector<float> samples;
  int rate = 0;
  for (const char* text : {"Bob may buy a map of Mobile.", "Wow, how loud you shout, my friend!",
                           "Papa made a big pie for Bobby."}) {
    const auto speech = voice::speak_text(text);
    if (!speech || !VoiceDrivenFace::open(character(), 16000, {}))
      GTEST_SKIP() << "no voice or no ears";
    rate = speech->audio.sample_rate;
    samples.insert(samples.end(), speech->audio.samples.begin(), speech->audio.samples.end());
  }
  const auto run = [&](double pause, bool catches_up) {
    double now = 0;
    LiveVoiceOptions options;
    options.audio = media::AudioSettings{media::AudioCodec::opus};
    auto voice = LiveVoice::open(
        character(), std::make_unique<PausingFeed>(samples, rate, now, 1.7, pause, catches_up),
        rate, options);
    EXPECT_TRUE(voice);
    return receive(**voice, [&now](double due) {
      now = due;
      return true;
    });
  };
  const Received whole = run(0, false);
  const auto loud = loudness(whole.sound);
  const double end = whole.sound.duration();
  for (const bool catches_up : {false, true}) {
    const Received paused = run(1, catches_up);
    const auto heard = loudness(paused.sound);
    // Sent at 1.7 s is heard 0.3 s later. A pause that is caught up is as long all the same.
    double most = 0;
    for (std::size_t i = 2030; i < 2900; ++i) most = std::max(most, heard[i]);
    EXPECT_LT(most, 0.003) << catches_up;
    // It breaks off and begins without a click: no more than what speech has.
    const auto step = [](const media::Pcm& pcm) {
      double largest = 0;
      for (std::size_t i = 1; i < pcm.samples.size(); ++i) {
        largest = std::max(largest, double(std::abs(pcm.samples[i] - pcm.samples[i - 1])));
      }
      return largest;
    };
    EXPECT_LE(step(paused.sound), step(whole.sound) * 1.05);
    double widest = 0;
    for (const fap::Frame& frame : whole.face.frames) widest = std::max(widest, opening(frame));
    for (std::size_t i = 60; i < 72; ++i) {
      EXPECT_LT(std::abs(opening(paused.face.frames[i])), 0.1 * widest) << i;
    }
    const auto at = [](const std::vector<double>& values) {
      return [&values](double time) {
        const auto i = std::int64_t(std::llround(time * 1000));
        return i >= 0 && i < std::int64_t(values.size()) ? values[std::size_t(i)] : 0.0;
      };
    };
    const auto mouth = [](const fap::Sequence& clip) {
      return [&clip](double time) {
        const double row = std::clamp(time * 25, 0.0, double(clip.frames.size() - 2));
        const auto i = std::size_t(row);
        const double part = row - double(i);
        return (1 - part) * opening(clip.frames[i]) + part * opening(clip.frames[i + 1]);
      };
    };
    using Value = std::function<double(double)>;
    const double of_sound = shift_of<Value>(at(loud), at(heard), 1000, 3.6, end + 0.9, 1.5);
    const double of_face =
        shift_of<Value>(mouth(whole.face), mouth(paused.face), 250, 3.6, end + 0.9, 1.5);
    std::printf("a pause of 1 s moves the sound by %.3f s, the face by %.3f s\n", of_sound,
                of_face);
    EXPECT_NEAR(of_sound, 1, 0.1);
    EXPECT_NEAR(of_face, of_sound, 0.03);
  }
}

// A tone that breaks off at its peak, since the next piece is late, and goes on at a peak.
TEST(Underrun, APieceThatIsLateMakesNoClick) {
  constexpr int kRate = 48000;
  LineQueue queue(1000, true, false);
  media::JumpingClock clock;
  SpeakerOptions options;
  options.voice_rate = kRate;
  options.audio = media::AudioSettings{media::AudioCodec::aac, 128000};
  auto speaker = LiveSpeaker::open(character(), queue, clock, options);
  ASSERT_TRUE(speaker);
  int sent = 0;
  const Received got = receive(**speaker, [&](double due) {
    clock.sleep_until(due);
    for (const double at : {0.5, 1.9}) {
      if (due < at || sent > (at > 1)) continue;
      EXPECT_TRUE(queue.push("piece", due));
      SpokenLine piece;
      piece.joins = true;
      piece.speech.script.phones = {{0, 0.5, "AA", {}}};
      piece.speech.audio.sample_rate = kRate;
      for (int i = 0; i <= kRate / 2; ++i) {
        piece.speech.audio.samples.push_back(float(0.4 * std::cos(i * 2 * M_PI * 200 / kRate)));
      }
      queue.made(queue.try_job()->line, std::move(piece), due);
      if (++sent == 2) queue.close();
    }
    return true;
  });
  double largest = 0;
  for (std::size_t i = 1; i < got.sound.samples.size(); ++i) {
    largest = std::max(largest, double(std::abs(got.sound.samples[i] - got.sound.samples[i - 1])));
  }
  // The tone itself moves by 0.0105 a sample, its fade in 2 ms by 0.0065 more; a click by 0.1 and
  // more.
  EXPECT_GT(largest, 0.008);
  EXPECT_LT(largest, 0.025);
}

// Ten minutes of pieces of half a second, a tone and an open mouth each, that come in real time,
// but with pauses and late by chance.
TEST(Underrun, PiecesKeepTheirOrderAndNothingDriftsInTenMinutes) {
  constexpr int kRate = 24000;
  constexpr int kPieces = 1200;
  LineQueue queue(1000, true, false);
  media::JumpingClock clock;
  SpeakerOptions options;
  options.voice_rate = kRate;
  options.events = true;
  options.audio = media::AudioSettings{media::AudioCodec::opus};
  auto speaker = LiveSpeaker::open(character(), queue, clock, options);
  ASSERT_TRUE(speaker);
  std::mt19937 random(1);
  std::vector<double> arrivals;
  double at = 0.5;
  for (int i = 0; i < kPieces; ++i) {
    if (random() % 40 == 0) at += 0.7 + double(random() % 1000) / 2000;  // a pause
    arrivals.push_back(at + double(random() % 100) / 1000);
    at += 0.5;
  }
  std::size_t next = 0;
  std::vector<LineEvent> events;
  const Received got = receive(**speaker, [&](double due) {
    clock.sleep_until(due);
    while (next < arrivals.size() && arrivals[next] <= due) {
      EXPECT_TRUE(queue.push("piece", arrivals[next]));
      ++next;
      if (next == arrivals.size()) queue.close();
    }
    while (const auto job = queue.try_job()) {
      SpokenLine piece;
      piece.joins = true;
      piece.speech.script.phones = {
          {0, 0.15, "B", {}}, {0.15, 0.35, "AA", {}}, {0.35, 0.5, "B", {}}};
      piece.speech.audio.sample_rate = kRate;
      for (int i = 0; i < kRate / 2; ++i) {
        const double time = double(i) / kRate;
        const bool loud = time >= 0.15 && time < 0.35;
        piece.speech.audio.samples.push_back(loud ? float(0.5 * std::sin(time * 2513)) : 0.0F);
      }
      queue.made(job->line, std::move(piece), due);
    }
    for (LineEvent& event : (*speaker)->take_events()) events.push_back(std::move(event));
    return true;
  });
  (*speaker)->end("over");
  for (LineEvent& event : (*speaker)->take_events()) events.push_back(std::move(event));

  std::vector<double> starts;
  std::uint64_t last = 0;
  std::size_t done = 0;
  for (const LineEvent& event : events) {
    done += event.what == LineEvent::What::done;
    if (event.what != LineEvent::What::started) continue;
    EXPECT_EQ(event.line, last + 1);
    last = event.line;
    starts.push_back(event.time);
  }
  ASSERT_EQ(starts.size(), std::size_t(kPieces));
  EXPECT_EQ(done, std::size_t(kPieces));
  const auto loud = loudness(got.sound);
  double first_lag = 0, least = 1, most = -1;
  std::vector<double> mouths;
  for (const double start : starts) {
    // Where the tone begins in the sound that was received, and how wide the mouth is in its
    // middle.
    std::size_t i = std::size_t(start * 1000) + 50;
    while (i < loud.size() && loud[i] < 0.1) ++i;
    const double lag = double(i) / 1000 - start - 0.15;
    least = std::min(least, lag);
    most = std::max(most, lag);
    if (first_lag == 0) first_lag = lag;
    const auto frame = [&](double time) {
      return opening(got.face.frames[std::min(got.face.frames.size() - 1,
                                              std::size_t(std::lround((start + time) * 25)))]);
    };
    EXPECT_GT(frame(0.25), frame(0.02) + 60) << start;
    EXPECT_GT(frame(0.25), frame(0.46) + 60) << start;
  }
  std::printf("%.0f s, %d pieces: the tone begins %.1f to %.1f ms after the instant that is told\n",
              got.sound.duration(), kPieces, 1e3 * least, 1e3 * most);
  EXPECT_GT(got.sound.duration(), 600);
  EXPECT_LT(most - least, 0.005);
  EXPECT_LT(std::abs(most), 0.01);
  // In a pause the mouth rests.
  std::size_t pauses = 0;
  for (std::size_t i = 1; i < starts.size(); ++i) {
    if (starts[i] - starts[i - 1] < 1.1) continue;
    ++pauses;
    const double middle = (starts[i - 1] + 0.5 + 0.25 + starts[i] - 0.1) / 2;
    EXPECT_NEAR(opening(got.face.frames[std::size_t(middle * 25)]), opening(got.face.frames[0]), 5);
  }
  EXPECT_GT(pauses, 10u);
}

}  // namespace underrun_test
}  // namespace animeme::speech
