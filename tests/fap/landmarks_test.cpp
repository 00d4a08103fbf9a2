// Landmarks to FAPs: a made-up face is moved by known FAPs, and these have to come back.
#include "fap/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "tests/fap/make.h"
#include "tests/support/made_up_face.h"

namespace animeme::fap {
namespace landmarks_test {

using animeme::test::Camera;
using animeme::test::made_up_face;
using animeme::test::moved_face;
using animeme::test::shows_in_points;
using made::Random;
using testing::HasSubstr;

constexpr double kNotSeen = std::numeric_limits<double>::quiet_NaN();

LandmarkTrack empty_track(bool depth) {
  LandmarkTrack track{{30, 1}, {}, depth, {}};
  for (const auto& [id, place] : made_up_face()) track.points.push_back(id);
  return track;
}

LandmarkFrame seen(const LandmarkTrack& track, const Frame& frame, const Camera& camera) {
  LandmarkFrame out{frame.number, {}, {}, {}};
  const FeaturePoints face = moved_face(frame);
  for (const std::string& id : track.points) {
    out.at.push_back(camera(face.find(id)->second, frame));
  }
  return out;
}

// All FAPs that points show, anything the tables allow but half turns of the head.
Frame any_frame(Random& random, std::int64_t number, bool flat) {
  Frame frame;
  frame.number = number;
  for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
    if (!shows_in_points(fap) || (flat && (fap == 48 || fap == 49))) continue;
    const int limit = info(fap).unit == Unit::angle ? 60000 : info(fap).default_i_range;
    frame.set(fap, std::int32_t(random.in(-limit, limit)));
  }
  return frame;
}

Camera any_camera(Random& random) {
  Camera camera;
  camera.scale = 0.01 * double(random.in(20, 5000));
  for (double& shift : camera.shift) shift = 0.1 * double(random.in(-10000, 10000));
  return camera;
}

TEST(Landmarks, AllFapsComeBackFromAllPoints) {
  Random random(1);
  LandmarkTrack track = empty_track(true);
  std::vector<Frame> frames = {Frame{}};
  track.frames.push_back(seen(track, frames[0], {}));
  for (int i = 1; i < 200; ++i) {
    frames.push_back(any_frame(random, i * 2, false));
    track.frames.push_back(seen(track, frames.back(), any_camera(random)));
  }
  const auto face = landmarks_to_fap(track, {{0}, 0, false});
  ASSERT_TRUE(face) << face.error().message;
  ASSERT_EQ(face->clip.frames.size(), frames.size());
  EXPECT_EQ(face->clip.rate, track.rate);
  EXPECT_NEAR(face->fapu.mw, 5.0, 1e-9);
  EXPECT_LT(face->head_error, 1e-9);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(face->clip.frames[i], frames[i]) << i;
  }
}

TEST(Landmarks, FapsOfThePictureComeBackFromAPicture) {
  Random random(2);
  LandmarkTrack track = empty_track(false);
  std::vector<Frame> frames = {Frame{}};
  track.frames.push_back(seen(track, frames[0], {}));
  for (int i = 1; i < 200; ++i) {
    frames.push_back(any_frame(random, i, true));
    track.frames.push_back(seen(track, frames.back(), any_camera(random)));
  }
  const auto face = landmarks_to_fap(track, {{0}, 0, false});
  ASSERT_TRUE(face) << face.error().message;
  const std::set<int> out_of_the_picture = {14, 16, 17, 45, 48, 49};
  for (std::size_t i = 1; i < frames.size(); ++i) {
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      const std::size_t at = std::size_t(fap);
      EXPECT_EQ(face->clip.frames[i].mask[at],
                shows_in_points(fap) && out_of_the_picture.count(fap) == 0)
          << fap;
      if (!face->clip.frames[i].mask[at]) continue;
      ASSERT_EQ(face->clip.frames[i].value[at], frames[i].value[at]) << i << " " << info(fap).name;
    }
  }
}

class Layouts : public testing::TestWithParam<LandmarkLayout> {};

