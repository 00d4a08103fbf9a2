// People who talk to each other: speak --cast makes a face for each, render and view --people show
// them side by side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/app/program/commands.h"

namespace animeme {
namespace people_test {

using test::animeme;
using test::Json;
using test::json_of;
using test::slurp;
using test::spill;
using test::succeeds;
using test::TempDir;
using testing::HasSubstr;

constexpr const char* kDialogue =
    "WEBVTT\n\n"
    "00:00.300 --> 00:01.900\n<v Ann>Maybe I will buy a map.\n\n"
    "00:02.100 --> 00:03.800\n<v Bob>Papa's boat is much better.\n\n"
    "00:03.900 --> 00:05.200\n<v Ann>Nobody believes that.\n";

std::string tracks_of(const std::string& file) {
  std::string all;
  const Json info = json_of({"info", file});
  for (const Json& track : info["tracks"]) {
    all += std::string(track["kind"]) + " " + std::string(track.value("speaker", "")) + "; ";
  }
  return all;
}

// Mean of a FAP in a part of a clip, its units.
double mean_of(const fap::Sequence& clip, std::size_t fap, double from, double to) {
  double sum = 0, count = 0;
  for (const fap::Frame& frame : clip.frames) {
    const double time = clip.rate.seconds(double(frame.number));
    if (time < from || time >= to) continue;
    sum += frame.value[fap];
    ++count;
  }
  return sum / count;
}

// How far the jaw moves in a part of a clip, units.
double jaw_in(const fap::Sequence& clip, double from, double to) {
  double low = 1e9, high = -1e9;
  for (const fap::Frame& frame : clip.frames) {
    const double time = clip.rate.seconds(double(frame.number));
    if (time < from || time >= to) continue;
    low = std::min(low, double(frame.value[3]));
    high = std::max(high, double(frame.value[3]));
  }
  return high - low;
}

fap::Sequence face_of(const TempDir& dir, const std::string& film, const std::string& speaker) {
  succeeds({"decode", film, "--track", "speaker=" + speaker, "-o", dir / "face.fap"});
  return test::read_clip(dir / "face.fap");
}

class Dialogue : public testing::TestWithParam<const char*> {};

TEST_P(Dialogue, EachHasAFaceThatListens) {
  const TempDir dir;
  spill(dir / "talk.vtt", kDialogue);
  const std::string film = dir / (std::string("talk") + GetParam());
  const Json report = json_of({"speak", "--script", dir / "talk.vtt", "--fit", "0.8-1.3", "--cast",
                               "Ann,lang=en+f3", "--cast", "all", "-o", film});
  ASSERT_EQ(report["people"].size(), 2u);
  EXPECT_EQ(report["people"][0]["speaker"], "Ann");
  EXPECT_EQ(report["people"][1]["speaker"], "Bob");
  EXPECT_EQ(report["people"][0]["cues"].size(), 2u);
  for (const Json& person : report["people"]) {
    EXPECT_GT(person["closures"]["phones"], 0);
    EXPECT_EQ(person["closures"]["closed"], person["closures"]["phones"]);
    EXPECT_EQ(person["frames"], report["people"][0]["frames"]);
  }
  EXPECT_THAT(tracks_of(film), HasSubstr("face Ann; face Bob; audio ; "));
  const fap::Sequence ann = face_of(dir, film, "Ann"), bob = face_of(dir, film, "Bob");
  EXPECT_EQ(ann.frames.size(), bob.frames.size());
  EXPECT_GT(jaw_in(ann, 0.3, 1.9), 150);
  EXPECT_LT(jaw_in(bob, 0.3, 1.7), 30) << "who listens is silent";
  EXPECT_GT(jaw_in(bob, 2.1, 3.8), 150);
  EXPECT_LT(jaw_in(ann, 2.4, 3.6), 30);
  // Ann sits at the left of the picture, and looks to her left.
  constexpr double kDegree = 1745.329;
  const double left = (mean_of(ann, 23, 2.5, 3.8) + mean_of(ann, 49, 2.5, 3.8)) / kDegree;
  const double right = (mean_of(bob, 23, 0.5, 1.9) + mean_of(bob, 49, 0.5, 1.9)) / kDegree;
  EXPECT_GT(left, 12);
  EXPECT_LT(right, -12);
  // Words are each one's own; the sound is that of both.
  succeeds({"demux", film, "--track", "speaker=Bob", "-o", dir / "bob.TextGrid", "-o",
            dir / "both.wav"});
  EXPECT_THAT(slurp(dir / "bob.TextGrid"), HasSubstr("boat"));
  EXPECT_THAT(slurp(dir / "bob.TextGrid"), testing::Not(HasSubstr("Nobody")));
  EXPECT_GT(json_of({"info", dir / "both.wav"})["seconds"], 5.0);
  // Another voice is heard.
  succeeds({"speak", "--script", dir / "talk.vtt", "--fit", "0.8-1.3", "--cast", "Ann,lang=en+m7",
            "--cast", "all", "-o", dir / "other.mp4"});
  succeeds({"demux", dir / "other.mp4", "-o", dir / "other.wav"});
  EXPECT_NE(slurp(dir / "other.wav"), slurp(dir / "both.wav"));
  // Somebody who is told where to look does so.
  succeeds({"speak", "--script", dir / "talk.vtt", "--cast", "all", "--look", "camera", "--fit",
            "0.8-1.3", "--seed", "3", "-o", dir / "again.mp4"});
}

INSTANTIATE_TEST_SUITE_P(Files, Dialogue, testing::Values(".mp4", ".mkv"),
                         [](const auto& one) { return std::string(one.param + 1); });

TEST(People, KeepTheirPerformance) {
  const TempDir dir;
  spill(dir / "talk.vtt", kDialogue);
  // One raises the inner brow, the other one the outer.
  const auto spill_face = [&](const char* name, int fap) {
    fap::Sequence clip{{25, 1}, {}, name};
    for (int i = 0; i < 150; ++i) {
      fap::Frame& frame = clip.frames.emplace_back();
      frame.number = i;
      frame.set(fap, 120);
    }
    spill(dir / name, fap::write_text(clip));
  };
  spill_face("ann.fap", 31);
  spill_face("bob.fap", 35);
  succeeds({"mux", "--track", "speaker=Ann,face=" + (dir / "ann.fap"), "--track",
            "speaker=Bob,face=" + (dir / "bob.fap"), "-o", dir / "film.mp4"});
  const auto expect_brows = [&](const std::string& film, const char* who, int inner, int outer) {
    const fap::Sequence clip = face_of(dir, dir / film, who);
    EXPECT_NEAR(mean_of(clip, 31, 1, 5), inner, 3) << film << " " << who;
    EXPECT_NEAR(mean_of(clip, 35, 1, 5), outer, 3) << film << " " << who;
  };
  const std::vector<std::string> spoken = {"speak", "--script", dir / "talk.vtt",
                                           "--fit", "0.8-1.3",  "--no-idle-motion"};
  std::vector<std::string> by_name = spoken, by_file = spoken, unnamed = spoken;
  for (const auto* one : {"--cast", "all", "--over"}) by_name.emplace_back(one);
  by_name.insert(by_name.end(), {dir / "film.mp4", "-o", dir / "a.mp4"});
  succeeds(by_name);
  expect_brows("a.mp4", "Ann", 120, 0);
  expect_brows("a.mp4", "Bob", 0, 120);
  by_file.insert(by_file.end(),
                 {"--cast", "all", "--cast", "Bob,over=" + (dir / "ann.fap"), "-o", dir / "b.mp4"});
  succeeds(by_file);
  expect_brows("b.mp4", "Bob", 120, 0);
  unnamed.insert(unnamed.end(), {"--cast", "all", "--over", dir / "ann.fap", "-o", dir / "c.mp4"});
  const auto refused = animeme(unnamed);
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("Ann,over=ann.fba"));
}

TEST(People, TurnsTellWhoSpeaks) {
  const TempDir dir;
  spill(dir / "talk.tsv",
        "start_s\tend_s\tphone\tword\n0\t0.5\tSIL\t\n0.5\t0.8\tM\tma\n0.8\t1.5\tAA\tma\n"
        "1.5\t2.5\tSIL\t\n2.5\t2.8\tP\tpa\n2.8\t3.5\tAA\tpa\n3.5\t4\tSIL\t\n");
  spill(dir / "talk.rttm",
        "SPEAKER talk 1 0.4 1.2 <NA> <NA> Ann <NA> <NA>\n"
        "SPEAKER talk 1 2.4 1.2 <NA> <NA> Bob <NA> <NA>\n");
  succeeds({"speak", "--script", dir / "talk.tsv", "--turns", dir / "talk.rttm", "--cast", "all",
            "-o", dir / "talk.mp4"});
  const fap::Sequence ann = face_of(dir, dir / "talk.mp4", "Ann"),
                      bob = face_of(dir, dir / "talk.mp4", "Bob");
  EXPECT_GT(jaw_in(ann, 0.5, 1.6), 150);
  EXPECT_LT(jaw_in(ann, 2.2, 4), 30);
  EXPECT_LT(jaw_in(bob, 0, 2), 30);
  EXPECT_GT(jaw_in(bob, 2.4, 3.6), 150);
}

TEST(People, RecordingsOfEachAreMixed) {
  const TempDir dir;
  succeeds(
      {"speak", "Hello, my friend.", "-o", dir / "a.mp4", "--save-script", dir / "a.TextGrid"});
  succeeds({"demux", dir / "a.mp4", "-o", dir / "a.wav"});
  spill(dir / "talk.vtt",
        "WEBVTT\n\n00:00.100 --> 00:01.500\n<v Ann>Hello, my friend.\n\n"
        "00:02.000 --> 00:03.500\n<v Bob>Hello, my friend.\n");
  const Json report =
      json_of({"speak", "--script", dir / "talk.vtt", "--fit", "0.8-1.3", "--cast",
               "Ann,audio=" + (dir / "a.wav"), "--cast", "Bob,lang=en+m3", "-o", dir / "t.mp4"});
  ASSERT_EQ(report["people"].size(), 2u);
  EXPECT_FALSE(report["people"][0]["confidence"].is_null()) << "a recording is aligned";
  EXPECT_TRUE(report["people"][1]["confidence"].is_null());
  EXPECT_NEAR(double(report["people"][1]["cues"][0]["said"]), 2.0, 0.01);
}

TEST(People, SayWhatIsWrong) {
  const TempDir dir;
  spill(dir / "talk.vtt", kDialogue);
  spill(dir / "nobody.vtt", "WEBVTT\n\n00:00.000 --> 00:01.000\nHello\n");
  const auto refuses = [&](std::vector<std::string> more, const std::string& what) {
    std::vector<std::string> line = {"speak", "--script", dir / "talk.vtt"};
    line.insert(line.end(), more.begin(), more.end());
    const auto out = animeme(line);
    EXPECT_NE(out.exit_code, 0);
    EXPECT_THAT(out.err, HasSubstr(what));
  };
  const std::string mp4 = dir / "t.mp4";
  refuses({"--cast", "Carl", "-o", mp4}, "nobody called 'Carl' speaks; there are Ann, Bob");
  refuses({"--cast", "all", "-o", dir / "t.fba"}, "takes one face");
  refuses({"--cast", "all", "--speaker", "Ann", "-o", mp4}, "--cast several");
  refuses({"--cast", "Ann,hat=red", "-o", mp4}, "there is no hat");
  refuses({"--cast", "Ann,pitch=999", "-o", mp4}, "from 0 to 100");
  refuses({"--turns", dir / "t.rttm", "-o", mp4}, "--cast");
  const auto out = animeme({"speak", "--script", dir / "nobody.vtt", "--cast", "all", "-o", mp4});
  EXPECT_THAT(out.err, HasSubstr("does not say who speaks"));
}

// Two heads in one picture, each with its own motion.
TEST(People, AreShownSideBySide) {
  const TempDir dir;
  spill(dir / "talk.vtt", kDialogue);
  const std::string film = dir / "talk.mp4";
  succeeds(
      {"speak", "--script", dir / "talk.vtt", "--fit", "0.8-1.3", "--cast", "all", "-o", film});
  const auto still = [&](const std::string& people, const std::string& time) {
    succeeds({"render", film, "--people", people, "--time", time, "--size", "192x108", "-o",
              dir / "two.png"});
    return slurp(dir / "two.png");
  };
  const std::string both = still("all", "1.2");
  EXPECT_EQ(both, still("Ann,Bob", "1.2"));
  EXPECT_EQ(both, still("Ann=woman,Bob=man", "1.2")) << "the usual heads in turn";
  EXPECT_NE(both, still("Bob,Ann", "1.2"));
  EXPECT_NE(both, still("Ann=man,Bob=man", "1.2"));
  EXPECT_NE(both, still("all", "3"));
  succeeds({"view", film, "--people", "all", "-o", dir / "two.html"});
  EXPECT_THAT(slurp(dir / "two.html"), HasSubstr("\"people\":[{\"name\":\"Ann\""));
  auto out = animeme({"render", film, "--people", "Carl", "--time", "1", "-o", dir / "two.png"});
  EXPECT_EQ(out.exit_code, 3);
  EXPECT_THAT(out.err, HasSubstr("there are Ann, Bob"));
  out = animeme(
      {"render", film, "--people", "all", "--size", "96x54", "--captions", "-o", dir / "two.webm"});
  if (out.err.find("built without") != std::string::npos) GTEST_SKIP() << out.err;
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("96x54"));
}

// What is muxed with a sound for each is heard together.
TEST(People, OwnSoundsAreMixed) {
  const TempDir dir;
  for (const char* name : {"Ann", "Bob"}) {
    succeeds({"speak", "Hello, my friend.", "--lang", *name == 'A' ? "en+f3" : "en+m3", "-o",
              dir / (std::string(name) + ".mp4")});
  }
  const auto track = [&](const std::string& name) {
    const std::string file = dir / (name + ".mp4");
    return "speaker=" + name + ",face=" + file + ",audio=" + file;
  };
  succeeds({"mux", "--track", track("Ann"), "--track", track("Bob"), "-o", dir / "both.mp4"});
  succeeds({"view", dir / "both.mp4", "--people", "all", "-o", dir / "both.html"});
  succeeds({"view", dir / "both.mp4", "--track", "speaker=Ann", "-o", dir / "ann.html"});
  EXPECT_THAT(slurp(dir / "both.html"), HasSubstr("\"sound\":\"audio/mp4\""));
}

}  // namespace people_test
}  // namespace animeme
