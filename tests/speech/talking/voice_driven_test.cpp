// A face that follows a voice by its sound, and sound from pipes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

#include "dam/model/builtin.h"
#include "dam/signal/closure.h"
#include "tools/speech/talking/live_voice.h"
#include "tools/speech/talking/sound_bytes.h"
#include "tools/speech/talking/voice_driven_face.h"
#include "tools/speech/voice/voice.h"

namespace animeme::speech {
namespace voice_driven_test {

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(std::uint8_t(value >> (8 * i)));
}

void put_text(Bytes& bytes, const std::string& text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}

// WAV with a chunk that nobody wants in front of the sound.
Bytes wav(int format, int bits, int channels, std::uint32_t rate, const Bytes& data,
          std::uint32_t length) {
  Bytes out;
  put_text(out, "RIFF");
  put(out, length, 4);
  put_text(out, "WAVEfmt ");
  put(out, 16, 4);
  put(out, std::uint64_t(format), 2);
  put(out, std::uint64_t(channels), 2);
  put(out, rate, 4);
  put(out, 0, 4);
  put(out, 0, 2);
  put(out, std::uint64_t(bits), 2);
  put_text(out, "LIST");
  put(out, 3, 4);
  put_text(out, "abc");
  put(out, 0, 1);
  put_text(out, "data");
  put(out, length, 4);
  out.insert(out.end(), data.begin(), data.end());
  return out;
}

std::vector<float> read_all(const Bytes& bytes, std::size_t piece, int* rate = nullptr) {
  SoundBytes sound;
  std::vector<float> out;
  for (std::size_t at = 0; at < bytes.size(); at += piece) {
    const auto some = std::span(bytes).subspan(at, std::min(piece, bytes.size() - at));
    const auto ok = sound.push(some, out);
    EXPECT_TRUE(ok) << ok.error().message;
    if (!ok) break;
  }
  if (rate != nullptr) *rate = sound.sample_rate();
  return out;
}

TEST(SoundBytes, ReadsWavByteByByte) {
  Bytes data;
  put(data, 16384, 2);                  // 0.5
  put(data, std::uint64_t(-32768), 2);  // -1
  put(data, 8192, 2);
  put(data, 8192, 2);
  for (const std::size_t piece : {std::size_t(1), std::size_t(7), std::size_t(1000)}) {
    int rate = 0;
    EXPECT_THAT(read_all(wav(1, 16, 2, 44100, data, 8), piece, &rate), ElementsAre(-0.25f, 0.25f));
    EXPECT_EQ(rate, 44100);
    // What pipes write for lengths that they do not know, and a sample that is cut off.
    EXPECT_EQ(read_all(wav(1, 16, 1, 16000, data, 0xffffffff), piece).size(), 4u);
    EXPECT_EQ(read_all(wav(1, 16, 1, 16000, {1, 2, 3}, 0), piece).size(), 1u);
    // What follows the sound is no sound.
    EXPECT_EQ(read_all(wav(1, 16, 1, 16000, data, 4), piece).size(), 2u);
  }
}

TEST(SoundBytes, ReadsAllWidths) {
  Bytes data;
  put(data, 192, 1);
  EXPECT_THAT(read_all(wav(1, 8, 1, 8000, data, 0), 9), ElementsAre(0.5f));
  data.clear();
  put(data, 0xc00000, 3);
  EXPECT_THAT(read_all(wav(1, 24, 1, 8000, data, 0), 9), ElementsAre(-0.5f));
  data.clear();
  put(data, 0x20000000, 4);
  EXPECT_THAT(read_all(wav(1, 32, 1, 8000, data, 0), 9), ElementsAre(0.25f));
  data.clear();
  put(data, std::bit_cast<std::uint32_t>(0.75f), 4);
  EXPECT_THAT(read_all(wav(3, 32, 1, 8000, data, 0), 9), ElementsAre(0.75f));
  data.clear();
  put(data, std::bit_cast<std::uint64_t>(-0.125), 8);
  EXPECT_THAT(read_all(wav(3, 64, 1, 8000, data, 0), 9), ElementsAre(-0.125f));
}

TEST(SoundBytes, SaysWhatIsWrong) {
  const auto refuse = [](const Bytes& bytes) {
    SoundBytes sound;
    std::vector<float> out;
    const auto ok = sound.push(bytes, out);
    EXPECT_FALSE(ok);
    return ok ? std::string() : ok.error().message;
  };
  EXPECT_THAT(refuse(Bytes(100, 'x')), HasSubstr("does not begin like WAV"));
  EXPECT_THAT(refuse(wav(85, 16, 1, 16000, {}, 0)), HasSubstr("another coding"));
  EXPECT_THAT(refuse(wav(1, 12, 1, 16000, {}, 0)), HasSubstr("another coding"));
  EXPECT_THAT(refuse(wav(1, 16, 0, 16000, {}, 0)), HasSubstr("0 channels"));
  EXPECT_THAT(refuse(wav(1, 16, 1, 5, {}, 0)), HasSubstr("5 Hz"));
  Bytes endless;
  put_text(endless, "RIFF0000WAVEjunk");
  put(endless, 0xfffffff0, 4);
  EXPECT_THAT(refuse(endless), HasSubstr("first MB"));
  Bytes early;
  put_text(early, "RIFF0000WAVEdata0000");
  EXPECT_THAT(refuse(early), HasSubstr("before its format"));
  for (const char* bad : {"", "x", "16000:", "16000:0", "16000:99", "100", "16000:1x", "-16000"}) {
    EXPECT_FALSE(parse_bare_sound(bad)) << bad;
  }
  const auto two = parse_bare_sound("48000:2");
  ASSERT_TRUE(two);
  EXPECT_EQ(two->channels, 2);
}

// "Bob may buy a map", 22050 Hz; empty where there is no voice.
const voice::Speech& speech() {
  static const voice::Speech one = [] {
    auto made = voice::speak_text("Bob may buy a map.");
    return made ? std::move(*made) : voice::Speech{};
  }();
  return one;
}

const dam::Model& face_model() {
  static const dam::Model model = std::move(*dam::builtin_model());
  return model;
}

bool no_ears() {
  return speech().audio.samples.empty() || !VoiceDrivenFace::open(face_model(), 16000, {});
}

TEST(VoiceDrivenFace, ClosesItsLipsInTime) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  const media::Pcm& audio = speech().audio;
  std::vector<std::vector<double>> all;
  for (const std::size_t piece : {std::size_t(100), std::size_t(5000), audio.samples.size()}) {
    VoiceDrivenFaceOptions options;
    auto face = VoiceDrivenFace::open(face_model(), audio.sample_rate, options);
    ASSERT_TRUE(face);
    dam::Signal motion;
    const auto add = [&](const Result<dam::Signal>& some) {
      ASSERT_TRUE(some);
      EXPECT_EQ(some->first_frame, motion.frames());
      motion.names = some->names;
      motion.rate = some->rate;
      motion.values.insert(motion.values.end(), some->values.begin(), some->values.end());
    };
    for (std::size_t at = 0; at < audio.samples.size(); at += piece) {
      const std::size_t count = std::min(piece, audio.samples.size() - at);
      (*face)->push(std::span(audio.samples).subspan(at, count));
      add((*face)->pull());
      // Late by the delay, a block of 20 ms and a frame.
      const double given = double(at + count) / audio.sample_rate;
      EXPECT_GE(double(motion.frames()) / 25, given - options.delay - 0.061);
    }
    add((*face)->finish());
    EXPECT_NEAR(double(motion.frames()) / 25, audio.duration(), 0.05);
    const auto lips = dam::inner_lip_channels(motion.names);
    ASSERT_TRUE(lips);
    int count = 0, closed = 0;
    for (const dam::Phone& phone : speech().script.phones) {
      if (!dam::is_bilabial(phone.label)) continue;
      ++count;
      bool shut = false;
      for (std::size_t i = 0; i < motion.frames(); ++i) {
        const bool near = motion.time(i) > phone.start - 0.06 && motion.time(i) < phone.end + 0.06;
        shut = shut || (near && dam::inner_gap(motion, i, *lips) < dam::kClosedGap);
      }
      closed += shut;
    }
    EXPECT_EQ(count, 6);
    EXPECT_GE(closed, 4);
    all.push_back(motion.values);
  }
  EXPECT_EQ(all[0], all[1]);
  EXPECT_EQ(all[0], all[2]);
}