// Through the landmarks of a tracker, as a picture has them: x to the right, y down, z away.
TEST_P(Layouts, FapsComeBackThroughTheMap) {
  Random random(3);
  LandmarkTrack track{{25, 1}, {}, true, {}};
  for (const LandmarkSource& source : landmark_sources(GetParam())) {
    track.points.emplace_back(source.point);
  }
  const auto look = [&](const Frame& frame, Camera camera) {
    camera.sign = {1, -1, -1};
    const auto landmarks = animeme::test::landmarks_of(moved_face(frame), GetParam());
    LandmarkFrame out{frame.number, {}, {}, {}};
    for (const LandmarkSource& source : landmark_sources(GetParam())) {
      Point place = landmarks[std::size_t(source.landmark)];
      if (source.second >= 0) {
        const Point& other = landmarks[std::size_t(source.second)];
        for (std::size_t k = 0; k < 3; ++k) place[k] = (place[k] + other[k]) / 2;
      }
      out.at.push_back(camera(place, frame));
    }
    return out;
  };
  std::vector<Frame> frames = {Frame{}};
  track.frames.push_back(look(frames[0], {}));
  for (int i = 1; i < 100; ++i) {
    frames.push_back(any_frame(random, i, false));
    track.frames.push_back(look(frames.back(), any_camera(random)));
  }
  const auto face = landmarks_to_fap(track, {{0}, 0, false});
  ASSERT_TRUE(face) << face.error().message;
  const bool ibug = GetParam() == LandmarkLayout::ibug68;
  EXPECT_EQ(face->clip.frames[0].mask.count(), ibug ? 44U : 53U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    for (int fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (!face->clip.frames[i].mask[std::size_t(fap)]) continue;
      ASSERT_EQ(face->clip.frames[i].value[std::size_t(fap)], frames[i].value[std::size_t(fap)])
          << i << " " << info(fap).name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Landmarks, Layouts,
                         testing::Values(LandmarkLayout::ibug68, LandmarkLayout::mediapipe));

// A map has each landmark on the side it belongs to: landmarks of mirrored points are mirrored.
TEST(Landmarks, MapsNameKnownPointsOnce) {
  for (const auto layout : {LandmarkLayout::ibug68, LandmarkLayout::mediapipe}) {
    std::set<std::string_view> points;
    std::set<int> singles;
    const int count = layout == LandmarkLayout::ibug68 ? 68 : 478;
    for (const LandmarkSource& source : landmark_sources(layout)) {
      EXPECT_TRUE(points.insert(source.point).second) << source.point;
      EXPECT_TRUE(made_up_face().count(source.point)) << source.point;
      EXPECT_TRUE(source.landmark >= 0 && source.landmark < count);
      EXPECT_LT(source.second, count);
      if (source.second < 0) {
        EXPECT_TRUE(singles.insert(source.landmark).second) << source.landmark;
      }
    }
  }
}

TEST(Landmarks, LeftIsThePersonsLeft) {
  // The left eye is closed, the left corner of the mouth goes up, the left brow too.
  Frame wink;
  wink.number = 1;
  wink.set(19, 900);
  wink.set(59, 300);
  wink.set(31, 200);
  wink.set(23, 20000);  // looks to the left
  wink.set(50, 10000);  // tilts to the right
  // In a picture the person's left is right: x to the right, y down.
  for (const auto& sign : {std::array<int, 3>{1, -1, 1}, {-1, 1, 1}, {1, 1, 1}}) {
    LandmarkTrack track = empty_track(false);
    Camera camera;
    camera.sign = sign;
    track.frames = {seen(track, {}, camera), seen(track, wink, camera)};
    const auto face = landmarks_to_fap(track, {{0}, 0, false});
    ASSERT_TRUE(face);
    const Frame& out = face->clip.frames[1];
    for (const int fap : {19, 59, 31, 23, 50, 20, 60, 32}) {
      EXPECT_EQ(out.value[std::size_t(fap)], wink.value[std::size_t(fap)]) << fap;
    }
  }
}

// A mirrored picture of a wink of the left eye: trackers take the eye on the left of the picture
// for the right one.
TEST(Landmarks, MirroredPicturesSwapSides) {
  Frame wink;
  wink.number = 1;
  wink.set(20, 900);
  wink.set(60, 300);
  wink.set(23, -20000);
  wink.set(50, -10000);
  wink.set(15, 70);
  LandmarkTrack track = empty_track(false);
  track.frames = {seen(track, {}, {}), seen(track, wink, {})};
  const auto face = landmarks_to_fap(track, {{0}, 0, true});
  ASSERT_TRUE(face);
  const Frame& out = face->clip.frames[1];
  EXPECT_EQ(out.value[19], 900);
  EXPECT_EQ(out.value[20], 0);
  EXPECT_EQ(out.value[59], 300);
  EXPECT_EQ(out.value[60], 0);
  EXPECT_EQ(out.value[24], 20000);
  EXPECT_EQ(out.value[50], 10000);
  EXPECT_EQ(out.value[15], -70);
}

TEST(Landmarks, PointsThatAreNotSeenLeaveTheirFapsOut) {
  LandmarkTrack track = empty_track(true);
  Frame frame;
  frame.number = 1;
  frame.set(3, 200);
  track.frames = {seen(track, {}, {}), seen(track, frame, {}), seen(track, frame, {})};
  track.frames[2].number = 2;
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    if (track.points[i] == "2.2") track.frames[1].at[i][1] = kNotSeen;
    if (track.points[i].starts_with("9.") || track.points[i].starts_with("3.") ||
        track.points[i].starts_with("1") || track.points[i] == kNasion) {
      track.frames[2].at[i] = {kNotSeen, kNotSeen, kNotSeen};
    }
  }
  const auto face = landmarks_to_fap(track, {{0}, 0, false});
  ASSERT_TRUE(face);
  EXPECT_EQ(face->lost, 1U);
  ASSERT_EQ(face->clip.frames.size(), 2U);
  EXPECT_FALSE(face->clip.frames[1].mask[4]);
  EXPECT_FALSE(face->clip.frames[1].mask[17]);
  EXPECT_EQ(face->clip.frames[1].value[3], 200);
}

// The pose of the head comes from its other points.
TEST(Landmarks, APointOfTheSkullThatIsNotSeenLeavesTheFapsAsTheyAre) {
  for (const char* hidden : {"3.7", "3.8", "3.11", "3.12"}) {
    LandmarkTrack track = empty_track(true);
    Frame frame;
    frame.number = 1;
    frame.set(3, 200);
    frame.set(49, 20000);
    track.frames = {seen(track, {}, {}), seen(track, frame, {})};
    const auto whole = landmarks_to_fap(track, {{0}, 0, false});
    const auto at = std::find(track.points.begin(), track.points.end(), hidden);
    ASSERT_NE(at, track.points.end());
    track.frames[1].at[std::size_t(at - track.points.begin())] = {kNotSeen, kNotSeen, kNotSeen};
    const auto face = landmarks_to_fap(track, {{0}, 0, false});
    ASSERT_TRUE(whole && face);
    EXPECT_EQ(face->lost, 0U) << hidden;
    ASSERT_EQ(face->clip.frames.size(), 2U) << hidden;
    for (const int fap : {3, 49}) {
      EXPECT_TRUE(face->clip.frames[1].mask[std::size_t(fap)]) << hidden << ", FAP " << fap;
      EXPECT_NEAR(face->clip.frames[1].value[std::size_t(fap)],
                  whole->clip.frames[1].value[std::size_t(fap)],
                  2 + std::abs(frame.value[std::size_t(fap)]) / 100)
          << hidden << ", FAP " << fap;
    }
  }
}

// The line of the eyes comes from the pairs of points that the track has both of.
TEST(Landmarks, ATrackWithoutOnePointOfTheEyesHasAnUprightHead) {
  Frame frame;
  frame.number = 1;
  frame.set(3, 200);
  frame.set(50, 20000);
  for (const char* left_out :
       {"3.7", "3.8", "3.11", "3.12", "3.1", "3.2", "3.3", "3.4", "3.5", "3.6", "3.9", "3.10"}) {
    LandmarkTrack track = empty_track(true);
    const auto at = std::find(track.points.begin(), track.points.end(), left_out);
    ASSERT_NE(at, track.points.end()) << left_out;
    track.points.erase(at);
    Camera tilted;
    tilted.sign = {1, -1, -1};
    track.frames = {seen(track, {}, tilted), seen(track, frame, tilted)};
    const auto face = landmarks_to_fap(track, {{0}, 0, false});
    ASSERT_TRUE(face) << left_out << ": " << face.error().message;
    ASSERT_EQ(face->clip.frames.size(), 2U) << left_out;
    const Frame& out = face->clip.frames[1];
    EXPECT_EQ(out.value[3], 200) << left_out;
    EXPECT_EQ(out.value[50], 20000) << left_out;
    EXPECT_EQ(out.value[48], 0) << left_out;
    EXPECT_EQ(out.value[49], 0) << left_out;
  }
}

// Eyes that look at the camera while the head turns away turn back against it.
TEST(Landmarks, GazeIsAgainstTheHead) {
  for (const bool depth : {true, false}) {
    LandmarkTrack track = empty_track(depth);
    Frame turned;
    turned.number = 1;
    turned.set(49, 30000);
    track.frames = {seen(track, {}, {}), seen(track, turned, {})};
    for (LandmarkFrame& frame : track.frames) {
      frame.gaze = {Point{0, 0, 2}, Point{0, 0, 1}};
      frame.head = HeadPose{0, frame.number == 1 ? 0.3 : 0, 0};
    }
    const auto face = landmarks_to_fap(track, {{0}, 0, false});
    ASSERT_TRUE(face);
    const Frame& out = face->clip.frames[1];
    EXPECT_EQ(out.value[49], 30000);
    EXPECT_EQ(out.value[23], -30000);
    EXPECT_EQ(out.value[24], -30000);
    EXPECT_EQ(out.value[25], 0);
  }
}

TEST(Landmarks, Errors) {
  LandmarkTrack track = empty_track(true);
  track.frames = {seen(track, {}, {})};
  const auto message = [](const LandmarkTrack& given, const LandmarkOptions& options = {}) {
    const auto face = landmarks_to_fap(given, options);
    return face ? std::string("none") : face.error().message;
  };
  EXPECT_EQ(message(track), "none");
  EXPECT_THAT(message(track, {{1}, 0, false}), HasSubstr("neutral frame 1"));
  EXPECT_THAT(message(track, {{0}, -1, false}), HasSubstr("smooth"));
  LandmarkTrack bad = track;
  bad.frames.clear();
  EXPECT_THAT(message(bad), HasSubstr("has no frames"));
  bad = track;
  bad.points[0] = "2.15";
  EXPECT_THAT(message(bad), HasSubstr("2.15"));
  bad.points[0] = bad.points[1];
  EXPECT_THAT(message(bad), HasSubstr("twice"));
  bad = track;
  bad.rate = {0, 1};
  EXPECT_THAT(message(bad), HasSubstr("rate"));
  bad = track;
  bad.frames[0].at.pop_back();
  EXPECT_THAT(message(bad), HasSubstr("points"));
  bad = track;
  bad.frames.push_back(bad.frames[0]);
  EXPECT_THAT(message(bad), HasSubstr("ascend"));
  bad = track;
  for (std::size_t i = 0; i < bad.points.size(); ++i) {
    if (bad.points[i] == "9.15") bad.frames[0].at[i][0] = kNotSeen;
  }
  EXPECT_THAT(message(bad), HasSubstr("9.15"));
  for (Point& point : bad.frames[0].at) point = {kNotSeen, kNotSeen, kNotSeen};
  EXPECT_THAT(message(bad), HasSubstr("no frame has open eyes"));
  EXPECT_THAT(message(bad, {{0}, 0, false}), HasSubstr("head cannot be found"));
}

}  // namespace landmarks_test
}  // namespace animeme::fap
