// Speech from sound alone, whole and as it comes.
#include "tools/speech/voice/listen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "tests/support/files.h"
#include "tests/support/temp_dir.h"
#include "tools/speech/voice/align.h"
#include "tools/speech/voice/hearing.h"
#include "tools/speech/voice/listen_stream.h"
#include "tools/speech/voice/voice.h"

namespace animeme::voice {
namespace listen_test {

using test::slurp;
using test::spill;
using test::TempDir;
using testing::HasSubstr;
using testing::IsEmpty;

// Nothing where the build has no ears.
bool deaf() { return !SoundListener::open(kAlignRate, {}); }

// Straight lines between samples: good enough for a test.
media::Pcm at_rate(const media::Pcm& audio, int rate) {
  media::Pcm out{rate, {}};
  const auto count = std::size_t(audio.duration() * rate);
  for (std::size_t i = 0; i < count; ++i) {
    const double at = double(i) * audio.sample_rate / rate;
    const auto first = std::size_t(at);
    const float part = float(at - double(first)), a = audio.samples[first];
    const float b = first + 1 < audio.samples.size() ? audio.samples[first + 1] : a;
    out.samples.push_back((1 - part) * a + part * b);
  }
  return out;
}

struct Spoken {
  media::Pcm sound;
  dam::Script script;
};

const Spoken& sentence() {
  static const Spoken one = [] {
    const auto speech = speak_text("My mother may buy a big map.");
    return speech ? Spoken{at_rate(speech->audio, kAlignRate), speech->script} : Spoken{};
  }();
  return one;
}

bool bilabial(const std::string& label) { return label == "P" || label == "B" || label == "M"; }

// Bilabials of `one` that have one of `other` within 60 ms.
std::pair<int, int> met(const dam::Script& one, const dam::Script& other) {
  int count = 0, found = 0;
  for (const dam::Phone& phone : one.phones) {
    if (!bilabial(phone.label)) continue;
    ++count;
    found += std::any_of(other.phones.begin(), other.phones.end(), [&](const dam::Phone& near) {
      return bilabial(near.label) && near.start < phone.end + 0.06 && near.end > phone.start - 0.06;
    });
  }
  return {found, count};
}

double spoken_seconds(const dam::Script& script) {
  double sum = 0;
  for (const dam::Phone& phone : script.phones) {
    if (phone.label != dam::kSilence) sum += phone.duration();
  }
  return sum;
}

bool no_ears() { return deaf() || sentence().sound.samples.empty(); }

TEST(Listen, HearsLipsThatClose) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  const auto heard = listen(sentence().sound);
  ASSERT_TRUE(heard) << heard.error().message;
  const auto [found, count] = met(sentence().script, heard->script);
  ASSERT_EQ(count, 7);
  EXPECT_GE(found, 4);
  EXPECT_TRUE(dam::check_script(heard->script));
  EXPECT_DOUBLE_EQ(heard->script.duration(), sentence().sound.duration());
  EXPECT_NEAR(spoken_seconds(heard->script), spoken_seconds(sentence().script), 0.4);
  EXPECT_GT(heard->confidence, 0.3);
  // A robot's voice is at the limit of what is warned of.
  EXPECT_EQ(heard->warnings.empty(), heard->confidence >= 0.6);
  ASSERT_EQ(heard->confidences.size(), heard->script.phones.size());
  for (const double one : heard->confidences) EXPECT_TRUE(one >= 0 && one <= 1) << one;
  ASSERT_EQ(heard->readings.size(), ListenOptions().readings);
  for (const dam::Script& reading : heard->readings) {
    EXPECT_TRUE(dam::check_script(reading));
    EXPECT_DOUBLE_EQ(reading.duration(), sentence().sound.duration());
  }
  EXPECT_NE(heard->readings[0], heard->readings[1]);
}

TEST(Listen, GivesTheSameTwice) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  const auto one = listen(sentence().sound), other = listen(sentence().sound);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->readings, other->readings);
  EXPECT_EQ(one->confidences, other->confidences);
}

TEST(Listen, OtherLanguagesHaveOtherPairs) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  ListenOptions german;
  german.language = "de";
  const auto one = listen(sentence().sound), other = listen(sentence().sound, german);
  ASSERT_TRUE(one && other);
  EXPECT_NE(one->readings, other->readings);
}

