// The presets of `animeme encode`, end to end: what is written, decoded, filled and reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fap/tables.h"
#include "fap/text.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme {
namespace encode_presets_test {

using test::animeme;
using test::Json;
using test::json_of;
using test::read_clip;
using test::slurp;
using test::spill;
using test::succeeds;
using test::TempDir;
using testing::HasSubstr;
using testing::IsEmpty;

using Arguments = std::vector<std::string>;

constexpr int kRestAtZero = 31;  // and 32
constexpr int kRestElsewhere = 4;

// A face that talks: lips and jaw in sines with equal sides, brows at rest, a head that nods, and
// a gap in the numbers.
fap::Sequence talking_clip(int frames, bool high_level) {
  fap::Sequence clip;
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    frame.number = i < frames / 2 ? i : i + 6;
    const auto wave = [i](double size, double phase) {
      return int(std::lround(size * std::sin(0.23 * i + phase)));
    };
    frame.set(3, 150 + wave(150, 0));
    frame.set(kRestElsewhere, 90);
    frame.set(5, wave(80, 1));
    for (const int side : {6, 7}) frame.set(side, wave(60, 2));
    frame.set(kRestAtZero, 0);
    frame.set(kRestAtZero + 1, 0);
    frame.set(48, wave(9000, 3));
    if (high_level) {
      frame.mask.set(1).set(2);
      frame.viseme = {i % 15, (i / 2) % 15, (i * 7) % 64, i % 9 == 4};
      frame.expression = {i / 20 % 7, i % 64, 0, 63 - i % 64, i == 0, i % 11 == 5};
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

std::string write_clip(const TempDir& dir, const std::string& name, const fap::Sequence& clip) {
  const std::string path = dir / name;
  spill(path, fap::write_text(clip));
  return path;
}

// BAPs 1 (moves), 40 (moves, with a gap), 7 (at rest).
std::string write_body(const TempDir& dir, int frames) {
  std::string text = "3.1 body 25 " + std::to_string(frames) + "\n";
  for (int i = 0; i < frames; ++i) {
    for (int bap = 1; bap <= 186; ++bap) {
      text += bap == 1 || bap == 7 || (bap == 40 && i % 3 != 1) ? "1 " : "0 ";
    }
    text += "\n" + std::to_string(i) + " " + std::to_string(500 * (i % 13)) + " 0";
    if (i % 3 != 1) text += " " + std::to_string(-700 * (i % 5));
    text += "\n";
  }
  const std::string path = dir / "body.bap";
  spill(path, text);
  return path;
}

// Nearest within half a quantiser step, for every FAP that the clip has.
void expect_close(const fap::Sequence& clip, const fap::Sequence& shown) {
  ASSERT_EQ(clip.frames.size(), shown.frames.size());
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    ASSERT_EQ(clip.frames[i].number, shown.frames[i].number);
    EXPECT_EQ(clip.frames[i].mask, shown.frames[i].mask) << i;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const std::size_t n = std::size_t(fap);
      if (!clip.frames[i].mask[n]) continue;
      EXPECT_LE(std::abs(clip.frames[i].value[n] - shown.frames[i].value[n]),
                fap::info(fap).quant_step / 2)
          << "frame " << i << " FAP " << fap;
    }
    if (clip.frames[i].mask[1]) {
      EXPECT_EQ(clip.frames[i].viseme, shown.frames[i].viseme) << i;
    }
    if (clip.frames[i].mask[2]) {
      EXPECT_EQ(clip.frames[i].expression, shown.frames[i].expression) << i;
    }
  }
}

// Root mean square of one kind of the FAPs that move.
double rms(const fap::Sequence& clip, const fap::Sequence& shown, bool angles) {
  double error = 0;
  double count = 0;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if ((fap::info(fap).unit == fap::Unit::angle) != angles) continue;
    const std::size_t n = std::size_t(fap);
    const auto rests = [&](const fap::Frame& frame) {
      return frame.value[n] == clip.frames[0].value[n];
    };
    if (std::all_of(clip.frames.begin(), clip.frames.end(), rests)) continue;
    const double unit = angles ? fap::info(fap).quant_step * 0.5 : 1;
    for (const fap::Frame& frame : clip.frames) {
      // fill() gives every number its frame.
      const fap::Frame& got = shown.frames.at(std::size_t(frame.number));
      const double difference = (frame.value[n] - got.value[n]) / unit;
      error += difference * difference;
      ++count;
    }
  }
  return std::sqrt(error / count);
}

