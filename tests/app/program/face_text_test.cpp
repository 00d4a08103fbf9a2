// The FAP text that commands write: every player reads it right, whatever it comes from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fap/expand.h"
#include "fap/players.h"
#include "fap/tables.h"
#include "fap/text.h"
#include "tests/support/program.h"
#include "tests/support/random_clip.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace face_text_test {

using test::animeme;
using test::slurp;
using test::spill;
using test::TempDir;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string succeeds(const std::vector<std::string>& arguments) {
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.err;
}

fap::Sequence read(const std::string& path) {
  const auto clip = fap::read_text(slurp(path));
  EXPECT_TRUE(clip) << (clip ? "" : clip.error().describe());
  return clip ? *clip : fap::Sequence{};
}

void expect_right(const std::string& path) {
  EXPECT_THAT(fap::player_problems(slurp(path)), IsEmpty()) << path;
  EXPECT_EQ(animeme({"check", path}).exit_code, 0);
}

// A face that is the same on both sides, frames skipped here and there.
fap::Sequence face(fap::Rate rate, int frames = 40) {
  fap::Sequence clip{rate, {}, "face"};
  for (int i = 0; i < frames; ++i) {
    if (i % 9 == 7 && i + 1 < frames) continue;
    fap::Frame frame;
    frame.number = i;
    for (const fap::FapInfo& fap : fap::kFaps) {
      if (fap.number < 3 || fap.group == 6) continue;
      const int left = fap.mirror == 0 ? fap.number : std::min(fap.number, fap.mirror);
      frame.set(fap.number, (left * 7 + i * 11) % 200 - 100);
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

class EveryPreset : public ::testing::TestWithParam<std::vector<std::string>> {};
INSTANTIATE_TEST_SUITE_P(
    Encodings, EveryPreset,
    ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"--preset", "file"},
                      std::vector<std::string>{"--preset", "live"},
                      std::vector<std::string>{"--preset", "file", "--kbps", "6"},
                      std::vector<std::string>{"--quant", "9"}));

TEST_P(EveryPreset, DecodesToTextForPlayers) {
  const TempDir dir;
  for (const fap::Rate rate : {fap::Rate{25, 1}, fap::Rate{30000, 1001}}) {
    spill(dir / "a.fap", fap::write_text(face(rate)));
    std::vector<std::string> encode = {"encode", dir / "a.fap", "-o", dir / "a.fba"};
    encode.insert(encode.end(), GetParam().begin(), GetParam().end());
    succeeds(encode);
    const std::string said = succeeds({"decode", dir / "a.fba", "-o", dir / "b.fap"});
    expect_right(dir / "b.fap");
    const fap::Sequence shown = read(dir / "b.fap");
    EXPECT_EQ(shown.rate, rate);
    ASSERT_EQ(shown.frames.size(), 40u);
    for (const fap::Frame& frame : shown.frames) {
      EXPECT_EQ(frame.value[19], frame.value[20]);
      EXPECT_EQ(frame.value[59], frame.value[60]);
    }
    EXPECT_EQ(said.find("0.06 s per minute") == std::string::npos, rate.den == 1) << said;
    // The other ways of decoding: all FAPs, another rate.
    succeeds({"decode", dir / "a.fba", "--fill", "-o", dir / "c.fap"});
    expect_right(dir / "c.fap");
    EXPECT_EQ(read(dir / "c.fap").frames.front().mask.count(), 66u);
    EXPECT_THAT(succeeds({"decode", dir / "a.fba", "--rate", "50", "-o", dir / "e.fap"}),
                Not(HasSubstr("warning")));
    expect_right(dir / "e.fap");
    EXPECT_EQ(read(dir / "e.fap").rate, (fap::Rate{50, 1}));
    EXPECT_NEAR(read(dir / "e.fap").duration(), shown.duration(), 0.05);
    // A stream of the text has the exact rate again.
    succeeds({"encode", dir / "b.fap", "-o", dir / "b.fba"});
    succeeds({"decode", dir / "b.fba", "--exact", "-o", dir / "f.fap"});
    EXPECT_EQ(read(dir / "f.fap").rate, rate);
    EXPECT_THAT(slurp(dir / "f.fap"), Not(HasSubstr("fps")));
  }
}

TEST(FaceText, CodedIsWhatTheStreamSays) {
  const TempDir dir;
  spill(dir / "a.fap", fap::write_text(face({30000, 1001})));
  succeeds({"encode", dir / "a.fap", "--preset", "file", "-o", dir / "a.fba"});
  EXPECT_THAT(succeeds({"decode", dir / "a.fba", "--coded", "-o", dir / "b.fap"}),
              Not(HasSubstr("warning")));
  EXPECT_THAT(slurp(dir / "b.fap"), HasSubstr(" 29.97 "));
  const auto check = animeme({"check", dir / "b.fap"});
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_THAT(check.out, HasSubstr("'29.97' is not whole"));
  EXPECT_EQ(animeme({"decode", dir / "a.fba", "--coded", "--expand", "-o", "-"}).exit_code, 2);
  EXPECT_EQ(animeme({"decode", dir / "a.fba", "--rate", "no", "-o", "-"}).exit_code, 2);
}

TEST(FaceText, ExpandShowsVisemesToPlayersOfLowLevelFaps) {
  const TempDir dir;
  fap::Sequence clip{{25, 1}, {}, "x"};
  for (int i = 0; i < 10; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.mask.set(1);
    frame.mask.set(2);
    frame.viseme = {10, 1, 7 * i, false};
    frame.expression = {1, 30, 0, 0, false, false};
    frame.set(48, 50 * i);
    clip.frames.push_back(frame);
  }
  spill(dir / "a.fap", fap::write_text(clip));
  succeeds({"encode", dir / "a.fap", "-o", dir / "a.fba"});
  succeeds({"decode", dir / "a.fba", "--exact", "-o", dir / "b.fap"});
  EXPECT_EQ(animeme({"check", dir / "b.fap"}).exit_code, 1);
  EXPECT_TRUE(read(dir / "b.fap").frames[0].mask[1]);
  EXPECT_THAT(succeeds({"decode", dir / "a.fba", "-o", dir / "b.fap"}), HasSubstr("--exact"));
  expect_right(dir / "b.fap");
  for (const char* input : {"a.fba", "a.fap"}) {
    succeeds({"decode", dir / input, "--expand", "-o", dir / "c.fap"});
    expect_right(dir / "c.fap");
    const fap::Sequence low = read(dir / "c.fap");
    ASSERT_EQ(low.frames.size(), 10u);
    for (std::size_t i = 0; i < 10; ++i) {
      const fap::Frame want = fap::low_level(clip.frames[i]);
      EXPECT_EQ(low.frames[i].value[3], want.value[3]);
      EXPECT_EQ(low.frames[i].value[12], want.value[12]);
    }
  }
}

// Pictures of a clip with visemes, and of what decode --expand makes of it, are the same; and what
// export writes of the jaw is not nothing.
TEST(FaceText, CommandsThatShowExpandByThemselves) {
  const TempDir dir;
  fap::Sequence clip{{25, 1}, {}, "x"};
  for (int i = 0; i < 4; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.mask.set(1);
    frame.viseme = {10, 0, 21 * i, false};
    frame.set(48, 3000);
    clip.frames.push_back(frame);
  }
  spill(dir / "a.fap", fap::write_text(clip));
  succeeds({"decode", dir / "a.fap", "--expand", "-o", dir / "b.fap"});
  for (const char* name : {"a", "b"}) {
    const std::string path = dir / name;
    succeeds({"render", path + ".fap", "--frame", "3", "--size", "160x160", "-o", path + ".png"});
    succeeds({"export", path + ".fap", "-o", path + ".csv"});
    succeeds({"view", path + ".fap", "-o", path + ".html"});
  }
  EXPECT_EQ(slurp(dir / "a.png"), slurp(dir / "b.png"));
  const std::string curves = slurp(dir / "a.csv");
  EXPECT_EQ(curves, slurp(dir / "b.csv"));
  fap::Sequence rest = clip;
  for (fap::Frame& frame : rest.frames) frame.mask.reset(1);
  spill(dir / "r.fap", fap::write_text(rest));
  succeeds({"export", dir / "r.fap", "-o", dir / "r.csv"});
  EXPECT_NE(curves, slurp(dir / "r.csv"));
}

TEST(FaceText, ImportsRepeatWhatIsMissing) {
  const TempDir dir;
  std::string table = "time_s,jawOpen,eyeBlinkLeft\n";
  for (int i = 0; i < 20; ++i) {
    if (i < 8 || i > 11)
      table += std::to_string(i / 29.97) + ",0." + std::to_string(i % 10) + ",0\n";
  }
  spill(dir / "take.csv", table);
  const std::string said =
      succeeds({"import", dir / "take.csv", "--rate", "29.97", "--no-repair", "-o", dir / "a.fap"});
  EXPECT_THAT(said, HasSubstr("--rate 30 corrects it"));
  EXPECT_THAT(said, HasSubstr("4 of them held"));
  expect_right(dir / "a.fap");
  const fap::Sequence held = read(dir / "a.fap");
  EXPECT_EQ(held.frames.size(), 20u);
  EXPECT_EQ(held.frames[11].value, held.frames[7].value);
  succeeds({"import", dir / "take.csv", "--rate", "29.97", "--no-repair", "--exact", "-o",
            dir / "b.fap"});
  EXPECT_EQ(read(dir / "b.fap").frames.size(), 16u);
  EXPECT_THAT(slurp(dir / "b.fap"), HasSubstr(" 29.97 16\n"));
  EXPECT_EQ(read(dir / "b.fap").rate, held.rate);
}

TEST(FaceText, SpeechIsForPlayers) {
  const TempDir dir;
  spill(dir / "s.tsv",
        "start_s\tend_s\tphone\n0\t0.2\tSIL\n0.2\t0.3\tB\n0.3\t0.5\tAA\n0.5\t0.6\tM\n");
  for (const char* rate : {"25", "29.97"}) {
    succeeds(
        {"speak", "--script", dir / "s.tsv", "--rate", rate, "--idle-motion", "-o", dir / "a.fap"});
    expect_right(dir / "a.fap");
  }
  succeeds({"speak", "--script", dir / "s.tsv", "--rate", "29.97", "--exact", "-o", dir / "b.fap"});
  EXPECT_THAT(slurp(dir / "b.fap"), HasSubstr(" 29.97 "));
}

// FAP 1 for players that know visemes only: in text, streams and containers, and to be seen.
TEST(FaceText, SpeechAsVisemes) {
  const TempDir dir;
  spill(dir / "s.tsv",
        "start_s\tend_s\tphone\n0\t0.2\tSIL\n0.2\t0.32\tB\n0.32\t0.6\tAA\n0.6\t0.7\tM\n");
  const auto speak = [&](const std::string& place, const std::string& output) {
    succeeds({"speak", "--script", dir / "s.tsv", "--visemes", place, "-o", dir / output});
  };
  speak("instead", "a.fap");
  EXPECT_EQ(animeme({"check", "--high-level", dir / "a.fap"}).exit_code, 0);
  EXPECT_EQ(animeme({"check", dir / "a.fap"}).exit_code, 1);
  const fap::Sequence clip = read(dir / "a.fap");
  for (const fap::Frame& frame : clip.frames) EXPECT_EQ(frame.mask, fap::Mask(2));
  for (const char* output : {"a.fba", "a.mp4"}) {
    speak("instead", output);
    succeeds({"decode", dir / output, "-o", dir / "b.fap"});
    EXPECT_TRUE(read(dir / "b.fap").frames == clip.frames) << output;
  }
  succeeds({"decode", dir / "a.mp4", "--expand", "-o", dir / "c.fap"});
  expect_right(dir / "c.fap");
  speak("beside", "d.fap");
  const fap::Sequence beside = read(dir / "d.fap");
  EXPECT_TRUE(beside.frames[0].mask[1] && beside.frames[0].mask[3]);
  EXPECT_EQ(beside.frames[9].viseme, clip.frames[9].viseme);
  EXPECT_EQ(
      animeme({"speak", "--script", dir / "s.tsv", "--visemes", "beside", "-o", dir / "x.csv"})
          .exit_code,
      2);
}

TEST(FaceText, SkippedFramesHaveALimit) {
  const TempDir dir;
  fap::Sequence clip = face({25, 1}, 3);
  clip.frames.back().number = 5'000'000;
  spill(dir / "a.fap", fap::write_text(clip));
  const auto result = animeme({"decode", dir / "a.fap", "-o", dir / "b.fap"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("more than a million frames are skipped"));
  EXPECT_FALSE(std::filesystem::exists(dir / "b.fap"));
  succeeds({"decode", dir / "a.fap", "--exact", "-o", dir / "b.fap"});
  EXPECT_EQ(read(dir / "b.fap").frames.size(), 3u);
}

// Decoding while writing gives what decoding at once gives, damage included.
TEST(FaceText, StreamsAreReadInPieces) {
  const TempDir dir;
  spill(dir / "a.fap", fap::write_text(test::random_clip(5, 6000)));
  succeeds({"encode", dir / "a.fap", "--quant", "1", "-o", dir / "a.fba"});
  ASSERT_GT(std::filesystem::file_size(dir / "a.fba"), 1u << 17);
  succeeds({"decode", dir / "a.fba", "-o", dir / "b.fap"});
  const auto piped = animeme({"decode", "-", "-o", dir / "c.fap"}, slurp(dir / "a.fba"));
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  const fap::Sequence b = read(dir / "b.fap");
  EXPECT_GT(b.frames.size(), 2000u);
  EXPECT_TRUE(b.frames == read(dir / "c.fap").frames);
  std::string cut = slurp(dir / "a.fba");
  cut.resize(cut.size() / 2);
  spill(dir / "cut.fba", cut);
  EXPECT_EQ(animeme({"decode", dir / "cut.fba", "-o", dir / "x.fap", "--strict"}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(dir / "x.fap"));
}

}  // namespace face_text_test
}  // namespace animeme