TEST(VoiceDrivenFace, RefusesBadOptions) {
  VoiceDrivenFaceOptions options;
  options.delay = 0;
  EXPECT_FALSE(VoiceDrivenFace::open(face_model(), 16000, options));
  options = {};
  options.synthesis.style = -1;
  EXPECT_FALSE(VoiceDrivenFace::open(face_model(), 16000, options));
  EXPECT_FALSE(VoiceDrivenFace::open(face_model(), 1, {}));
}

// A pipe whose writer is a thread of the test.
struct Pipe {
  int ends[2] = {-1, -1};
  std::thread writer;
  Pipe() { EXPECT_EQ(::pipe(ends), 0); }
  void write(Bytes bytes) {
    writer = std::thread([this, bytes = std::move(bytes)] {
      for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t put = ::write(ends[1], bytes.data() + at, bytes.size() - at);
        if (put <= 0) break;
        at += std::size_t(put);
      }
      ::close(ends[1]);
    });
  }
  ~Pipe() {
    ::close(ends[0]);  // a writer that waits is let go by the reader's end, not here
    if (writer.joinable()) writer.join();
  }
};

Bytes sound_of(const media::Pcm& audio) {
  Bytes data;
  for (const float x : audio.samples) {
    put(data, std::uint64_t(std::int64_t(std::lround(std::clamp(x, -0.99f, 0.99f) * 32767))), 2);
  }
  return wav(1, 16, 1, std::uint32_t(audio.sample_rate), data, std::uint32_t(data.size()));
}