TEST(Listen, WhatIsNoSpeechStaysStill) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  std::vector<float> noise(2 * kAlignRate), hum = noise, none = noise;
  std::uint32_t seed = 1;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    seed = seed * 1664525 + 1013904223;
    noise[i] = 0.05f * (float(seed >> 8) / 8388608.0f - 1);
    hum[i] = 0.2f * std::sin(2 * std::numbers::pi_v<float> * 50 * float(i) / kAlignRate);
    none[i] = std::numeric_limits<float>::quiet_NaN();
  }
  for (const auto& samples : {noise, hum, none, std::vector<float>(kAlignRate, 0.0f)}) {
    const auto heard = listen({kAlignRate, samples});
    ASSERT_TRUE(heard) << heard.error().message;
    EXPECT_LT(spoken_seconds(heard->script), 0.1);
    EXPECT_EQ(heard->confidence, 0);
    ASSERT_FALSE(heard->warnings.empty());
    EXPECT_THAT(heard->warnings[0], HasSubstr("no speech was recognised"));
  }
}

// More than one block of paths, each of which looks beyond its end.
TEST(Listen, WarnsOfSoundThatIsCutOff) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  media::Pcm loud = sentence().sound;
  for (float& sample : loud.samples) sample = std::clamp(sample * 30, -1.0F, 1.0F);
  const auto heard = listen(loud, {});
  ASSERT_TRUE(heard) << heard.error().describe();
  EXPECT_THAT(heard->warnings, testing::Contains(HasSubstr("the sound is clipped")));
  const auto clean = listen(sentence().sound, {});
  ASSERT_TRUE(clean) << clean.error().describe();
  EXPECT_THAT(clean->warnings, testing::Not(testing::Contains(HasSubstr("cut off"))));
}

TEST(Listen, LongSoundsAreHeardAsShortOnes) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  media::Pcm sound{kAlignRate, {}};
  const auto& one = sentence().sound.samples;
  const std::size_t times = 22 * std::size_t(kAlignRate) / one.size() + 1;
  for (std::size_t i = 0; i < times; ++i) {
    sound.samples.insert(sound.samples.end(), one.begin(), one.end());
  }
  ListenOptions options;
  double told = 0;
  options.progress = [&](double done) {
    EXPECT_GE(done, told);
    told = done;
  };
  options.readings = 8;
  const auto heard = listen(sound, options);
  ASSERT_TRUE(heard);
  EXPECT_EQ(told, 1);
  dam::Script script;
  for (std::size_t i = 0; i < times; ++i) {
    for (dam::Phone phone : sentence().script.phones) {
      phone.start += double(i * one.size()) / kAlignRate;
      phone.end += double(i * one.size()) / kAlignRate;
      script.phones.push_back(phone);
    }
  }
  const auto [found, count] = met(script, heard->script);
  EXPECT_GT(found, count / 2);
}

TEST(Listen, SaysWhatIsWrong) {
  const auto rate = listen({8000, std::vector<float>(8000)});
  ASSERT_FALSE(rate);
  EXPECT_EQ(rate.error().code, Code::invalid_argument);
  const auto nothing = listen({kAlignRate, {}});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().code, Code::truncated);
  const auto one = listen({kAlignRate, {0.5f}});
  ASSERT_FALSE(one);
  EXPECT_EQ(one.error().code, Code::truncated);
  if (deaf()) return;
  ListenOptions options;
  options.readings = 0;
  EXPECT_EQ(listen({kAlignRate, std::vector<float>(kAlignRate)}, options).error().code,
            Code::invalid_argument);
  options = {};
  options.model_path = "/nowhere";
  EXPECT_EQ(listen({kAlignRate, std::vector<float>(kAlignRate)}, options).error().code,
            Code::not_found);
  options = {};
  options.phones_path = "/nowhere";
  EXPECT_EQ(listen({kAlignRate, std::vector<float>(kAlignRate)}, options).error().code,
            Code::not_found);
}

// Files of the model that are cut off or full of nonsense.
TEST(Listen, DamagedModelsAreRefused) {
  if (deaf()) GTEST_SKIP() << "no pocketsphinx";
  const std::filesystem::path from = ListenOptions().model_path;
  for (const char* name : {"mdef", "means", "variances", "sendump", "transition_matrices"}) {
    const std::string whole = slurp(from / name);
    ASSERT_FALSE(whole.empty());
    std::string wild = whole;
    for (std::size_t i = 0; i < wild.size(); i += 3) wild[i] = char(0xff);
    for (const std::string& bad :
         {std::string(), whole.substr(0, 20), whole.substr(0, whole.size() / 3), wild,
          std::string(1000, 'x')}) {
      // Of the definition nothing but its beginning is read.
      if (std::string_view(name) == "mdef" && bad.size() > whole.size() / 4) continue;
      const TempDir dir;
      for (const auto& file : std::filesystem::directory_iterator(from)) {
        const auto to = dir / file.path().filename().string();
        if (file.path().filename() != name) std::filesystem::create_symlink(file.path(), to);
      }
      spill(dir / name, bad);
      ListenOptions options;
      options.model_path = dir / "";
      const auto heard = listen({kAlignRate, std::vector<float>(kAlignRate)}, options);
      EXPECT_FALSE(heard) << name << ", " << bad.size() << " bytes";
      if (heard) continue;
      EXPECT_NE(heard.error().message, "") << name;
    }
  }
}

