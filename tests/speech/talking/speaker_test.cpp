// A live talking head on a clock of the test's own, with lines that the test makes.
#include "tools/speech/talking/live_speaker.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "fap/tables.h"

namespace animeme::speech {
namespace speaker_test {

using media::LiveTrack;
using media::LiveUnit;

class TestLines : public LineSource {
 public:
  std::optional<SpokenLine> take(bool only_joining) override {
    if (waiting.empty() || (only_joining && !waiting.front().joins)) return std::nullopt;
    SpokenLine line = std::move(waiting.front());
    waiting.pop_front();
    return line;
  }
  bool ended() override { return over && waiting.empty(); }

  std::deque<SpokenLine> waiting;
  bool over = false;
};

// "bab ab": silence of 0.2 s, then phones of 0.1 s with a tone, then silence of 0.3 s.
SpokenLine make_line(int rate = 22050) {
  SpokenLine line;
  line.text = "bab ab";
  double at = 0;
  const auto add = [&](const char* label, double seconds) {
    line.speech.script.phones.push_back({at, at + seconds, label, {}});
    at += seconds;
  };
  add("SIL", 0.2);
  for (const char* label : {"B", "AE", "B", "AE", "B"}) add(label, 0.1);
  add("SIL", 0.3);
  line.speech.audio.sample_rate = rate;
  for (int i = 0; i < int(at * rate); ++i) {
    const double time = double(i) / rate;
    const bool loud = time >= 0.2 && time < 0.7;
    line.speech.audio.samples.push_back(loud ? float(0.5 * std::sin(time * 2 * 3.14159 * 440)) : 0);
  }
  return line;
}

class Speaker : public testing::Test {
 protected:
  void open(const SpeakerOptions& options = {}) {
    auto built = dam::builtin_model();
    ASSERT_TRUE(built);
    model = std::move(*built);
    auto opened = LiveSpeaker::open(model, lines, clock, options);
    ASSERT_TRUE(opened) << opened.error().describe();
    speaker = std::move(*opened);
  }
  // Runs to presentation time `until` or to the end.
  void run(double until) {
    while (const auto due = speaker->next_due()) {
      if (*due >= until) return;
      clock.sleep_until(*due);
      auto made = speaker->take(*due);
      ASSERT_TRUE(made) << made.error().describe();
      ASSERT_FALSE(made->empty());
      for (LiveUnit& unit : *made) {
        speaker->sent(unit, clock.now());
        EXPECT_NEAR(media::due_of(*speaker, unit), *due, 1e-9);
        (unit.track == LiveTrack::face ? planes : packets).push_back(std::move(unit));
      }
    }
  }
  fap::Sequence face() const {
    fba::AccessUnits units;
    for (const LiveUnit& plane : planes) units.units.push_back({plane.bytes, plane.intra, 0, 1});
    const auto decoded = fba::decode(fba::join_access_units(units));
    EXPECT_TRUE(decoded) << decoded.error().describe();
    return decoded ? fba::face_sequence(*decoded) : fap::Sequence{};
  }
  media::Pcm sound() const {
    media::EncodedAudio audio;
    audio.format = *speaker->info().audio;
    for (const LiveUnit& packet : packets) {
      audio.packets.push_back({packet.bytes, packet.time, packet.duration});
    }
    const auto pcm = media::decode_audio(audio);
    EXPECT_TRUE(pcm) << pcm.error().describe();
    return pcm ? *pcm : media::Pcm{};
  }