TEST(LiveVoice, FaceAndSoundHaveOneClock) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  Pipe pipe;
  pipe.write(sound_of(speech().audio));
  auto voice = LiveVoice::open(face_model(), pipe.ends[0], {});
  ASSERT_TRUE(voice) << voice.error().message;
  ASSERT_TRUE((*voice)->info().audio);
  std::size_t planes = 0;
  double heard = 0;  // seconds
  const double rate = (*voice)->info().audio->sample_rate;
  double last = -1;
  int waits = 0;
  while (const auto due = (*voice)->next_due()) {
    // The test's clock runs ahead of the thread that reads: it is given a moment.
    if (++waits % 4 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_GE(*due, last);
    last = *due;
    const auto units = (*voice)->take(*due);
    ASSERT_TRUE(units) << units.error().message;
    for (const media::LiveUnit& unit : *units) {
      if (unit.track == media::LiveTrack::face) {
        EXPECT_EQ(unit.intra, planes % 25 == 0);
        ++planes;
      } else {
        heard += double(unit.duration) / rate;
      }
    }
  }
  EXPECT_GE(double(planes) / 25, speech().audio.duration());
  EXPECT_LT(double(planes) / 25, speech().audio.duration() + 3);
  EXPECT_GE(heard, speech().audio.duration());
  EXPECT_TRUE((*voice)->take_warnings().empty());
}

TEST(LiveVoice, BrokenSoundsEnd) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  for (const Bytes& bytes : {Bytes(), Bytes(50, 'x'), Bytes{'R', 'I', 'F', 'F'}}) {
    Pipe pipe;
    pipe.write(bytes);
    EXPECT_FALSE(LiveVoice::open(face_model(), pipe.ends[0], {}));
  }
  // A head and one sample; then it is over.
  Pipe pipe;
  pipe.write(wav(1, 16, 1, 16000, {1, 2}, 0));
  auto voice = LiveVoice::open(face_model(), pipe.ends[0], {});
  ASSERT_TRUE(voice);
  pipe.writer.join();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  int units = 0;
  while (const auto due = (*voice)->next_due()) {
    const auto some = (*voice)->take(*due);
    ASSERT_TRUE(some);
    units += int(some->size());
    ASSERT_LT(units, 1000);
  }
  EXPECT_GT(units, 10);
}

// A voice that pauses: time goes on, in silence, and ends at the duration.
TEST(LiveVoice, GoesOnWhereNothingComes) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  Pipe pipe;
  const Bytes bytes = sound_of(speech().audio);
  ASSERT_EQ(::write(pipe.ends[1], bytes.data(), 5000), 5000);
  LiveVoiceOptions options;
  options.duration = 5;
  options.audio.reset();
  auto voice = LiveVoice::open(face_model(), pipe.ends[0], options);
  ASSERT_TRUE(voice);
  int planes = 0;
  while (const auto due = (*voice)->next_due()) {
    const auto units = (*voice)->take(*due);
    ASSERT_TRUE(units);
    planes += int(units->size());
  }
  EXPECT_EQ(planes, 125);
  (*voice).reset();
  ::close(pipe.ends[1]);
}

}  // namespace voice_driven_test
}  // namespace animeme::speech
