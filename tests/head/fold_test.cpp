// The skin does not turn over, whatever real captures do to it.
#include <algorithm>
#include <random>
#include <sstream>

#include "fap/arkit.h"
#include "fap/fill.h"
#include "fap/head/shapes.h"
#include "fap/text.h"
#include "tests/head/outside.h"
#include "tests/support/files.h"
#include "tests/support/shared.h"

namespace animeme::test {
namespace fold_test {

using head::Triangle;
using head::Vec3;

class EachFace : public ::testing::TestWithParam<std::string> {
 protected:
  const head::Rig& rig() const { return rig_of(GetParam()); }

  // How many triangles of the outside have turned by more than 90 degrees against the neutral face.
  // The turn of the head as a whole is left out.
  int turned_over(fap::Frame frame) { return turned_over(rig(), frame); }

  int turned_over(const head::Rig& rig, fap::Frame frame) {
    for (const std::size_t f : {48u, 49u, 50u}) frame.mask.reset(f);
    head::pose(rig, frame, pose_);
    const auto& was = rig.parts[0].positions;
    const auto& is = pose_.positions[0];
    const auto normal = [](const std::vector<Vec3>& p, const Triangle& t) {
      return cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
    };
    int count = 0;
    for (const Triangle& t : outside_) count += dot(normal(was, t), normal(is, t)) < 0 ? 1 : 0;
    return count;
  }

  // Of every third frame: a face moves little between two of them. What people do is whole of
  // itself, so that all of it is shown.
  void expect_whole(const fap::Sequence& clip, const std::string& name) {
    for (std::size_t i = 0; i < clip.frames.size(); i += 3) {
      ASSERT_EQ(turned_over(unwatched_, clip.frames[i]), 0)
          << name << " frame " << clip.frames[i].number;
      ++shown_;
    }
  }

  void expect_whole(const std::filesystem::path& path) {
    const auto text =
        fap::read_text(test::slurp(path), {.headerless = path.stem() == "headerless"});
    ASSERT_TRUE(text) << path;
    const auto filled = fap::fill(*text);
    ASSERT_TRUE(filled) << path;
    expect_whole(*filled, path.filename().string());
  }

  const std::vector<Triangle> outside_ = outside_of(head_of(GetParam()));
  const head::Rig unwatched_ = [this] {
    head::Rig rig = this->rig();
    rig.outside.clear();
    return rig;
  }();
  head::Pose pose_;
  int shown_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Heads, EachFace, ::testing::Values("woman", "man", "child"));

// A table with columns "fap3_open_jaw", "fap4_..." and others.
fap::Sequence read_table(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  std::vector<int> faps;
  std::stringstream names(line);
  for (std::string name; std::getline(names, name, ',');) {
    faps.push_back(name.starts_with("fap") ? std::atoi(name.c_str() + 3) : 0);
  }
  fap::Sequence clip;
  while (std::getline(in, line)) {
    fap::Frame frame;
    frame.number = std::int64_t(clip.frames.size());
    std::stringstream values(line);
    std::string value;
    for (const int fap : faps) {
      if (std::getline(values, value, ',') && fap > 0) frame.set(fap, std::atoi(value.c_str()));
    }
    clip.frames.push_back(frame);
  }
  return clip;
}

// As far as intra planes code them by default.
int extreme(int fap) { return fap::info(fap).quant_step * fap::info(fap).default_i_range; }

TEST_P(EachFace, OutsideIsMostOfTheSkin) {
  const std::size_t all = head_of(GetParam()).part(head::Part::skin).triangles.size();
  EXPECT_GT(outside_.size(), all * 7 / 10);
  EXPECT_LT(outside_.size(), all);  // neither the mouth nor the ears, which no FAP bends
}

// Every FAP alone, with that of the other side, of the other rim of the lip, and all of them.
TEST_P(EachFace, StaysWholeAtLegalExtremes) {
  for (const fap::FapInfo& info : fap::kFaps) {
    if (info.number < fap::kFirstLowLevel) continue;
    const int mirror = info.mirror ? info.mirror : info.number;
    const int partner = info.partner ? info.partner : info.number;
    const int both = info.partner ? fap::info(partner).mirror : mirror;
    const std::vector<int> sets[] = {{info.number},
                                     {info.number, mirror},
                                     {info.number, partner},
                                     {info.number, mirror, partner, both ? both : partner}};
    const int most = extreme(info.number);
    for (const std::vector<int>& set : sets) {
      for (const int value : {-most, -most / 3, -most / 10, most / 10, most / 3, most}) {
        fap::Frame frame;
        for (const int fap : set) frame.set(fap, value);
        EXPECT_EQ(turned_over(frame), 0)
            << info.name << " " << value << " and " << set.size() - 1 << " more";
        ++shown_;
      }
    }
  }
  EXPECT_GT(shown_, 1000);
}

TEST_P(EachFace, WatchesItsOutside) {
  std::vector<Triangle> watched;
  for (const head::OuterTriangle& outer : rig().outside) watched.push_back(outer.corners);
  std::vector<Triangle> outside = outside_;
  std::sort(watched.begin(), watched.end());
  std::sort(outside.begin(), outside.end());
  EXPECT_EQ(watched, outside);
}

// Every eleventh pair of FAPs.
TEST_P(EachFace, StaysWholeAtExtremesOfPairs) {
  int pair = 0;
  for (int a = fap::kFirstLowLevel; a <= fap::kFapCount; ++a) {
    for (int b = a + 1; b <= fap::kFapCount; ++b) {
      if (++pair % 11 != 0) continue;
      for (const auto& [of_a, of_b] : {std::pair(1, 1), {1, -1}, {-1, 1}, {-1, -1}}) {
        fap::Frame frame;
        frame.set(a, of_a * extreme(a));
        frame.set(b, of_b * extreme(b));
        EXPECT_EQ(turned_over(frame), 0)
            << fap::info(a).name << " " << frame.value[std::size_t(a)] << ", " << fap::info(b).name
            << " " << frame.value[std::size_t(b)];
        ++shown_;
      }
    }
  }
  EXPECT_GT(shown_, 700);
}

// All FAPs at once, each anywhere in its range: a share of it, by a direction.
fap::Frame anywhere(unsigned seed, double share) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  fap::Frame frame;
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    frame.set(f, int(part(random) * share * extreme(f)));
  }
  return frame;
}

