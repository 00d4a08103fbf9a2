// `speak --over`: new speech over a kept performance, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dam/script/phones.h"
#include "dam/script/script.h"
#include "dam/signal/closure.h"
#include "fap/edit.h"
#include "fap/tables.h"
#include "tests/app/program/commands.h"
#include "tests/support/shared.h"

namespace animeme {
namespace over_test {

using test::animeme;
using test::json_of;
using test::read_clip;
using test::succeeds;
using test::TempDir;
using testing::HasSubstr;

const char* const kEnglish =
    "Maybe Peter will bring a big map. My mother hopes that both of you are happy.";
const char* const kGerman =
    "Vielleicht bringt Peter morgen eine große Karte mit. Meine Mutter hofft, dass ihr beide "
    "zufrieden seid.";

// A file with a script, as the program reads it.
dam::Script script_in(const std::string& path) {
  auto script = dam::read_script(test::slurp(path));
  EXPECT_TRUE(script) << script.error().describe();
  return script ? *script : dam::Script();
}

// P, B and M that do not close the lips.
std::size_t open_closures(const fap::Sequence& clip, const dam::Script& script) {
  std::size_t open = 0, all = 0;
  for (const dam::Phone& phone : script.phones) {
    if (!dam::is_bilabial(phone.label)) continue;
    ++all;
    double least = 1e9;
    for (const fap::Frame& frame : clip.frames) {
      const double time = clip.rate.seconds(double(frame.number));
      if (time < phone.start - dam::kClosureSearch || time > phone.end + dam::kClosureSearch)
        continue;
      least = std::min(least, -double(frame.value[4] + frame.value[5]));
    }
    if (least >= dam::kClosedGap) ++open;
  }
  EXPECT_GT(all, 3u);
  return open;
}

fap::Mask upper_face() {
  fap::Mask mask;
  for (const char* region : {"brows", "lids", "gaze", "nose", "head"})
    mask |= *fap::region_faps(region);
  return mask;
}

double source_of(const test::Json& moments, double time) {
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const double b = moments[i]["time"];
    if (b < time && i + 1 < moments.size()) continue;
    const double a = moments[i - 1]["time"], from = moments[i - 1]["source"];
    const double to = moments[i]["source"];
    return from + (to - from) * (time - a) / (b - a);
  }
  return time;
}

struct Likeness {
  double rms = 0;  // in steps of the quantiser
  double worst_correlation = 1;
  std::size_t same = 0;
};

// Of the FAPs of the upper face that the program says it has kept (coding may have left a breath of
// the nostrils out), where both times agree, and bent by what it says.
Likeness likeness(const fap::Sequence& clip, const fap::Sequence& original,
                  const test::Json& over) {
  Likeness like;
  const test::Json& moments = over["moments"];
  fap::Mask kept;
  for (const int fap : over["kept"]) kept.set(std::size_t(fap));
  EXPECT_GT((kept & upper_face()).count(), 12u);
  double sum = 0, count = 0;
  for (std::size_t fap = 3; fap <= 68; ++fap) {
    if (!(kept & upper_face())[fap] || !original.frames.front().mask[fap]) continue;
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    std::size_t same = 0;
    for (const fap::Frame& frame : clip.frames) {
      const double time = clip.rate.seconds(double(frame.number));
      const double at = source_of(moments, time) * original.rate.frames_per_second();
      const auto first = std::size_t(std::max(0.0, at + 1e-4));
      if (first + 1 >= original.frames.size()) break;
      const double share = std::max(0.0, at - double(first));
      const double x = frame.value[fap];
      const double y = (1 - share) * original.frames[first].value[fap] +
                       share * original.frames[first + 1].value[fap];
      n += 1, a += x, b += y, aa += x * x, bb += y * y, ab += x * y;
      if (share > 1e-3) continue;
      ++same, ++count;
      const double steps = (x - y) / fap::info(int(fap)).quant_step;
      sum += steps * steps;
    }
    like.same = std::max(like.same, same);
    const double spread = std::sqrt(std::max(0.0, (aa - a * a / n) * (bb - b * b / n)));
    if (spread > 9 * n) {
      like.worst_correlation = std::min(like.worst_correlation, (ab - a * b / n) / spread);
    }
  }
  like.rms = std::sqrt(sum / std::max(1.0, count));
  return like;
}

TEST(Over, APerformanceInAnotherLanguage) {
  const TempDir dir;
  succeeds({"speak", "--text", kEnglish, "--mood", "joy", "-o", dir / "en.mp4", "-o",
            dir / "en.fap", "--no-tongue"});
  const test::Json said =
      json_of({"speak", "--text", kGerman, "--lang", "de", "--over", dir / "en.mp4",
               "--save-script", dir / "de.TextGrid", "-o", dir / "de.fap", "-o", dir / "de.mp4"});
  ASSERT_TRUE(said.contains("over"));
  const fap::Sequence original = read_clip(dir / "en.fap"), clip = read_clip(dir / "de.fap");
  const Likeness like = likeness(clip, original, said["over"]);
  // One quantiser step: the performance was read from a coded stream.
  EXPECT_LT(like.rms, 1);
  EXPECT_GT(like.worst_correlation, 0.95);
  EXPECT_GT(like.same, 10u);
  EXPECT_EQ(open_closures(clip, script_in(dir / "de.TextGrid")), 0u);
  // The lips are not those of English.
  double away = 0;
  for (std::size_t i = 0; i < std::min(clip.frames.size(), original.frames.size()); ++i)
    away += std::abs(clip.frames[i].value[5] - original.frames[i].value[5]);
  EXPECT_GT(away / double(clip.frames.size()), 20);
}

TEST(Over, RecordedTakes) {
  if (test::shared_dir().empty()) GTEST_SKIP() << "the reference data are not here";
  const auto folder = test::shared_dir() / "data" / "livelink_rom" / "controls";
  const TempDir dir;
  std::size_t takes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    succeeds({"import", entry.path().string(), "-o", dir / "take.fap"});
    const fap::Sequence original = read_clip(dir / "take.fap");
    const test::Json said =
        json_of({"speak", "--text", kEnglish, "--rate", "30", "--over", entry.path().string(),
                 "--save-script", dir / "en.TextGrid", "-o", dir / "en.fap"});
    const fap::Sequence clip = read_clip(dir / "en.fap");
    const Likeness like = likeness(clip, original, said["over"]);
    EXPECT_LT(like.rms, 1) << entry.path();
    EXPECT_GT(like.worst_correlation, 0.95) << entry.path();
    EXPECT_GT(like.same, 10u);
    EXPECT_EQ(open_closures(clip, script_in(dir / "en.TextGrid")), 0u) << entry.path();
    ++takes;
  }
  EXPECT_EQ(takes, 2u);
}

