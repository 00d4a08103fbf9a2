// edit through the program: frames, sound and words of cuts and joins are those of the inputs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fap/edit.h"
#include "fap/fill.h"
#include "fap/receiver.h"
#include "fap/text.h"
#include "tests/support/program.h"
#include "tests/support/random_clip.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/container.h"
#include "tools/formats/media/text_track.h"

namespace animeme {
namespace edit_test {

using test::animeme;
using test::TempDir;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Values of all FAPs, frame by frame.
using Rows = std::vector<std::array<std::int32_t, fap::kFapCount + 1>>;

Rows rows(const std::string& path, const std::vector<std::string>& options = {}) {
  std::vector<std::string> line = {"decode", "-q", "--fill", path, "-o", "-"};
  line.insert(line.end(), options.begin(), options.end());
  const auto decoded = animeme(line);
  EXPECT_EQ(decoded.exit_code, 0) << decoded.err;
  const auto clip = fap::read_text(decoded.out);
  EXPECT_TRUE(clip) << path;
  Rows all;
  if (!clip) return all;
  for (const fap::Frame& frame : clip->frames) all.push_back(frame.value);
  return all;
}

Rows part(const Rows& all, std::size_t first, std::size_t end) {
  return {all.begin() + std::ptrdiff_t(first),
          all.begin() + std::ptrdiff_t(std::min(end, all.size()))};
}

Rows operator+(Rows a, const Rows& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void expect_run(const std::vector<std::string>& line) {
  const auto ran = animeme(line);
  EXPECT_EQ(ran.exit_code, 0) << testing::PrintToString(line) << ran.err;
}

// Two clips that speak, once for all tests.
struct Talks {
  TempDir dir;
  std::string a = dir / "a.mp4", b = dir / "b.mp4";
  Rows rows_a, rows_b;

  Talks() {
    expect_run({"speak", "-q", "--text", "Bob came back by bus, and we waved.", "-o", a});
    expect_run({"speak", "-q", "--text", "My mother put them away.", "-o", b});
    rows_a = rows(a);
    rows_b = rows(b);
  }
};
const Talks& talks() {
  static const Talks made;
  return made;
}

// By how many samples `part` lies beside place `at` of `whole`.
int shift(const media::Pcm& whole, double at, const media::Pcm& part) {
  const auto from = std::llround(at * whole.sample_rate);
  double least = INFINITY;
  int best = 0;
  for (int lag = -60; lag <= 60; ++lag) {
    double sum = 0;
    const auto end = std::min<std::int64_t>(std::int64_t(part.samples.size()) - 500, 12000);
    for (std::int64_t i = 500; i < end; ++i) {
      const std::int64_t k = from + i + lag;
      if (k < 0 || k >= std::int64_t(whole.samples.size())) continue;
      const double d = part.samples[std::size_t(i)] - whole.samples[std::size_t(k)];
      sum += d * d;
    }
    if (sum < least) {
      least = sum;
      best = lag;
    }
  }
  return best;
}

TEST(EditCommand, CutsFacesWithSoundAndWords) {
  const TempDir dir;
  for (const char* name : {"part.mp4", "part.mkv", "part.ts"}) {
    SCOPED_TRACE(name);
    expect_run({"edit", talks().a, "--from", "0.4", "--to", "1.4", "-o", dir / name});
    EXPECT_EQ(rows(dir / name), part(talks().rows_a, 10, 35));
    const auto whole = media::read_audio(talks().a), sound = media::read_audio(dir / name);
    ASSERT_TRUE(whole && sound);
    // Only mp4 says where the sound ends within a packet.
    EXPECT_NEAR(sound->duration(), 1.0, std::string(name) == "part.mp4" ? 1e-3 : 0.08);
    EXPECT_LE(std::abs(shift(*whole, 0.4, *sound)), std::string(name) == "part.mp4" ? 0 : 23);
  }
  const auto before = media::read_text_tracks(talks().a);
  const auto after = media::read_text_tracks(dir / "part.mp4");
  ASSERT_TRUE(before && after);
  ASSERT_EQ(before->size(), after->size());
  for (std::size_t i = 0; i < after->size(); ++i) {
    std::size_t same = 0;
    for (const media::TextCue& cue : (*after)[i].cues) {
      for (const media::TextCue& old : (*before)[i].cues) {
        if (old.text == cue.text && std::abs(old.end - 0.4 - cue.end) < 2e-3) ++same;
      }
      EXPECT_LE(cue.end, 1.0 + 1e-3);
    }
    EXPECT_GE(same + 1, (*after)[i].cues.size());  // the last one may be shortened
    EXPECT_GT(same, 2u);
  }
}

TEST(EditCommand, JoinsPiecesAndFiles) {
  const TempDir dir;
  const Rows &a = talks().rows_a, &b = talks().rows_b;
  expect_run({"edit", talks().a, talks().b, "-o", dir / "ab.mp4"});
  EXPECT_EQ(rows(dir / "ab.mp4"), a + b);
  const auto joined = media::read_audio(dir / "ab.mp4"), second = media::read_audio(talks().b);
  ASSERT_TRUE(joined && second);
  EXPECT_EQ(shift(*joined, double(a.size()) / 25, *second), 0);
  expect_run({"edit", talks().a, "--at", "0-0.4,10f-12f", "--at", "1-", "-o", dir / "at.fba"});
  EXPECT_EQ(rows(dir / "at.fba"), part(a, 0, 10) + part(a, 10, 12) + part(a, 25, a.size()));
  // Over the border of two files.
  const double border = double(a.size()) / 25;
  expect_run({"edit", talks().a, talks().b, "--from", std::to_string(border - 0.2), "--to",
              std::to_string(border + 0.2), "-o", dir / "over.mp4"});
  EXPECT_EQ(rows(dir / "over.mp4"), part(a, a.size() - 5, a.size()) + part(b, 0, 5));
}

TEST(EditCommand, StreamsOneBehindTheOtherAreReadAsOne) {
  const TempDir dir;
  expect_run({"demux", talks().a, "-o", dir / "a.fba"});
  expect_run({"demux", talks().b, "-o", dir / "b.fba"});
  test::spill(dir / "cat.fba", test::slurp(dir / "a.fba") + test::slurp(dir / "b.fba"));
  EXPECT_EQ(rows(dir / "cat.fba"), talks().rows_a + talks().rows_b);
  for (const std::vector<std::string>& line : {std::vector<std::string>{"info", dir / "cat.fba"},
                                               {"stats", dir / "cat.fba"},
                                               {"decode", dir / "cat.fba", "-o", dir / "cat.fap"},
                                               {"mux", dir / "cat.fba", "-o", dir / "cat.mp4"}}) {
    const auto ran = animeme(line);
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("2 streams, one behind the other, are read as one"));
  }
  EXPECT_EQ(rows(dir / "cat.mp4"), talks().rows_a + talks().rows_b);
  // A damaged second one: what is intact of both.
  std::string bytes = test::slurp(dir / "cat.fba");
  bytes[bytes.size() - 300] ^= 0x40;
  test::spill(dir / "cut.fba", bytes);
  const auto damaged = animeme({"decode", dir / "cut.fba", "-o", dir / "cut.fap"});
  EXPECT_EQ(damaged.exit_code, 1) << damaged.err;
  EXPECT_GT(rows(dir / "cut.fap").size(), talks().rows_a.size() + 10);
}

TEST(EditCommand, CopyMovesCutsToIntraPlanes) {
  const TempDir dir;
  expect_run({"decode", talks().a, "-o", dir / "a.fap"});
  expect_run(
      {"encode", dir / "a.fap", "--preset", "live", "--intra-seconds", "0.4", "-o", dir / "a.fba"});
  const auto ran =
      animeme({"edit", dir / "a.fba", "--copy", "--from", "0.9", "--to", "2", "-o", dir / "c.fba"});
  EXPECT_EQ(ran.exit_code, 0);
  EXPECT_THAT(ran.err, AllOf(HasSubstr("0.920 s moves to the intra plane at 0.800 s"),
                             HasSubstr("30 planes, all copied")));
  EXPECT_EQ(rows(dir / "c.fba"), part(talks().rows_a, 20, 50));
  const auto report =
      animeme({"edit", dir / "a.fba", "--from", "0.9", "--json", "-o", dir / "e.fba"});
  EXPECT_THAT(report.out, AllOf(HasSubstr("\"recoded\": 7"), HasSubstr("\"changed\": 0")));
  const auto text =
      animeme({"edit", dir / "a.fap", "--copy", "--from", "0.9", "-o", dir / "d.fba"});
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_THAT(text.err, HasSubstr("leave --copy out"));
}

TEST(EditCommand, MovesTheFaceAgainstTheSound) {
  const TempDir dir;
  const Rows& a = talks().rows_a;
  expect_run({"edit", talks().a, "--offset", "0.12", "-o", dir / "later.mp4"});
  EXPECT_EQ(rows(dir / "later.mp4"), part(a, 0, 1) + part(a, 0, 1) + part(a, 0, 1) + a);
  expect_run({"edit", talks().a, "--offset", "-0.2", "-o", dir / "earlier.mp4"});
  const Rows earlier = rows(dir / "earlier.mp4");
  EXPECT_EQ(part(earlier, 0, a.size() - 5), part(a, 5, a.size()));
  const auto whole = media::read_audio(talks().a), sound = media::read_audio(dir / "earlier.mp4");
  ASSERT_TRUE(whole && sound);
  EXPECT_EQ(whole->samples, sound->samples);
}

TEST(EditCommand, ChangesParts) {
  const TempDir dir;
  const Rows &a = talks().rows_a, &b = talks().rows_b;
  expect_run({"edit", talks().a, "--scale", "jaw=2,head=0", "-o", dir / "scaled.fap"});
  const Rows scaled = rows(dir / "scaled.fap");
  ASSERT_EQ(scaled.size(), a.size());
  bool jaw = false, head = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(scaled[i][3], 2 * a[i][3]);
    EXPECT_EQ(scaled[i][48], 0);
    EXPECT_EQ(scaled[i][8], a[i][8]);
    jaw = jaw || a[i][3] != 0;
    head = head || a[i][48] != 0;
  }
  EXPECT_TRUE(jaw && head);
  expect_run({"edit", "--take", "lips=" + talks().b + ",rest=" + talks().a, "-o", dir / "t.fap"});
  const Rows taken = rows(dir / "t.fap");
  ASSERT_EQ(taken.size(), a.size());
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    EXPECT_EQ(taken[i][8], b[i][8]);
    EXPECT_EQ(taken[i][3], a[i][3]);
  }
  expect_run({"edit", dir / "t.fap", "--mirror", "-o", dir / "m.fap"});
  expect_run({"edit", dir / "m.fap", "--mirror", "-o", dir / "mm.fap"});
  EXPECT_EQ(rows(dir / "mm.fap"), taken);
}