TEST_P(EachFace, StaysWholeWhateverItIsTold) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    EXPECT_EQ(turned_over(anywhere(seed, seed % 2 ? 1 : 0.2)), 0) << seed;
  }
}

// ... but what ARKit's shapes say is shown in full: skin beside the corners rolls as a mouth opens
// wide.
TEST_P(EachFace, ShowsAllOfEveryShape) {
  head::Pose free;
  for (std::size_t shape = 0; shape < fap::kArkitChannelCount; ++shape) {
    fap::ArkitFrame weights{};
    weights[shape] = 1;
    const fap::Frame frame = fap::arkit_to_fap(weights, fap::kAllArkit);
    head::pose(rig(), frame, pose_);
    head::pose(unwatched_, frame, free);
    EXPECT_EQ(pose_.positions[0], free.positions[0]) << fap::kArkitNames[shape];
  }
}

// What keeps it whole lets no point jump on the way.
TEST_P(EachFace, GoesSmoothlyToWhereItStops) {
  constexpr int kSteps = 60;
  for (unsigned seed = 0; seed < 2; ++seed) {
    std::vector<Vec3> last;
    for (int step = 0; step <= kSteps / 2; ++step) {
      turned_over(anywhere(seed, double(step) / kSteps));
      const std::vector<Vec3>& is = pose_.positions[0];
      float most = 0;
      for (std::size_t v = 0; v < last.size(); ++v) most = std::max(most, length(is[v] - last[v]));
      EXPECT_LT(most, 0.25f) << seed << " step " << step;
      last = is;
    }
  }
}

TEST_P(EachFace, StaysWholeInRecordedSpeech) {
  for (const auto& entry :
       std::filesystem::directory_iterator(data_dir() / "grid_s1_sample" / "fap")) {
    if (entry.path().extension() == ".csv") {
      expect_whole(read_table(entry.path()), entry.path().filename().string());
    }
  }
  EXPECT_GT(shown_, 230);
}

TEST_P(EachFace, StaysWholeInSampleTexts) {
  for (const char* name : {"plain.fap", "quirks.fap", "headerless.fap", "high_level.fap"}) {
    expect_whole(data_dir() / "fap" / name);
  }
  EXPECT_GT(shown_, 3);
}

TEST_P(EachFace, StaysWholeInVisemesAndExpressions) {
  for (int viseme = 1; viseme <= 14; ++viseme) {
    EXPECT_EQ(turned_over(head::viseme_shape(viseme)), 0) << "viseme " << viseme;
  }
  for (int expression = 1; expression <= 6; ++expression) {
    EXPECT_EQ(turned_over(head::expression_shape(expression)), 0) << "expression " << expression;
  }
}

// Extreme captures: a jaw thrust of -1242, a chin down by 955, brows that would pass each other.
TEST_P(EachFace, StaysWholeInCaptures) {
  const std::filesystem::path folder = shared_dir() / "wild_fap";
  if (shared_dir().empty() || !std::filesystem::is_directory(folder)) {
    GTEST_SKIP() << "no reference data: set ANIMEME_SHARED";
  }
  for (const char* name : {"jag.fap", "xface_fear.fap", "xface_pride.fap", "surp.fap", "anger.fap",
                           "joy.fap", "eyes.fap"}) {
    expect_whole(folder / name);
  }
  EXPECT_GT(shown_, 130);
}

}  // namespace fold_test
}  // namespace animeme::test
