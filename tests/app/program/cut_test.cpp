// One long recording becomes the sentences of a corpus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "dam/corpus/corpus.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"
#include "tools/formats/exchange/curves.h"

namespace animeme::test {
namespace cut_test {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Sentences of the sample behind each other, with what is spoken when.
struct Long {
  dam::Signal signal;
  dam::Script script;
  std::size_t bilabials = 0;
};

Long long_recording(std::size_t sentences) {
  const auto corpus = dam::read_corpus(data_dir() / "grid_s1_sample");
  EXPECT_TRUE(corpus) << corpus.error().describe();
  Long out;
  for (std::size_t i = 0; corpus && i < sentences; ++i) {
    const dam::Utterance& one = corpus->utterances[i];
    const double begin = out.signal.rate.seconds(double(out.signal.frames()));
    out.signal.names = one.signal.names;
    out.signal.rate = one.signal.rate;
    out.signal.values.insert(out.signal.values.end(), one.signal.values.begin(),
                             one.signal.values.end());
    for (dam::Phone phone : one.script.phones) {
      phone.start += begin;
      phone.end = std::min(phone.end, one.signal.rate.seconds(double(one.signal.frames()))) + begin;
      if (phone.label == "P" || phone.label == "B" || phone.label == "M") ++out.bilabials;
      if (phone.end > phone.start) out.script.phones.push_back(phone);
    }
  }
  return out;
}

TEST(Cut, LongRecordingsBecomeSentences) {
  const TempDir dir;
  const Long recording = long_recording(12);
  fs::create_directories(dir.path() / "takes");
  fs::create_directories(dir.path() / "scripts");
  spill(dir / "takes/day.csv", exchange::write_curves(recording.signal));
  spill(dir / "scripts/day.TextGrid", dam::write_textgrid(recording.script));
  const Json report = json_of({"corpus", dir / "takes", dir / "scripts", "-o", dir / "me"});
  const auto corpus = dam::read_corpus(dir.path() / "me");
  ASSERT_TRUE(corpus) << corpus.error().describe();
  EXPECT_GT(corpus->utterances.size(), 2u);
  EXPECT_EQ(corpus->utterances.front().id, "day_001");
  EXPECT_EQ(report["sentences"], corpus->utterances.size());
  // Nothing that is said is lost, and each frame has the phone that it had.
  std::vector<std::string> said, wanted;
  std::size_t bilabials = 0, at = 0;
  for (const dam::Utterance& one : corpus->utterances) {
    EXPECT_LE(one.signal.rate.seconds(double(one.signal.frames())), 16) << one.id;
    for (const dam::Phone& phone : one.script.phones)
      if (phone.label != "SIL") said.push_back(phone.label);
    // Its first frame in the recording, by values.
    const auto& values = one.signal.values;
    const auto found = std::search(recording.signal.values.begin() + std::ptrdiff_t(at),
                                   recording.signal.values.end(), values.begin(), values.end(),
                                   [](double a, double b) { return std::abs(a - b) < 1e-3; });
    ASSERT_NE(found, recording.signal.values.end()) << one.id;
    at = std::size_t(found - recording.signal.values.begin());
    const double begin = recording.signal.rate.seconds(double(at / recording.signal.names.size()));
    for (const dam::Phone& phone : one.script.phones) {
      if (phone.label == "SIL") continue;
      const double middle = begin + 0.5 * (phone.start + phone.end);
      const auto same = std::find_if(
          recording.script.phones.begin(), recording.script.phones.end(),
          [&](const dam::Phone& other) { return other.start <= middle && middle < other.end; });
      ASSERT_NE(same, recording.script.phones.end());
      EXPECT_EQ(same->label, phone.label) << one.id;
    }
  }
  for (const dam::Phone& phone : recording.script.phones)
    if (phone.label != "SIL") wanted.push_back(phone.label);
  EXPECT_EQ(said, wanted);
  for (const Json& sentence : report["per_sentence"])
    bilabials += std::size_t(sentence["closures"].value("phones", 0));
  EXPECT_EQ(bilabials, recording.bilabials);
  EXPECT_FALSE(fs::exists(dir.path() / "me/audio")) << "there is no sound";
  EXPECT_FALSE(fs::exists(dir.path() / "me/tracked"));
  // Or not at all.
  succeeds({"corpus", dir / "takes", dir / "scripts", "-o", dir / "whole", "--cut", "0"});
  const auto whole = dam::read_corpus(dir.path() / "whole");
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->utterances.size(), 1u);
  EXPECT_EQ(whole->utterances[0].signal.frames(), recording.signal.frames());
}

TEST(Cut, SubtitlesAreTheTextOfTheOneVideo) {
  const TempDir dir;
  const Long recording = long_recording(1);
  spill(dir / "talk.csv", exchange::write_curves(recording.signal));
  spill(dir / "talk.srt",
        "1\n00:00:00,000 --> 00:00:01,000\n<i>Bin blue</i> [cough]\n\n2\n"
        "00:00:01,000 --> 00:00:02,000\nat 1984\n1985\n");
  spill(dir / "talk.vtt",
        "WEBVTT\n\n00:00.000 --> 00:01.000\nBin blue\n\nname\n00:01.000 --> 00:02.000\nat two\n");
  // Without sound nothing can be aligned; the message comes after the text was understood.
  for (const char* name : {"talk.srt", "talk.vtt"}) {
    const auto result = animeme({"corpus", dir / "talk.csv", dir / name, "-o", dir / "me"});
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, HasSubstr("no sound to align")) << name;
  }
}

}  // namespace cut_test
}  // namespace animeme::test