// What comes piece by piece is heard the same, however it is cut.
TEST(SoundListener, DoesNotDependOnPieces) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  const auto& samples = sentence().sound.samples;
  std::vector<Recognition> all;
  for (const std::size_t piece : {std::size_t(37), std::size_t(160), samples.size()}) {
    auto listener = SoundListener::open(kAlignRate, {});
    ASSERT_TRUE(listener);
    EXPECT_EQ((*listener)->heard(), 0);
    EXPECT_THAT((*listener)->hear(0).readings, IsEmpty());
    for (std::size_t at = 0; at < samples.size(); at += piece) {
      (*listener)->push(std::span(samples).subspan(at, std::min(piece, samples.size() - at)));
      const double given = double(std::min(at + piece, samples.size())) / kAlignRate;
      // The first frames come together.
      EXPECT_LT(given - (*listener)->heard(), given < 0.15 ? 0.12 : 0.07);
    }
    all.push_back((*listener)->hear(0.5));
  }
  EXPECT_EQ(all[0].readings, all[1].readings);
  EXPECT_EQ(all[0].script, all[2].script);
  dam::Script truth;
  for (dam::Phone phone : sentence().script.phones) {
    phone.start -= 0.5;
    phone.end -= 0.5;
    truth.phones.push_back(phone);
  }
  const auto [found, count] = met(truth, all[0].script);
  EXPECT_GE(found, 3);
}

// A path stays where it is when more is heard, but for its end.
TEST(SoundListener, WhatLiesBackStays) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  const auto& samples = sentence().sound.samples;
  auto listener = SoundListener::open(kAlignRate, {});
  ASSERT_TRUE(listener);
  const std::size_t half = samples.size() / 2;
  (*listener)->push(std::span(samples).first(half));
  const Recognition before = (*listener)->hear(0);
  (*listener)->push(std::span(samples).subspan(half));
  const Recognition after = (*listener)->hear(0);
  const double settled = double(half) / kAlignRate - 0.6;
  std::size_t same = 0;
  for (std::size_t i = 0; i < before.readings.size(); ++i) {
    const auto early = [&](const dam::Script& script) {
      std::vector<dam::Phone> some = script.phones;
      std::erase_if(some, [&](const dam::Phone& phone) { return phone.end > settled; });
      return some;
    };
    same += early(before.readings[i]) == early(after.readings[i]);
  }
  EXPECT_GE(same, before.readings.size() * 3 / 4);
}

TEST(SoundListener, ForgetsWhatIsToldAndTakesAnyRate) {
  if (no_ears()) GTEST_SKIP() << "no pocketsphinx or no espeak-ng";
  for (const int rate : {8000, 44100, 48000}) {
    const media::Pcm sound = at_rate(sentence().sound, rate);
    auto listener = SoundListener::open(rate, {});
    ASSERT_TRUE(listener);
    (*listener)->push(sound.samples);
    EXPECT_NEAR((*listener)->heard(), sound.duration(), 0.08);
    const double length = (*listener)->heard();
    (*listener)->forget(1);
    const Recognition heard = (*listener)->hear(1);
    EXPECT_NEAR(heard.script.duration(), length - 1, 1e-9);
    EXPECT_TRUE(dam::check_script(heard.script));
  }
  EXPECT_FALSE(SoundListener::open(100, {}));
  EXPECT_FALSE(SoundListener::open(1000000, {}));
  auto listener = SoundListener::open(kAlignRate, {});
  ASSERT_TRUE(listener);
  (*listener)->push(std::vector<float>(5000, std::numeric_limits<float>::infinity()));
  (*listener)->push({});
  EXPECT_TRUE(dam::check_script((*listener)->hear(0).script));
}

// A head that hears sound takes 4 MB less.
TEST(SoundListener, AllHaveOneModel) {
  if (deaf()) GTEST_SKIP() << "no pocketsphinx";
  auto first = shared_hearing({});
  const auto second = shared_hearing({});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->get(), second->get());
  ListenOptions german;
  german.language = "de";
  const auto other = shared_hearing(german);
  ASSERT_TRUE(other);
  EXPECT_NE(other->get(), second->get()) << "it weighs phones in another way";
  ListenOptions missing;
  missing.model_path = "/nowhere";
  EXPECT_FALSE(shared_hearing(missing));
}

}  // namespace listen_test
}  // namespace animeme::voice