fap::Sequence filled(const TempDir& dir, const std::string& stream) {
  succeeds({"decode", stream, "--fill", "-o", dir / "filled.fap"});
  return read_clip(dir / "filled.fap");
}

class WholeClip : public testing::TestWithParam<const char*> {};

TEST_P(WholeClip, ComesBackWithinTheQuantiser) {
  for (const bool high_level : {false, true}) {
    const TempDir dir;
    const fap::Sequence clip = talking_clip(60, high_level);
    const std::string text = write_clip(dir, "a.fap", clip);
    const Json report = json_of({"encode", text, "--preset", GetParam(), "-o", dir / "a.fba"});
    EXPECT_EQ(report["planes"], 60);
    EXPECT_EQ(report["bytes"], slurp(dir / "a.fba").size());
    EXPECT_NEAR(report["kbit_per_s"].get<double>(), report["bytes"].get<double>() * 8e-3 * 25 / 66,
                1e-9);
    succeeds({"decode", dir / "a.fba", "--coded", "-o", dir / "b.fap"});
    expect_close(clip, read_clip(dir / "b.fap"));
    succeeds({"compare", text, dir / "a.fba", "--max-rms", "0.5"});
    const Json info = json_of({"info", dir / "a.fba"});
    EXPECT_EQ(info["intra_planes"], report["intra_planes"]);
    EXPECT_EQ(info["warnings"].size(), 0U);
    // 66 FAPs at most; the gap of 6 frames counts as time.
    EXPECT_NEAR(info["seconds"].get<double>(), 66 / 25.0, 1e-9);
  }
}

TEST_P(WholeClip, TakesABody) {
  const TempDir dir;
  const std::string body = write_body(dir, 40);
  const std::string face = write_clip(dir, "a.fap", talking_clip(40, true));
  succeeds({"encode", face, "--bap", body, "--preset", GetParam(), "-o", dir / "both.fba"});
  succeeds({"encode", "--bap", body, "--preset", GetParam(), "-o", dir / "body.fba"});
  EXPECT_EQ(json_of({"info", dir / "both.fba"})["body_planes"], 46);  // the face's gap included
  EXPECT_EQ(json_of({"info", dir / "body.fba"})["body_planes"], 40);
  for (const char* stream : {"both.fba", "body.fba"}) {
    succeeds({"decode", dir / stream, "--bap", dir / "out.bap"});
    EXPECT_THAT(slurp(dir / "out.bap"), HasSubstr("3.1 "));
  }
}

TEST_P(WholeClip, IsTheSameTwice) {
  const TempDir dir;
  const std::string text = write_clip(dir, "a.fap", talking_clip(50, true));
  Arguments arguments = {"encode", text, "--preset", GetParam(), "-o", dir / "a.fba"};
  succeeds(arguments);
  arguments.back() = dir / "b.fba";
  succeeds(arguments);
  EXPECT_EQ(slurp(dir / "a.fba"), slurp(dir / "b.fba"));
  // And on standard output.
  arguments.back() = "-";
  const auto piped = animeme(arguments);
  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_EQ(piped.out, slurp(dir / "a.fba"));
}

INSTANTIATE_TEST_SUITE_P(All, WholeClip, testing::Values("plain", "live"));