  dam::Model model;
  TestLines lines;
  media::JumpingClock clock;
  std::unique_ptr<LiveSpeaker> speaker;
  std::vector<LiveUnit> planes, packets;
};

double first_sound(const media::Pcm& pcm) {
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    if (std::abs(pcm.samples[i]) > 0.1F) return double(i) / pcm.sample_rate;
  }
  return -1;
}

TEST_F(Speaker, IdlesForEverAtRestInSilence) {
  open();
  run(3);
  ASSERT_EQ(planes.size(), 75u);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_EQ(planes[i].time, std::int64_t(i) * 1000);
    EXPECT_EQ(planes[i].intra, i % 25 == 0);
  }
  const fap::Sequence clip = face();
  for (const fap::Frame& frame : clip.frames) EXPECT_EQ(frame.value, clip.frames[0].value);
  for (std::size_t i = 1; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i].time, packets[i - 1].time + packets[i - 1].duration);
  }
  EXPECT_EQ(packets[0].time, -speaker->info().audio->priming);
  for (const float sample : sound().samples) ASSERT_LT(std::abs(sample), 1e-3F);
  EXPECT_TRUE(speaker->next_due());
}

TEST_F(Speaker, ADelaySendsTheSameLaterInTighterRanges) {
  std::vector<fap::Sequence> faces;
  std::vector<std::size_t> bytes;
  std::vector<double> heard;
  for (const double delay : {0.0, 1.0}) {
    planes.clear();
    packets.clear();
    lines.over = false;
    SpeakerOptions options;
    options.coding_delay = delay;
    open(options);
    double due = -1;
    const auto go_on = [&](double until) {
      while (const auto next = speaker->next_due()) {
        if (*next >= until) return;
        EXPECT_GE(*next, due);
        due = *next;
        clock.sleep_until(due);
        auto made = speaker->take(due);
        ASSERT_TRUE(made) << made.error().describe();
        for (LiveUnit& unit : *made) {
          EXPECT_NEAR(media::due_of(*speaker, unit), due, 1e-9);
          (unit.track == LiveTrack::face ? planes : packets).push_back(std::move(unit));
        }
      }
    };
    go_on(2.01);
    lines.waiting.push_back(make_line());
    lines.over = true;
    go_on(100);
    faces.push_back(face());
    heard.push_back(first_sound(sound()));
    std::size_t sum = 0;
    for (const LiveUnit& plane : planes) sum += plane.bytes.size();
    bytes.push_back(sum);
    for (std::size_t i = 0; i < planes.size(); ++i) {
      EXPECT_EQ(planes[i].time, std::int64_t(i) * 1000);
    }
  }
  // The end may be some planes of rest later.
  ASSERT_GT(faces[0].frames.size(), 60u);
  ASSERT_GE(faces[1].frames.size(), faces[0].frames.size());
  for (std::size_t i = 0; i < faces[0].frames.size(); ++i) {
    // Intra planes, which round anew, may lie elsewhere.
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      ASSERT_NEAR(faces[1].frames[i].value[std::size_t(fap)],
                  faces[0].frames[i].value[std::size_t(fap)], fap::info(fap).quant_step)
          << i;
    }
  }
  EXPECT_NEAR(heard[1], heard[0], 1e-3);
  EXPECT_LT(double(bytes[1]) / double(faces[1].frames.size()),
            double(bytes[0]) / double(faces[0].frames.size()));
}

TEST_F(Speaker, ALineIsSeenAndHeardAtTheSameInstant) {
  for (const media::AudioCodec codec : {media::AudioCodec::aac, media::AudioCodec::opus}) {
    planes.clear();
    packets.clear();
    lines.over = false;
    SpeakerOptions options;
    options.audio = media::AudioSettings{codec};
    open(options);
    run(2.01);
    lines.waiting.push_back(make_line());
    lines.over = true;
    run(100);
    EXPECT_FALSE(speaker->next_due());
    ASSERT_EQ(speaker->traces().size(), 1u);
    const double heard = first_sound(sound());
    // Begun with the next frame, at 2.04 s, if the sound so far leaves room: 0.2 s of silence do.
    EXPECT_NEAR(heard, 2.24, 0.002) << media::name_of(codec);
    // The lips are closed in the B from 2.24 to 2.34 and open in the AE behind it.
    const fap::Sequence clip = face();
    const auto gap = [&](double time) {
      const fap::Frame& frame = clip.frames[std::size_t(std::lround(time * 25))];
      return -(frame.value[4] + frame.value[5]);
    };
    EXPECT_LT(gap(2.28), 45);
    EXPECT_GT(gap(2.40), 100);
    EXPECT_LT(gap(2.48), 45);
    EXPECT_NEAR(clip.duration(), 2.04 + 1.0, 0.05);
  }
}

