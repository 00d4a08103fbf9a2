// Landmarks of real trackers: noise, slips, no word on which frame is neutral.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fap/landmarks.h"
#include "tests/fap/make.h"
#include "tests/support/made_up_face.h"

namespace animeme::fap {
namespace landmarks_noise_test {

using animeme::test::Camera;
using animeme::test::made_up_face;
using animeme::test::moved_face;
using made::Random;

// Near enough to a normal distribution: mean 0, variance 1.
double noise(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += double(random.in(0, 1000000)) * 1e-6;
  return sum;
}

constexpr std::string_view kFixed[] = {"3.7",  "3.8",  "3.11", "3.12", "9.6",   "9.7",
                                       "9.12", "9.13", "9.14", "9.15", kNasion, "11.1",
                                       "11.2", "11.3", "10.7", "10.8", "10.9",  "10.10"};

// How the small motions of a head (turns, shifts, growth) move a place on it along an axis.
std::vector<double> effects(const Point& p, std::size_t axis, bool depth) {
  const Point x = {0, -p[2], p[1]};  // turns about +X, +Y, +Z
  const Point y = {p[2], 0, -p[0]};
  const Point z = {-p[1], p[0], 0};
  std::vector<double> out = {z[axis], p[axis], axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0};
  if (depth) out.insert(out.end(), {x[axis], y[axis], axis == 2 ? 1.0 : 0.0});
  return out;
}

std::vector<std::vector<double>> inverse(std::vector<std::vector<double>> m) {
  const std::size_t n = m.size();
  std::vector<std::vector<double>> out(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) out[i][i] = 1;
  for (std::size_t i = 0; i < n; ++i) {  // positive definite: no pivots needed
    const double pivot = m[i][i];
    for (std::size_t k = 0; k < n; ++k) {
      m[i][k] /= pivot;
      out[i][k] /= pivot;
    }
    for (std::size_t j = 0; j < n; ++j) {
      const double factor = m[j][i];
      for (std::size_t k = 0; k < n && j != i; ++k) {
        m[j][k] -= factor * m[i][k];
        out[j][k] -= factor * out[i][k];
      }
    }
  }
  return out;
}

// What noise of one unit at each point does to the place of a point against the head: its own noise
// and that of the least squares fit.
class Expected {
 public:
  explicit Expected(bool depth) : depth_(depth) {
    const std::size_t n = depth ? 7 : 4;
    std::vector<std::vector<double>> normal(n, std::vector<double>(n, 0.0));
    const FeaturePoints face = made_up_face();
    for (const std::string_view id : kFixed) {
      for (std::size_t axis = 0; axis < (depth ? 3U : 2U); ++axis) {
        const auto row = effects(face.find(id)->second, axis, depth);
        for (std::size_t i = 0; i < n; ++i) {
          for (std::size_t j = 0; j < n; ++j) normal[i][j] += row[i] * row[j];
        }
      }
    }
    inverse_ = inverse(normal);
  }

  double variance(const Point& place, std::size_t axis) const {
    const auto row = effects(place, axis, depth_);
    double sum = 1;
    for (std::size_t i = 0; i < row.size(); ++i) {
      for (std::size_t j = 0; j < row.size(); ++j) sum += row[i] * inverse_[i][j] * row[j];
    }
    return sum;
  }

 private:
  bool depth_;
  std::vector<std::vector<double>> inverse_;
};

class Noisy : public testing::TestWithParam<bool> {};

TEST_P(Noisy, ErrorsAreThoseOfTheNoise) {
  const bool depth = GetParam();
  constexpr int kFrames = 800;
  constexpr double kNoise = 0.02;  // 0.2 mm on a head of usual size
  Random random(4);
  LandmarkTrack track{{30, 1}, {}, depth, {}};
  for (const auto& [id, place] : made_up_face()) track.points.push_back(id);
  std::vector<Frame> frames;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.number = i;
    for (int fap = kFirstLowLevel; fap <= kFapCount && i > 0; ++fap) {
      if (!animeme::test::shows_in_points(fap) || (!depth && (fap == 48 || fap == 49))) continue;
      frame.set(fap, std::int32_t(random.in(-200, 200)));
    }
    Camera camera;
    camera.scale = 0.1 * double(random.in(5, 50));
    const FeaturePoints face = moved_face(frame);
    LandmarkFrame seen{i, {}, {}, {}};
    for (const std::string& id : track.points) {
      Point place = camera(face.find(id)->second, frame);
      for (double& value : place) value += i == 0 ? 0 : kNoise * camera.scale * noise(random);
      seen.at.push_back(place);
    }
    frames.push_back(frame);
    track.frames.push_back(seen);
  }
  const auto found = landmarks_to_fap(track, {{0}, 0, false});
  ASSERT_TRUE(found) << found.error().message;