TEST(FilePreset, ShowsWhatPlainShows) {
  for (const bool high_level : {false, true}) {
    for (const char* quant : {"1", "3", "8"}) {
      const TempDir dir;
      const std::string text = write_clip(dir, "a.fap", talking_clip(60, high_level));
      succeeds({"encode", text, "--quant", quant, "-o", dir / "plain.fba"});
      const Json report =
          json_of({"encode", text, "--preset", "file", "--quant", quant, "-o", dir / "file.fba"});
      EXPECT_EQ(report["mirrored"], 1);
      EXPECT_EQ(report["left_out"], 2);
      EXPECT_EQ(report["coded"], 5);
      EXPECT_LT(slurp(dir / "file.fba").size(), slurp(dir / "plain.fba").size());
      const fap::Sequence plain = filled(dir, dir / "plain.fba");
      const fap::Sequence file = filled(dir, dir / "file.fba");
      ASSERT_EQ(plain.frames.size(), 66U);
      // The same masks, too: what is not coded is shown at rest.
      EXPECT_TRUE(plain.frames == file.frames);
      EXPECT_EQ(file.frames[0].mask.count(), 66U);
    }
  }
}

TEST(FilePreset, CodesFlagsOfFap1And2AsGiven) {
  const TempDir dir;
  const fap::Sequence clip = talking_clip(60, true);
  const std::string text = write_clip(dir, "a.fap", clip);
  succeeds({"encode", text, "--preset", "file", "--skip-still", "-o", dir / "a.fba"});
  succeeds({"decode", dir / "a.fba", "--coded", "-o", dir / "b.fap"});
  const fap::Sequence shown = read_clip(dir / "b.fap");
  ASSERT_EQ(shown.frames.size(), clip.frames.size());
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    EXPECT_EQ(shown.frames[i].viseme, clip.frames[i].viseme);
    EXPECT_EQ(shown.frames[i].expression, clip.frames[i].expression);
  }
}

TEST(FilePreset, TakesABody) {
  const TempDir dir;
  const std::string body = write_body(dir, 40);
  const Json report = json_of({"encode", "--bap", body, "--preset", "file", "-o", dir / "a.fba"});
  EXPECT_EQ(report["coded"], 2);
  EXPECT_EQ(report["left_out"], 1);
  const Json coarse =
      json_of({"encode", "--bap", body, "--preset", "file", "--rms", "4", "-o", dir / "b.fba"});
  EXPECT_LE(coarse["rms_other"], 4.0);
  EXPECT_LT(slurp(dir / "b.fba").size(), slurp(dir / "a.fba").size());
}

TEST(FilePreset, KeepsTheErrorThatItReports) {
  const TempDir dir;
  const fap::Sequence clip = talking_clip(120, false);
  const std::string text = write_clip(dir, "a.fap", clip);
  double before = 1e9;
  for (const double limit : {1.0, 2.0, 6.0}) {
    const Json report = json_of(
        {"encode", text, "--preset", "file", "--rms", std::to_string(limit), "-o", dir / "a.fba"});
    const fap::Sequence shown = filled(dir, dir / "a.fba");
    EXPECT_NEAR(report["rms"].get<double>(), rms(clip, shown, false), 1e-9);
    EXPECT_NEAR(report["rms_other"].get<double>(), rms(clip, shown, true), 1e-9);
    EXPECT_LE(report["rms"], limit);
    EXPECT_LE(report["rms_other"], limit);
    EXPECT_LT(report["bytes"], before);
    before = report["bytes"];
  }
}