// Several times as long as what is in memory at once, changed there as a whole for comparison.
TEST(EditCommand, ChangesLongClipsAsTheWhole) {
  const TempDir dir;
  fap::Sequence clip = *fap::fill(test::random_clip(21, 7000)), other = clip;
  other.frames.resize(5000);
  std::reverse(other.frames.begin(), other.frames.end());
  for (fap::Sequence* each : {&clip, &other}) {
    for (std::size_t i = 0; i < each->frames.size(); ++i) {
      fap::Frame& frame = each->frames[i];
      frame.number = std::int64_t(i);
      frame.mask.reset(1).reset(2);
      frame = fap::with_mask(frame, frame.mask);
    }
  }
  test::spill(dir / "clip.fap", fap::write_text(clip));
  test::spill(dir / "other.fap", fap::write_text(other));
  expect_run({"edit", dir / "clip.fap", dir / "other.fap", "--cross-fade", "2", "--mirror",
              "--take", "head=" + (dir / "other.fap") + ",lids=" + (dir / "other.fap"), "--scale",
              "brows=0.5", "--smooth", "all=0.4,jaw=0.2", "--fade", "20", "-o", dir / "is.fap"});
  fap::append(clip, other, 2);
  fap::mirror(clip);
  for (const char* part : {"head", "lids"}) {
    fap::replace(clip, other, *fap::region_faps(part), 2);
  }
  fap::scale(clip, *fap::region_faps("brows"), 0.5);
  fap::smooth(clip, fap::Mask().set().reset(0), 0.4);
  fap::smooth(clip, *fap::region_faps("jaw"), 0.2);
  fap::fade(clip, 20, 20);
  const auto is = fap::read_text(test::slurp(dir / "is.fap"));
  ASSERT_TRUE(is);
  ASSERT_EQ(is->frames.size(), clip.frames.size());
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    ASSERT_EQ(is->frames[i].value, clip.frames[i].value) << i;
  }
}