TEST(Over, PartsAndOptions) {
  const TempDir dir;
  succeeds({"speak", "--text", kEnglish, "-o", dir / "en.fba"});
  // Nothing kept is nothing changed.
  succeeds({"speak", "--text", kGerman, "--lang", "de", "--over", dir / "en.fba", "--keep", "all=0",
            "-o", dir / "none.fap"});
  succeeds({"speak", "--text", kGerman, "--lang", "de", "-o", dir / "plain.fap"});
  EXPECT_EQ(read_clip(dir / "none.fap").frames, read_clip(dir / "plain.fap").frames);
  succeeds({"speak", "--text", kGerman, "--lang", "de", "--over", dir / "en.fba", "--keep",
            "brows=0,lips=0.5", "--bend", "0", "-o", dir / "some.fap"});
  const fap::Sequence some = read_clip(dir / "some.fap"), plain = read_clip(dir / "plain.fap");
  succeeds({"decode", dir / "en.fba", "-o", dir / "en.fap"});
  const fap::Sequence original = read_clip(dir / "en.fap");
  const std::size_t frames = std::min(original.frames.size(), some.frames.size());
  for (std::size_t i = 0; i < frames; ++i) {
    EXPECT_EQ(some.frames[i].value[31], plain.frames[i].value[31]);
    EXPECT_EQ(some.frames[i].value[49], original.frames[i].value[49]);
  }
}

TEST(Over, Mistakes) {
  const TempDir dir;
  succeeds({"speak", "--text", "Hello", "-o", dir / "a.fba"});
  const auto said = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = {"speak", "--text", "Hello", "-o", dir / "b.fba"};
    all.insert(all.end(), more.begin(), more.end());
    return animeme(all);
  };
  EXPECT_THAT(said({"--keep", "lips=0.5"}).err, HasSubstr("--over"));
  EXPECT_THAT(said({"--over", dir / "a.fba", "--keep", "lips=2"}).err, HasSubstr("0 to 1"));
  EXPECT_THAT(said({"--over", dir / "a.fba", "--keep", "mouth=1"}).err, HasSubstr("lips, jaw"));
  EXPECT_THAT(said({"--over", dir / "a.fba", "--keep", "tongue=1"}).err, HasSubstr("new speech"));
  EXPECT_EQ(said({"--over", dir / "nowhere.fba"}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(dir / "b.fba"));
  EXPECT_THAT(
      animeme({"stream", dir / "a.fba", "--over", dir / "a.fba", "--to", "udp://127.0.0.1:9"}).err,
      HasSubstr("--over is for speech"));
}

}  // namespace over_test
}  // namespace animeme