// A piece of a tone that goes on from one piece to the next, with lips closed in its middle.
SpokenLine make_piece(double begin, double end, int rate) {
  SpokenLine piece;
  piece.joins = true;
  const double middle = (end - begin) / 2;
  piece.speech.script.phones = {{0, middle - 0.06, "AA", {}},
                                {middle - 0.06, middle + 0.06, "B", {}},
                                {middle + 0.06, end - begin, "AA", {}}};
  piece.speech.audio.sample_rate = rate;
  for (int i = int(std::lround(begin * rate)); i < int(std::lround(end * rate)); ++i) {
    piece.speech.audio.samples.push_back(
        float(0.5 * std::sin(double(i) / rate * 2 * 3.14159265358979 * 200)));
  }
  return piece;
}

TEST_F(Speaker, PiecesJoinWithoutAGap) {
  open();
  run(1.01);
  const int rate = 22050;
  lines.waiting = {make_piece(0, 0.613, rate), make_piece(0.613, 1.3, rate)};
  run(1.2);
  lines.waiting.push_back(make_piece(1.3, 2, rate));  // comes while they speak
  lines.over = true;
  run(100);
  const media::Pcm pcm = sound();
  const double heard = first_sound(pcm);
  // 0.1 s after the frame that is made next, or where the encoder has not been.
  EXPECT_GE(heard, 1.139);
  EXPECT_LE(heard, 1.19);
  // A gap of one sample would break the tone.
  const auto begin = std::size_t((heard + 0.1) * pcm.sample_rate);
  const auto end = std::size_t((heard + 1.9) * pcm.sample_rate);
  const double turn = 2 * 3.14159265358979 * 200 / pcm.sample_rate;
  double worst = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const double expected = 2 * std::cos(turn) * pcm.samples[i - 1] - pcm.samples[i - 2];
    worst = std::max(worst, std::abs(pcm.samples[i] - expected));
  }
  EXPECT_LT(worst, 0.02);
  const fap::Sequence clip = face();
  const auto gap = [&](double time) {
    const fap::Frame& frame = clip.frames[std::size_t(std::lround(time * 25))];
    return -(frame.value[4] + frame.value[5]);
  };
  for (const double middle : {0.3065, 0.9565, 1.65}) EXPECT_LT(gap(heard + middle), 45) << middle;
  for (const double open : {0.6, 1.3}) EXPECT_GT(gap(heard + open), 100) << open;
  EXPECT_NEAR(clip.duration(), heard + 2, 0.05);
}

TEST_F(Speaker, APieceThatComesLateBeginsAsSoonAsItCan) {
  open();
  run(1);
  lines.waiting.push_back(make_piece(0, 0.5, 16000));
  run(2.2);
  lines.waiting.push_back(make_piece(0, 0.5, 16000));
  lines.over = true;
  run(100);
  const media::Pcm pcm = sound();
  const auto quiet = [&](double from, double to) {
    for (auto i = std::size_t(from * pcm.sample_rate); i < std::size_t(to * pcm.sample_rate); ++i) {
      if (std::abs(pcm.samples[i]) > 0.05F) return false;
    }
    return true;
  };
  EXPECT_TRUE(quiet(1.7, 2.28));
  EXPECT_FALSE(quiet(2.28, 2.4));
  EXPECT_NEAR(face().duration(), 2.2 + 0.15 + 0.5, 0.09);
}