TEST(EditCommand, ConvertsRatesOfFacesAndBodies) {
  const TempDir dir;
  expect_run({"edit", talks().a, "--rate", "50", "-o", dir / "fast.fba"});
  EXPECT_EQ(rows(dir / "fast.fba").size(), 2 * talks().rows_a.size());
  std::string flags, values;
  for (int bap = 1; bap <= 186; ++bap) flags += bap == 3 ? "1 " : "0 ";
  std::string text = "3.1 body 25 5\n";
  for (int frame = 0; frame < 5; ++frame) {
    text += flags + "\n" + std::to_string(frame) + " " + std::to_string(100 * frame) + "\n";
  }
  test::spill(dir / "body.bap", text);
  expect_run({"edit", dir / "body.bap", "--rate", "50", "-o", dir / "body50.bap"});
  const std::string converted = test::slurp(dir / "body50.bap");
  EXPECT_THAT(converted,
              AllOf(HasSubstr(" 50 10\n"), HasSubstr("\n3 150\n"), HasSubstr("\n9 400\n")));
  expect_run({"edit", talks().a, "--take", "body=" + (dir / "body.bap"), "-o", dir / "both.fba"});
  const auto info = animeme({"info", dir / "both.fba"});
  EXPECT_THAT(info.out, HasSubstr("body_planes: " + std::to_string(talks().rows_a.size())));
}

