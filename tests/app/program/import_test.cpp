// `animeme import`: recordings of ARKit blend shapes as a user has them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fap/text.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace import_test {

using test::animeme;
using test::spill;
using test::TempDir;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

fap::Sequence read(const std::string& path) {
  const auto clip = fap::read_text(test::slurp(path));
  EXPECT_TRUE(clip) << (clip ? "" : clip.error().describe());
  return clip ? *clip : fap::Sequence{};
}

std::vector<std::int64_t> numbers(const fap::Sequence& clip) {
  std::vector<std::int64_t> out;
  for (const fap::Frame& frame : clip.frames) out.push_back(frame.number);
  return out;
}

struct Imported {
  fap::Sequence clip;
  std::string talk;
};

Imported import(const std::string& table, std::vector<std::string> options = {}) {
  const TempDir dir;
  spill(dir / "take.csv", table);
  std::vector<std::string> arguments = {"import", dir / "take.csv", "--exact", "-o",
                                        dir / "take.fap"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const auto result = animeme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return {read(dir / "take.fap"), result.err};
}

// Rows of Live Link Face with JawOpen = 0, 0.1, 0.2 ..., timecodes from 23:59:58:00.
std::string live_link(int rows, int per_second, int step = 1) {
  std::string text = "Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen,HeadYaw\n";
  for (int i = 0; i < rows; ++i) {
    const int frame = i * step;
    const int second = (86398 + frame / per_second) % 86400;
    char line[96];
    std::snprintf(line, sizeof line, "%02d:%02d:%02d:%02d.%03d,61,0.5,%.1f,0.25\n", second / 3600,
                  second / 60 % 60, second % 60, frame % per_second, i % 3 * 90, i % 10 * 0.1);
    text += line;
  }
  return text;
}

TEST(Import, LiveLinkFace) {
  // Past midnight.
  const Imported take = import(live_link(300, 60));
  EXPECT_EQ(take.clip.rate, (fap::Rate{60, 1}));
  EXPECT_EQ(take.clip.name, "take");
  ASSERT_EQ(take.clip.frames.size(), 300u);
  EXPECT_EQ(take.clip.frames.back().number, 299);
  EXPECT_EQ(take.clip.frames[3].value[3], 408);  // 0.3 * 1360
  EXPECT_EQ(take.clip.frames[3].value[19], 498);
  EXPECT_EQ(take.clip.frames[3].value[49], -25000);
  ASSERT_TRUE(take.clip.frames[3].mask[20]);
  EXPECT_EQ(take.clip.frames[3].value[20], 0) << "the left eye alone blinks";
  EXPECT_THAT(take.talk, AllOf(HasSubstr("300 frames"), HasSubstr("60 frames per second")));
  EXPECT_THAT(take.talk, testing::Not(HasSubstr("warning")));
}

TEST(Import, TheRateOfTheRowsIsNotThatOfTheTimecode) {
  EXPECT_EQ(import(live_link(120, 60, 2)).clip.rate, (fap::Rate{30, 1}));
  EXPECT_EQ(import(live_link(120, 30)).clip.rate, (fap::Rate{30, 1}));
  EXPECT_EQ(import(live_link(120, 24)).clip.rate, (fap::Rate{24, 1}));
  EXPECT_EQ(import(live_link(120, 25)).clip.rate, (fap::Rate{25, 1}));
}

TEST(Import, TimecodesCountWholeFrames) {
  const Imported take = import(live_link(120, 30), {"--rate", "29.97"});
  EXPECT_EQ(take.clip.rate, (fap::Rate{30000, 1001}));
  EXPECT_EQ(take.clip.frames.size(), 120u);
  EXPECT_EQ(take.clip.frames.back().number, 119);
}

TEST(Import, AShortTakeAsksForTheRate) {
  const std::string rows = live_link(12, 30);
  EXPECT_THAT(import(rows).talk, AllOf(HasSubstr("warning"), HasSubstr("give the frame rate")));
  const Imported told = import(rows, {"--rate", "30"});
  EXPECT_EQ(told.clip.rate, (fap::Rate{30, 1}));
  EXPECT_EQ(numbers(told.clip), (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_THAT(told.talk, testing::Not(HasSubstr("warning")));
}

TEST(Import, RowsWithoutAFaceBecomeSkippedFrames) {
  std::string text = live_link(100, 30);
  const std::size_t begin = text.find("23:59:58:10");
  const std::size_t end = text.find("23:59:58:13");
  text.replace(begin, end - begin, "23:59:58:10.000,0\n23:59:58:11.000,0,,,\n");
  const Imported take = import(text, {"--no-repair"});
  EXPECT_EQ(take.clip.frames.size(), 97u);
  EXPECT_EQ(take.clip.frames[9].number, 9);
  EXPECT_EQ(take.clip.frames[10].number, 13);
  EXPECT_THAT(take.talk,
              AllOf(HasSubstr("without a face, skipped: 2\n"), HasSubstr("3 frames skipped")));
}

// Seconds at `rate` with a little jitter; a cosine in one channel.
std::string curves(int rows, double rate, const char* format = "%.4f") {
  std::string text = "time_s,jawOpen,mouthSmile_L\n";
  for (int i = 0; i < rows; ++i) {
    char time[32];
    std::snprintf(time, sizeof time, format, i / rate + 0.001 * (i % 3));
    text += std::string(time) + ",0.5,0." + std::to_string(i % 10) + "\n";
  }
  return text;
}

TEST(Import, RatesFromSeconds) {
  const struct {
    double rate;
    fap::Rate want;
  } cases[] = {{24, {24, 1}}, {25, {25, 1}},
               {30, {30, 1}}, {30 / 1.001, {30000, 1001}},
               {50, {50, 1}}, {60 / 1.001, {60000, 1001}},
               {60, {60, 1}}, {12.5, {25, 2}},
               {17, {17, 1}}};
  for (const auto& one : cases) {
    const Imported take = import(curves(400, one.rate));
    EXPECT_EQ(take.clip.rate, one.want) << one.rate;
    EXPECT_EQ(take.clip.frames.size(), 400u) << one.rate;
    EXPECT_EQ(take.clip.frames.back().number, 399) << one.rate;
  }
}

TEST(Import, GapsAndCrowdsBecomeFrameNumbers) {
  const Imported take = import(
      "time,jawOpen,jawLeft\n5,0,0\n5.04,0.1,0\n5.08,0.2,0\n5.24,0.3,0\n5.28,0.4,0\n5.281,0.5,0\n"
      "5.32,0.6,0\n",
      {"--no-repair"});
  EXPECT_EQ(take.clip.rate, (fap::Rate{25, 1}));
  EXPECT_THAT(numbers(take.clip), ElementsAre(0, 1, 2, 6, 7, 8));
  EXPECT_EQ(take.clip.frames[4].value[3], 680);  // the last of the two rows
  EXPECT_THAT(take.talk, HasSubstr("same frame as the next one, skipped: 1 (at 25"));
}

TEST(Import, ALowerRateThinsOut) {
  const Imported take = import(curves(100, 50, "%.2f"), {"--rate", "25"});
  EXPECT_EQ(take.clip.frames.size(), 51u);
  EXPECT_EQ(take.clip.frames.back().number, 50);
}

TEST(Import, SeparatorsCaseAndForeignColumns) {
  const Imported take = import(
      "\xEF\xBB\xBFTIME_S;JAWOPEN;Comfort;headpitch;headRoll;measured\r\n"
      "0;0.5;7;10;0;1\r\n\r\n0.04;0.5;7;-10;0;1\r\n",
      {"--degrees"});
  EXPECT_THAT(take.talk, HasSubstr("ignored: Comfort\n"));
  ASSERT_EQ(take.clip.frames.size(), 2u);
  EXPECT_EQ(take.clip.frames[0].value[48], 17453);
  EXPECT_EQ(take.clip.frames[0].value[3], 680);
  EXPECT_FALSE(take.clip.frames[0].mask[50]) << "an angle that is always 0 was not recorded";
  EXPECT_THAT(import("time_s\tjawOpen\theadYaw\n0\t1\t45\n0.1\t1\t0\n").talk, HasSubstr("degrees"));
}

TEST(Import, BadTables) {
  const TempDir dir;
  const std::string head = "time_s,jawOpen,jawLeft\n";
  const struct {
    std::string text;
    const char* where;
    const char* what;
  } cases[] = {
      {"", "take.csv:", "empty"},
      {head, "take.csv:", "no row"},
      {"a,b\n1,2\n", ":1:", "jawOpen"},
      {"jawOpen,jawLeft\n0,0\n", ":1:", "Timecode"},
      {"time_s,jawOpen,JawOpen\n0,0,0\n", ":1:16:", "twice"},
      {head + "0,1,0\n0.04,x,0\n", ":3:6:", "jawOpen is 'x'"},
      {head + "0,1,0\n0.04,1,?\n", ":3:8:", "jawLeft"},
      {head + "0,1,inf\n", ":2:5:", "finite"},
      {head + "0,1,0\n0.04,1\n", ":3:", "2 fields"},
      {head + "0,1,0\n1:2,1,0\n", ":3:1:", "is not a time"},
      {head + "0,1,0\n00:00:-1:00,1,0\n", ":3:1:", "is not a time"},
      {head + "0,1,0\n0.04,1,0\n0.02,1,0\n", ":4:", "goes back"},
      {head + "0,1,0\n0.04,1,0\n0.08,1,0\n1e9,1,0\n", ":5:", "10 million"},
      {head + "0,1,0\n", "take.csv:", "rate"},
      {head + "0,1,0\n0,1,0\n", "take.csv:", "rate"},
      {head + "0,1,0\n100,1,0\n", "take.csv:", "rate"},
      {"\x1f\x8b\x08", "take.csv:", "gunzip"},
  };
  for (const auto& one : cases) {
    spill(dir / "take.csv", one.text);
    const auto result = animeme({"import", dir / "take.csv", "-o", dir / "take.fap"});
    EXPECT_EQ(result.exit_code, 3) << one.text << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr(one.where), HasSubstr(one.what))) << one.text;
    EXPECT_THAT(dir.files(), ElementsAre("take.csv")) << one.text;
  }
  EXPECT_EQ(animeme({"import", dir / "take.csv", "-o", "-", "--rate", "fast"}).exit_code, 2);
  EXPECT_EQ(animeme({"import", dir / "take.csv"}).exit_code, 2);
  EXPECT_EQ(animeme({"import", "/nowhere/a.csv", "-o", "-"}).exit_code, 3);
}

TEST(Import, TheOutputIsFapText) {
  const TempDir dir;
  spill(dir / "take.csv", "time_s,jawOpen,jawLeft\n0,0,0\n0.04,1,0\n");
  const auto out = animeme({"import", dir / "take.csv", "-o", dir / "take.fba"});
  EXPECT_EQ(out.exit_code, 2);
  EXPECT_THAT(out.err, HasSubstr(".fap"));
}

TEST(Import, HelpHasExamples) {
  const auto result = animeme({"import", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("Examples:\n  animeme import "));
}

TEST(Import, OtherCommandsReadTheSameFiles) {
  const TempDir dir;
  spill(dir / "live.csv", live_link(120, 60));
  ASSERT_EQ(animeme({"import", dir / "live.csv", "--exact", "-o", dir / "live.fap"}).exit_code, 0);
  const auto direct = animeme({"encode", dir / "live.csv", "-o", dir / "a.fba"});
  ASSERT_EQ(direct.exit_code, 0) << direct.err;
  ASSERT_EQ(animeme({"encode", dir / "live.fap", "-o", dir / "b.fba"}).exit_code, 0);
  EXPECT_EQ(test::slurp(dir / "a.fba"), test::slurp(dir / "b.fba"));
}

TEST(Import, RealCaptures) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "the reference data are not here";
  const auto folder = test::shared_dir() / "data" / "livelink_rom" / "controls";
  const TempDir dir;
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto result = animeme({"import", entry.path().string(), "-o", dir / "take.fap"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const fap::Sequence clip = read(dir / "take.fap");
    EXPECT_EQ(clip.rate, (fap::Rate{30, 1}));
    EXPECT_GT(clip.frames.size(), 3800u);
    std::int32_t blink = 0, jaw = 0, left = 0, right = 0;
    for (const fap::Frame& frame : clip.frames) {
      ASSERT_LE(frame.value[19] + frame.value[21], 1024);
      blink = std::max(blink, frame.value[19] + frame.value[21]);
      jaw = std::max(jaw, frame.value[3]);
      left = std::max(left, frame.value[23]);
      right = std::min(right, frame.value[23]);
      // Both eyes look the same way, crossed by less than a quarter of a radian.
      ASSERT_LT(std::abs(frame.value[23] - frame.value[24]), 25000);
    }
    EXPECT_EQ(blink, 1024);  // the eyes close
    EXPECT_GT(jaw, 1000);
    EXPECT_GT(left, 30000);
    EXPECT_LT(right, -30000);
    const auto coded = animeme({"encode", dir / "take.fap", "-o", dir / "take.fba"});
    EXPECT_EQ(coded.exit_code, 0) << coded.err;
    ++files;
  }
  EXPECT_EQ(files, 2);
}

}  // namespace import_test
}  // namespace animeme