TEST(FilePreset, KeepsTheRate) {
  const TempDir dir;
  const std::string text = write_clip(dir, "a.fap", talking_clip(250, false));
  for (const double limit : {0.5, 0.8}) {
    const Json report = json_of(
        {"encode", text, "--preset", "file", "--kbps", std::to_string(limit), "-o", dir / "a.fba"});
    EXPECT_LE(report["kbit_per_s"], limit);
    EXPECT_GT(report["kbit_per_s"], 0.8 * limit);
    EXPECT_GT(report["rms"], 0.5);
  }
  // What cannot be reached is said, and the smallest stream written.
  const auto result =
      animeme({"encode", text, "--preset", "file", "--kbps", "0.01", "-o", dir / "b.fba"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("is the least that this clip needs, 0.01 asked"));
  EXPECT_LT(slurp(dir / "b.fba").size(), slurp(dir / "a.fba").size());
}

TEST(FilePreset, HoldsStillWhatHardlyMoves) {
  const TempDir dir;
  fap::Sequence clip = talking_clip(60, false);
  for (fap::Frame& frame : clip.frames) frame.set(63, 50 + int(frame.number % 3));
  const std::string text = write_clip(dir, "a.fap", clip);
  const Json report =
      json_of({"encode", text, "--preset", "file", "--still-below", "4", "-o", dir / "a.fba"});
  EXPECT_EQ(report["stilled"], 1);
  const fap::Sequence shown = filled(dir, dir / "a.fba");
  for (const fap::Frame& frame : shown.frames) {
    EXPECT_NEAR(frame.value[63], 51, 1);
    EXPECT_EQ(frame.value[63], shown.frames[0].value[63]);
  }
}

TEST(FilePreset, SkipsWhatIsStill) {
  const TempDir dir;
  fap::Sequence clip = talking_clip(100, false);
  for (std::size_t i = 30; i < 80; ++i) {
    const std::int64_t number = clip.frames[i].number;
    clip.frames[i] = clip.frames[29];
    clip.frames[i].number = number;
  }
  const std::string text = write_clip(dir, "a.fap", clip);
  succeeds({"encode", text, "--preset", "file", "-o", dir / "all.fba"});
  const Json report =
      json_of({"encode", text, "--preset", "file", "--skip-still", "-o", dir / "moving.fba"});
  EXPECT_EQ(report["skipped"], 50);
  EXPECT_EQ(report["planes"], 50);
  EXPECT_LT(slurp(dir / "moving.fba").size(), slurp(dir / "all.fba").size());
  EXPECT_EQ(filled(dir, dir / "moving.fba").frames, filled(dir, dir / "all.fba").frames);
}

TEST(LivePreset, ReceiversCanJoinInTheMiddle) {
  const TempDir dir;
  const std::string text = write_clip(dir, "a.fap", talking_clip(120, true));
  for (const bool old_codes : {false, true}) {
    Arguments arguments = {"encode", text, "--preset", "live", "-o", dir / "a.fba"};
    arguments.insert(arguments.end(), {"--intra-period", "30", "--plane-start-codes", "all"});
    if (old_codes) arguments.push_back("--old-codes");
    succeeds(arguments);
    const std::string bytes = slurp(dir / "a.fba");
    succeeds({"decode", dir / "a.fba", "--coded", "-o", dir / "a.out.fap"});
    const fap::Sequence whole = read_clip(dir / "a.out.fap");
    const Json planes = json_of({"info", dir / "a.fba", "--planes"})["plane_list"];
    ASSERT_EQ(planes.size(), 120U);
    int joined = 0;
    for (std::size_t i = 0; i < planes.size(); ++i) {
      EXPECT_EQ(planes[i]["start_code"], true) << i;
      EXPECT_EQ(planes[i]["bit"].get<int>() % 8, 0);
      if (planes[i]["type"] != "I") continue;
      const std::size_t start = planes[i]["bit"].get<std::size_t>() / 8 - 4;
      EXPECT_EQ(bytes.substr(start, 4),
                old_codes ? std::string("\0\0\1\3", 4) : std::string("\0\0\1\xBB", 4));
      spill(dir / "rest.fba", bytes.substr(start));
      succeeds({"decode", dir / "rest.fba", "--coded", "-o", dir / "rest.fap"});
      const fap::Sequence rest = read_clip(dir / "rest.fap");
      ASSERT_EQ(rest.frames.size(), 120 - i);
      EXPECT_EQ(rest.rate, whole.rate);
      for (std::size_t k = 0; k < rest.frames.size(); ++k) {
        fap::Frame expected = whole.frames[i + k];
        expected.number -= whole.frames[i].number;
        ASSERT_EQ(rest.frames[k], expected) << i << "+" << k;
      }
      ++joined;
    }
    EXPECT_EQ(joined, 4);
  }
}

// Joining points in seconds at any rate, found by their start codes; the values are those of
// `file`.
TEST(LivePreset, HasAJoiningPointEveryTwoSeconds) {
  const TempDir dir;
  fap::Sequence clip = talking_clip(300, true);
  for (const std::uint32_t rate : {25, 60}) {
    clip.rate = {rate, 1};
    const std::string text = write_clip(dir, "a.fap", clip);
    succeeds({"encode", text, "--preset", "file", "-o", dir / "file.fba"});
    for (const std::string seconds : {"", "1", "0.5"}) {
      Arguments arguments = {"encode", text, "--preset", "live", "-o", dir / "live.fba"};
      if (!seconds.empty()) arguments.insert(arguments.end(), {"--intra-seconds", seconds});
      succeeds(arguments);
      const double period = (seconds.empty() ? 2 : std::stod(seconds)) * rate;
      double since = 0;
      for (const Json& plane : json_of({"info", dir / "live.fba", "--planes"})["plane_list"]) {
        EXPECT_EQ(plane["start_code"], plane["type"] == "I");
        since = plane["type"] == "I" ? 0 : since + 1;
        EXPECT_LT(since, period);
      }
      EXPECT_EQ(filled(dir, dir / "live.fba").frames, filled(dir, dir / "file.fba").frames);
    }
  }
}

// On what was recorded, sentences of a few seconds: `live` may cost 1.15 times `file`.
TEST(LivePreset, CostsLittleMoreThanFile) {
  const TempDir dir;
  double file = 0, live = 0, kept = 0;
  for (const char* sentence : {"prac8p", "bram5a", "sgwj7a", "lwbf2n", "pbwdzp", "pwwrzp"}) {
    const std::string csv =
        test::data_dir() / "grid_s1_sample" / "fap" / (std::string(sentence) + ".csv");
    const auto bytes = [&](const Arguments& more) {
      Arguments arguments = {"encode", csv, "-o", dir / "a.fba"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return json_of(arguments)["bytes"].get<double>();
    };
    file += bytes({"--preset", "file"});
    live += bytes({"--preset", "live", "--intra-seconds", "5"});
    kept += bytes({"--preset", "file", "--kept-ranges"});
  }
  ASSERT_GT(file, 0);
  EXPECT_LT(live, 1.15 * file);
  EXPECT_LT(kept, 0.97 * file);
}

TEST(ExactPreset, DoesAsTheParametersSay) {
  const TempDir dir;
  spill(dir / "a.epf",
        "FBM 1\nFFR 0\nISI 1\nFRR 25 0 0\nFQU 1\n"
        "FMT 0 1 1 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n");
  fap::Sequence clip;
  clip.frames.resize(1);
  clip.frames[0].set(3, 40);
  const std::string text = write_clip(dir, "a.fap", clip);
  const auto given = animeme({"encode", text, "--epf", dir / "a.epf", "-o", dir / "a.fba"});
  const auto named =
      animeme({"encode", text, "--preset", "exact", "--epf", dir / "a.epf", "-o", dir / "b.fba"});
  ASSERT_EQ(given.exit_code, 0) << given.err;
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_EQ(slurp(dir / "a.fba"), slurp(dir / "b.fba"));
  succeeds({"compare", text, dir / "a.fba"});
}

// Exit code 2, a sentence and where to find more, nothing written.
TEST(EncodeUsage, ContradictionsAreOneSentence) {
  const TempDir dir;
  const std::string text = write_clip(dir, "a.fap", talking_clip(5, false));
  spill(dir / "a.epf", "FBM 1\n");
  const std::string epf = dir / "a.epf";
  const auto before = dir.files();
  for (const Arguments& more :
       std::vector<Arguments>{{"--rms", "2"},
                              {"--kbps", "1"},
                              {"--still-below", "3"},
                              {"--skip-still"},
                              {"--preset", "plain", "--rms", "2"},
                              {"--kept-ranges"},
                              {"--preset", "live", "--kept-ranges"},
                              {"--preset", "file", "--kept-ranges", "--intra-seconds", "5"},
                              {"--intra-seconds", "5", "--intra-period", "125"},
                              {"--preset", "exact"},
                              {"--preset", "file", "--epf", epf},
                              {"--preset", "live", "--epf", epf},
                              {"--epf", epf, "--quant", "2"},
                              {"--epf", epf, "--intra-period", "9"},
                              {"--epf", epf, "--intra-seconds", "9"},
                              {"--epf", epf, "--rms", "1"},
                              {"--preset", "file", "--rms", "2", "--quant", "1"},
                              {"--preset", "file", "--kbps", "2", "--quant", "1"},
                              {"--preset", "file", "--rms", "nan"},
                              {"--rms", "nan"}}) {
    Arguments arguments = {"encode", text, "-o", dir / "out.fba"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = animeme(arguments);
    const std::string said = testing::PrintToString(more) + result.err;
    EXPECT_EQ(result.exit_code, 2) << said;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2) << said;
    EXPECT_TRUE(result.err.starts_with("animeme: ")) << said;
    EXPECT_TRUE(result.err.ends_with("\nRun 'animeme encode --help'.\n")) << said;
    EXPECT_THAT(result.out, IsEmpty()) << said;
    EXPECT_EQ(dir.files().size(), before.size()) << said;
  }
  for (const Arguments& more : std::vector<Arguments>{{"--preset", "small"},
                                                      {"--preset", "file", "--rms", "-1"},
                                                      {"--preset", "file", "--kbps", "inf"},
                                                      {"--quant", "32"},
                                                      {"--intra-period", "-1"}}) {
    Arguments arguments = {"encode", text, "-o", dir / "out.fba"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(more[more.size() - 2])) << "the option's name";
    EXPECT_EQ(dir.files().size(), before.size());
  }
  const auto piped = animeme({"encode", text, "-o", "-", "--json"});
  EXPECT_EQ(piped.exit_code, 2);
  EXPECT_THAT(piped.out, testing::StartsWith("{\n  \"error\": {")) << "no byte of a stream";
  EXPECT_EQ(animeme({"encode", "-o", dir / "out.fba"}).exit_code, 2);
}

TEST(EncodeErrors, NameFrameAndParameter) {
  const TempDir dir;
  fap::Sequence clip = talking_clip(10, false);
  clip.frames[0].set(5, 100000);
  const std::string text = write_clip(dir, "a.fap", clip);
  fap::Sequence apart = talking_clip(4, false);
  apart.frames[3].number = 4294967296 + apart.frames[2].number + 1;
  const std::string far = write_clip(dir, "b.fap", apart);
  for (const char* preset : {"plain", "file", "live"}) {
    auto result =
        animeme({"encode", text, "--preset", preset, "-o", dir / "out.fba", "--quant", "0"});
    EXPECT_EQ(result.exit_code, 3) << preset;
    EXPECT_THAT(result.err, HasSubstr("FAP 5")) << preset;
    EXPECT_THAT(result.err, HasSubstr("frame 0")) << preset;
    result = animeme({"encode", far, "--preset", preset, "-o", dir / "out.fba"});
    EXPECT_EQ(result.exit_code, 3) << preset << result.err;
    EXPECT_THAT(result.err, HasSubstr("more than a million frames")) << preset;
  }
  EXPECT_EQ(dir.files().size(), 2U);
}

// What no plane can tell is coded as near as can be, with a warning.
TEST(EncodeErrors, ValuesTooFarAreAWarning) {
  const TempDir dir;
  fap::Sequence clip = talking_clip(10, false);
  for (fap::Frame& frame : clip.frames) frame.set(14, 1900);
  const std::string text = write_clip(dir, "a.fap", clip);
  for (const char* preset : {"plain", "file", "live"}) {
    const auto result = animeme({"encode", text, "--preset", preset, "-o", dir / "a.fba"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("1 values are out of the range")) << preset;
    const fap::Sequence shown = filled(dir, dir / "a.fba");
    EXPECT_EQ(shown.frames[0].value[14], 1860);
    EXPECT_EQ(shown.frames[1].value[14], 1900);
  }
}

}  // namespace encode_presets_test
}  // namespace animeme