// Loudness of each 50 ms, relative to the loudest.
std::vector<double> loudness(const media::Pcm& sound, double from, double step) {
  std::vector<double> all;
  double most = 1e-9;
  for (double at = from; (at + 0.05) < sound.duration(); at += step) {
    double sum = 0;
    const auto begin = std::size_t(at * sound.sample_rate);
    const auto end = std::size_t((at + 0.05) * sound.sample_rate);
    for (std::size_t i = begin; i < end; ++i) sum += double(sound.samples[i]) * sound.samples[i];
    all.push_back(std::sqrt(sum / double(end - begin)));
    most = std::max(most, all.back());
  }
  for (double& each : all) each /= most;
  return all;
}

TEST(EditCommand, SpeedStretchesFaceSoundAndWordsAlike) {
  const TempDir dir;
  const auto whole = media::read_audio(talks().a);
  const auto before = media::read_text_tracks(talks().a);
  ASSERT_TRUE(whole && before && !before->empty());
  for (const double speed : {0.8, 2.0}) {
    SCOPED_TRACE(speed);
    const std::string out = dir / "s.mp4";
    expect_run({"edit", talks().a, "--speed", std::to_string(speed), "-o", out});
    EXPECT_NEAR(double(rows(out).size()), double(talks().rows_a.size()) / speed, 1);
    const auto sound = media::read_audio(out);
    const auto after = media::read_text_tracks(out);
    ASSERT_TRUE(sound && after && !after->empty());
    EXPECT_NEAR(sound->duration(), whole->duration() / speed, 1e-3);
    EXPECT_NEAR(after->front().cues.back().end, before->front().cues.back().end / speed, 2e-3);
    const auto old = loudness(*whole, 0, 0.05), now = loudness(*sound, 0, 0.05 / speed);
    double difference = 0;
    const std::size_t count = std::min(old.size(), now.size());
    for (std::size_t i = 0; i < count; ++i) difference += std::abs(old[i] - now[i]);
    EXPECT_LT(difference / double(count), 0.15);
  }
  expect_run({"edit", talks().a, "--speed", "2", "--no-sound", "-o", dir / "n.mp4"});
  EXPECT_FALSE(media::read_audio(dir / "n.mp4"));
}