  const Expected expected(depth);
  const FeaturePoints face = made_up_face();
  int checked = 0;
  for (const FapInfo& fap : kFaps) {
    const Move move = move_of(fap.number);
    const auto at = face.find(fap.feature_point);
    if (!found->clip.frames[1].mask[std::size_t(fap.number)] || at == face.end()) continue;
    if (move.kind != MoveKind::translate) continue;
    const std::size_t axis = move.axis[0] != 0 ? 0 : move.axis[1] != 0 ? 1 : 2;
    double squares = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
      const std::size_t n = std::size_t(fap.number);
      squares += std::pow(found->clip.frames[i].value[n] - frames[i].value[n], 2);
    }
    const double step = step_size(fap.number, *measure_fapu(face));
    const double bound =
        std::sqrt(expected.variance(at->second, axis) * kNoise * kNoise / (step * step) +
                  1.0 / 12);  // rounding
    const double ratio = std::sqrt(squares / (kFrames - 1)) / bound;
    EXPECT_GT(ratio, 0.85) << fap.name;
    EXPECT_LT(ratio, 1.15) << fap.name;
    ++checked;
  }
  EXPECT_EQ(checked, depth ? 54 : 50);
}

INSTANTIATE_TEST_SUITE_P(Landmarks, Noisy, testing::Bool());

// A talk of 12 seconds: blinks, speech, and two seconds of silence with a still face.
Frame talking(int i) {
  Frame frame;
  frame.number = i;
  const double t = i / 30.0;
  const bool still = t >= 7 && t < 9;
  const auto wave = [&](double hertz, double size) {
    return std::int32_t(still ? 0 : size * (0.5 - 0.5 * std::cos(6.2831853 * hertz * t)));
  };
  frame.set(3, wave(2.3, 500));
  frame.set(4, -wave(2.3, 150));
  frame.set(5, -wave(2.3, 600));
  frame.set(59, wave(0.7, 200));
  frame.set(60, wave(0.7, 200));
  if (i % 60 < 5) {
    frame.set(19, 1000);
    frame.set(20, 1000);
  }
  frame.set(49, std::int32_t(20000 * std::sin(t)));
  frame.set(48, std::int32_t(6000 * std::sin(2 * t)));
  return frame;
}

TEST(Landmarks, TheNeutralFaceIsFound) {
  for (const bool depth : {true, false}) {
    LandmarkTrack track{{30, 1}, {}, depth, {}};
    for (const auto& [id, place] : made_up_face()) track.points.push_back(id);
    for (int i = 0; i < 360; ++i) {
      Frame frame = talking(i);
      if (!depth) frame.value[48] = frame.value[49] = 0;
      const FeaturePoints face = moved_face(frame);
      LandmarkFrame seen{i, {}, {}, {}};
      for (const std::string& id : track.points) {
        seen.at.push_back(Camera{2, {3, 4, 5}}(face.find(id)->second, frame));
      }
      track.frames.push_back(seen);
    }
    const auto found = landmarks_to_fap(track, {{}, 0, false});
    ASSERT_TRUE(found) << found.error().message;
    // All are of the still part, but frames in which the mouth happens to stand as in the neutral
    // face may be among them; no blink is.
    std::size_t still = 0;
    for (const std::int64_t number : found->neutral_frames) {
      still += number >= 210 && number < 270 ? 1 : 0;
      EXPECT_GE(number % 60, 5) << number;
    }
    EXPECT_GE(found->neutral_frames.size(), 20U);
    EXPECT_GE(still * 10, found->neutral_frames.size() * 9);
    for (std::size_t i = 0; i < 360; ++i) {
      const Frame frame = talking(int(i));
      for (const std::size_t fap : {3U, 4U, 5U, 19U, 20U, 59U, 60U}) {
        ASSERT_NEAR(found->clip.frames[i].value[fap], frame.value[fap], 1) << i << " " << fap;
      }
    }
  }
}

// A point of the head that slips by a centimetre moves neither the head nor the mouth.
TEST(Landmarks, SlipsOfOnePointAreSeenThrough) {
  for (const bool depth : {true, false}) {
    LandmarkTrack track{{30, 1}, {}, depth, {}};
    for (const LandmarkSource& source : landmark_sources(LandmarkLayout::ibug68)) {
      track.points.emplace_back(source.point);
    }
    Frame frame;
    frame.set(3, 300);
    for (int i = 0; i < 4; ++i) {
      frame.number = i;
      const FeaturePoints face = moved_face(i == 0 ? Frame{} : frame);
      LandmarkFrame seen{i, {}, {}, {}};
      for (const std::string& id : track.points) {
        Point place = face.find(id)->second;
        if (i == 1 && id == "3.7") place[1] += 1;
        if (i == 2 && id == "9.15") place[0] += 1;
        if (i == 3 && id == "3.11") place[1] -= 1;
        seen.at.push_back(place);
      }
      track.frames.push_back(seen);
    }
    const auto found = landmarks_to_fap(track, {{0}, 0, false});
    ASSERT_TRUE(found) << found.error().message;
    for (std::size_t i = 1; i < 4; ++i) {
      EXPECT_NEAR(found->clip.frames[i].value[3], 300, 6) << i;
      EXPECT_NEAR(found->clip.frames[i].value[59], 0, 6) << i;
      EXPECT_NEAR(found->clip.frames[i].value[50], 0, 300) << i;  // 0.003 rad
    }
  }
}