TEST_F(Speaker, APieceWithTimesAloneMovesTheFace) {
  open();
  run(1);
  SpokenLine piece = make_piece(0, 0.6, 16000);
  piece.speech.audio.samples.clear();
  lines.waiting = {piece, piece};
  lines.over = true;
  run(100);
  for (const float sample : sound().samples) ASSERT_LT(std::abs(sample), 1e-3F);
  EXPECT_NEAR(face().duration(), 1.15 + 1.2, 0.09);
}

TEST_F(Speaker, WithoutSoundTheFaceSpeaksAllTheSame) {
  SpeakerOptions options;
  options.audio.reset();
  open(options);
  EXPECT_FALSE(speaker->info().audio);
  run(1);
  lines.waiting.push_back(make_line());
  lines.over = true;
  run(100);
  EXPECT_TRUE(packets.empty());
  EXPECT_NEAR(face().duration(), 2, 0.05);
}

TEST_F(Speaker, LinesThatComeTogetherFollowEachOther) {
  open();
  run(1);
  lines.waiting = {make_line(), make_line()};
  lines.over = true;
  run(100);
  ASSERT_EQ(speaker->traces().size(), 2u);
  EXPECT_FALSE(speaker->traces()[0].waited);
  EXPECT_TRUE(speaker->traces()[1].waited);
  EXPECT_NEAR(double(planes.back().time) / 25000, 1 + 1 + 1, 0.09);
}

TEST_F(Speaker, LifeBlinksWhileIdleAndNeverJumps) {
  SpeakerOptions options;
  options.face.idle_motion = true;
  open(options);
  run(7.6);
  lines.waiting.push_back(make_line());
  run(30);
  const fap::Sequence clip = face();
  int blinks = 0, brows = 0, head = 0;
  for (std::size_t i = 1; i < clip.frames.size(); ++i) {
    const auto& before = clip.frames[i - 1].value;
    const auto& now = clip.frames[i].value;
    blinks += before[19] <= 512 && now[19] > 512;
    // Head and brows, which a joint would make jump.
    for (const int fap : {31, 32}) brows = std::max(brows, std::abs(now[fap] - before[fap]));
    for (const int fap : {48, 49, 50}) head = std::max(head, std::abs(now[fap] - before[fap]));
  }
  EXPECT_GE(blinks, 4);
  EXPECT_LE(blinks, 15);
  EXPECT_LT(brows, 60);       // 4 mm in 40 ms
  EXPECT_LT(head, 5 * 1745);  // 5 degrees
}

TEST_F(Speaker, SoundOfAnotherRateIsConverted) {
  open();
  run(0.5);
  lines.waiting.push_back(make_line(16000));
  lines.over = true;
  run(100);
  EXPECT_NEAR(first_sound(sound()), 0.72, 0.002);
}

TEST_F(Speaker, EndsAtTheDurationAndWithTheLines) {
  SpeakerOptions options;
  options.duration = 1;
  open(options);
  run(100);
  EXPECT_EQ(planes.size(), 25u);
  planes.clear();
  lines.over = true;
  open();
  EXPECT_FALSE(speaker->next_due());
}

TEST_F(Speaker, ALineThatTheModelCannotSayIsLeftOut) {
  open();
  run(1);
  SpokenLine bad = make_line();
  bad.speech.script.phones[1].label = "NOPE";
  lines.waiting = {bad, make_line()};
  run(4);
  EXPECT_EQ(speaker->traces().size(), 1u);
  EXPECT_THAT(speaker->take_warnings(), testing::ElementsAre(testing::HasSubstr("left out")));
  EXPECT_TRUE(speaker->take_warnings().empty());
}

TEST_F(Speaker, SameLinesAtTheSameTimesGiveTheSameBytes) {
  std::vector<LiveUnit> first;
  for (int round = 0; round < 2; ++round) {
    planes.clear();
    packets.clear();
    SpeakerOptions options;
    options.face.idle_motion = true;
    open(options);
    run(1.5);
    lines.waiting.push_back(make_line());
    run(4);
    if (round == 0) first = planes;
  }
  EXPECT_EQ(first, planes);
}

}  // namespace speaker_test
}  // namespace animeme::speech