TEST(EditCommand, ContainersMoveAFaceByLessThanAFrame) {
  const TempDir dir;
  const Rows& a = talks().rows_a;
  const auto begin = [&](const std::string& path) {
    const auto container = media::read_container(path);
    EXPECT_TRUE(container) << path;
    if (!container) return 0.0;
    return double(container->face.units.front().time) / container->face.timescale;
  };
  for (const char* name : {"later.mp4", "later.mkv", "later.ts"}) {
    SCOPED_TRACE(name);
    // In mkv and ts the sound begins with what its encoder puts before it.
    const std::string plain = dir / (std::string("plain_") + name);
    expect_run({"edit", talks().a, "-o", plain});
    expect_run({"edit", talks().a, "--offset", "0.013", "-o", dir / name});
    EXPECT_NEAR(begin(dir / name) - begin(plain), 0.013, 1.1e-3);
    EXPECT_EQ(rows(dir / name), a);
  }
  expect_run({"edit", talks().a, "--offset", "-0.013", "-o", dir / "earlier.mp4"});
  EXPECT_NEAR(begin(dir / "earlier.mp4"), 0.027, 6e-4);
  const Rows earlier = rows(dir / "earlier.mp4");
  EXPECT_EQ(part(earlier, 0, a.size() - 1), part(a, 1, a.size()));
  // What has no times moves by whole frames, and says so.
  const auto raw = animeme({"edit", talks().a, "--offset", "0.03", "-o", dir / "raw.fba"});
  EXPECT_EQ(raw.exit_code, 0);
  EXPECT_THAT(raw.err, HasSubstr("--offset: 1 frames, 0.040 s"));
}

TEST(EditCommand, DecodeReadsAPiece) {
  const Rows& a = talks().rows_a;
  EXPECT_EQ(rows(talks().a, {"--from", "0.4", "--to", "0.8"}), part(a, 10, 20));
  EXPECT_EQ(rows(talks().a, {"--from", "30f"}), part(a, 30, a.size()));
}

TEST(EditCommand, SaysWhatIsWrong) {
  const TempDir dir;
  struct Wrong {
    std::vector<std::string> options;
    int exit_code;
    const char* message;
  };
  for (const Wrong& wrong :
       {Wrong{{"--from", "soon"}, 2, "'soon' is not a time"},
        Wrong{{"--from", "3", "--to", "2"}, 2, "ends before it begins"},
        Wrong{{"--from", "100"}, 2, "nothing is left"},
        Wrong{{"--at", "1:75-2:00"}, 2, "is not a time"}, Wrong{{"--at", "7"}, 2, "is not a piece"},
        Wrong{{"--scale", "beard=2"}, 2, "'beard' is no part of the face; there are lips, jaw"},
        Wrong{{"--scale", "lips"}, 2, "'lips' needs a number"},
        Wrong{{"--smooth", "lips=-1"}, 2, "needs a number of 0 or more"},
        Wrong{{"--take", "lips"}, 2, "is not PART=FILE"},
        Wrong{{"--take", "lips=missing.fba"}, 3, "missing.fba"},
        Wrong{{"--take", "rest=b.fba"}, 2, "--take rest= names the input, which is given already"},
        Wrong{{"--copy", "--mirror"}, 2, "--copy leaves all values as they are"}}) {
    std::vector<std::string> line = {"edit", talks().a, "-o", dir / "out.fba"};
    line.insert(line.end(), wrong.options.begin(), wrong.options.end());
    const auto ran = animeme(line);
    EXPECT_EQ(ran.exit_code, wrong.exit_code) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr(wrong.message));
    EXPECT_EQ(test::slurp(dir / "out.fba"), "");
  }
}

}  // namespace edit_test
}  // namespace animeme