LandmarkTrack chin_track(fap::Rate rate, const std::vector<int>& chin) {
  LandmarkTrack track{rate, {}, true, {}};
  for (const auto& [id, place] : made_up_face()) track.points.push_back(id);
  for (std::size_t i = 0; i < chin.size(); ++i) {
    Frame frame;
    frame.set(3, chin[i]);
    const FeaturePoints face = moved_face(frame);
    LandmarkFrame seen{std::int64_t(i), {}, {}, {}};
    for (const std::string& id : track.points) seen.at.push_back(face.find(id)->second);
    track.frames.push_back(seen);
  }
  return track;
}

TEST(Landmarks, SmoothingDelaysNothing) {
  std::vector<int> chin(41, 0);
  chin[20] = 1000;
  const auto found = landmarks_to_fap(chin_track({60, 1}, chin), {{0}, 0.014, false});
  ASSERT_TRUE(found);
  const auto at = [&](std::size_t i) { return found->clip.frames[i].value[3]; };
  EXPECT_EQ(at(20), 475);
  EXPECT_EQ(at(19), 234);
  EXPECT_EQ(at(18), 28);
  for (std::size_t i = 0; i <= 20; ++i) EXPECT_EQ(at(20 - i), at(20 + i)) << i;
  int sum = 0;
  for (std::size_t i = 0; i < 41; ++i) sum += at(i);
  EXPECT_NEAR(sum, 1000, 3);
}

// A frame that is as far away as the bell reaches counts on both sides.
TEST(Landmarks, SmoothingReachesAsFarToBothSides) {
  LandmarkTrack track{{1, 1}, {}, true, {}};
  for (const auto& [id, place] : made_up_face()) track.points.push_back(id);
  const test::Camera camera;
  for (std::int64_t i = 0; i < 21; ++i) {
    Frame frame;
    if (i == 10) frame.set(49, 60000);
    const FeaturePoints face = moved_face(frame);
    LandmarkFrame seen{i, {}, {}, {}};
    for (const std::string& id : track.points) {
      seen.at.push_back(camera(face.find(id)->second, frame));
    }
    track.frames.push_back(seen);
  }
  const auto found = landmarks_to_fap(track, {{0}, 1, false});
  ASSERT_TRUE(found) << found.error().message;
  const auto at = [&](std::size_t i) { return found->clip.frames[i].value[49]; };
  EXPECT_GT(at(6), 0);
  EXPECT_EQ(at(5), 0);
  for (std::size_t i = 0; i <= 10; ++i) EXPECT_EQ(at(10 - i), at(10 + i)) << i;
}

TEST(Landmarks, SmoothingKeepsLinesAndCountsTimeNotFrames) {
  std::vector<int> line;
  for (int i = 0; i < 40; ++i) line.push_back(10 * i);
  LandmarkTrack track = chin_track({60, 1}, line);
  track.frames.erase(track.frames.begin() + 10, track.frames.begin() + 30);  // a gap
  const auto found = landmarks_to_fap(track, {{0}, 0.03, false});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->clip.frames[12].number, 32);
  EXPECT_NEAR(found->clip.frames[9].value[3], 90, 25);  // nothing from the other side of the gap
  EXPECT_NEAR(found->clip.frames[19].value[3], 390, 25);
}

// The ends of a take look to their one side: a mouth that comes to rest at its end is the neutral
// one, and nothing behind it is read.
TEST(LandmarksNoise, ATakeMayEndAtRest) {
  LandmarkTrack track{{30, 1}, {}, true, {}};
  for (const auto& [id, place] : test::made_up_face()) track.points.push_back(id);
  for (std::int64_t number = 0; number < 10; ++number) {
    Frame frame;
    frame.number = number;
    const int wide = number < 6 ? 100 + 97 * int(number % 3) : 0;
    for (const int fap : {53, 54}) frame.set(fap, wide);  // corners of the lips, which stay closed
    LandmarkFrame seen{number, {}, {}, {}};
    const FeaturePoints face = test::moved_face(frame);
    for (const std::string& id : track.points) seen.at.push_back(face.find(id)->second);
    track.frames.push_back(std::move(seen));
  }
  const auto found = landmarks_to_fap(track, {});
  ASSERT_TRUE(found) << found.error().describe();
  const auto& neutral = found->neutral_frames;
  for (const std::int64_t number : {7, 8, 9}) {
    EXPECT_EQ(std::count(neutral.begin(), neutral.end(), number), 1) << number;
  }
}

}  // namespace landmarks_noise_test
}  // namespace animeme::fap
