// What trackers do wrong: glitches, slips and gaps; pictures of a wrong shape; neutral faces apart.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/landmark_tables.h"
#include "tools/formats/exchange/face_file.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {
namespace repair_test {

using test::mediapipe;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string plain_name(int i, char axis) { return std::string(1, axis) + std::to_string(i); }

fap::LandmarkTrack track(int rows) {
  LandmarkTableOptions options;
  options.rate = fap::Rate{25, 1};
  auto table = read_landmark_table(test::sixty_eight(rows, plain_name), options);
  EXPECT_TRUE(table);
  return table ? table->track : fap::LandmarkTrack{};
}

bool is_as(const fap::LandmarkTrack& a, const fap::LandmarkTrack& b, double tolerance) {
  if (a.frames.size() != b.frames.size()) return false;
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    if (a.frames[i].number != b.frames[i].number) return false;
    for (std::size_t k = 0; k < a.points.size(); ++k) {
      const fap::Point& p = a.frames[i].at[k];
      const fap::Point& q = b.frames[i].at[k];
      if (!(std::hypot(p[0] - q[0], p[1] - q[1]) <= tolerance)) return false;
    }
  }
  return true;
}

TEST(RepairTrack, LeavesAGoodOneAlone) {
  const fap::LandmarkTrack good = track(20);
  fap::LandmarkTrack same = good;
  const Repairs repairs = repair_track(same);
  EXPECT_TRUE(is_as(same, good, 0));
  EXPECT_EQ(repairs.glitches + repairs.slips + repairs.filled_frames + repairs.filled_points, 0U);
  EXPECT_THAT(repairs.made, IsEmpty());
}

TEST(RepairTrack, OtherFacesForAMoment) {
  const fap::LandmarkTrack good = track(20);
  for (const auto& [dx, scale] : {std::pair{500.0, 1.0}, {0.0, 2.0}}) {
    fap::LandmarkTrack bad = good;
    for (const std::size_t i : {4U, 5U, 6U}) {
      for (fap::Point& point : bad.frames[i].at) {
        point = {point[0] * scale + dx, point[1] * scale, point[2]};
      }
    }
    const Repairs repairs = repair_track(bad);
    EXPECT_EQ(repairs.glitches, 3U);
    EXPECT_THAT(repairs.made, ElementsAre(4, 5, 6));
    EXPECT_TRUE(is_as(bad, good, 2)) << "pixels of a face of 30 a centimetre";
  }
}

TEST(RepairTrack, AFaceThatStaysThereIsTheFace) {
  fap::LandmarkTrack bad = track(20);
  for (std::size_t i = 10; i < 20; ++i) {
    for (fap::Point& point : bad.frames[i].at) point[0] += 500;
  }
  const fap::LandmarkTrack before = bad;
  EXPECT_EQ(repair_track(bad).glitches, 0U);
  EXPECT_TRUE(is_as(bad, before, 0));
}

TEST(RepairTrack, PointsThatSlip) {
  const fap::LandmarkTrack good = track(20);
  fap::LandmarkTrack bad = good;
  bad.frames[6].at[3][1] += 200;
  bad.frames[12].at[5] = {0, 0, 0};
  const Repairs repairs = repair_track(bad);
  EXPECT_EQ(repairs.slips, 2U);
  EXPECT_EQ(repairs.filled_points, 2U);
  EXPECT_EQ(repairs.glitches, 0U);
  EXPECT_TRUE(is_as(bad, good, 2));
}

// What a mouth does at 25 frames a second: shut, wide open, shut again, in single frames.
TEST(RepairTrack, SpeechIsNoGlitch) {
  fap::LandmarkTrack talk = track(30);
  for (std::size_t i = 0; i < 30; ++i) {
    for (std::size_t k = 0; k < talk.points.size(); ++k) {
      const bool lower = talk.points[k] == "2.1" || talk.points[k] == "2.3" ||
                         talk.points[k] == "8.2" || talk.points[k] == "2.8";
      talk.frames[i].at[k] = talk.frames[0].at[k];
      if (lower && i % 3 == 1) talk.frames[i].at[k][1] += 60;  // 2 cm, farther than speech goes
    }
  }
  const fap::LandmarkTrack before = talk;
  const Repairs repairs = repair_track(talk);
  EXPECT_EQ(repairs.glitches + repairs.slips, 0U);
  EXPECT_TRUE(is_as(talk, before, 0));
}

TEST(RepairTrack, GapsOfAFifthOfASecond) {
  const fap::LandmarkTrack good = track(30);
  fap::LandmarkTrack bad = good;
  const auto cut = [&](std::size_t first, std::size_t last) {
    bad.frames.erase(bad.frames.begin() + std::ptrdiff_t(first),
                     bad.frames.begin() + std::ptrdiff_t(last + 1));
  };
  cut(20, 25);  // 0.24 s
  cut(10, 14);  // 0.2 s
  const Repairs repairs = repair_track(bad);
  EXPECT_EQ(repairs.filled_frames, 5U);
  EXPECT_EQ(repairs.gaps, 1U);
  EXPECT_NEAR(repairs.longest_gap, 0.24, 1e-9);
  EXPECT_EQ(bad.frames.size(), 24U);
  EXPECT_THAT(repairs.made, ElementsAre(10, 11, 12, 13, 14));
}

TEST(RepairTrack, HostileTracks) {
  fap::LandmarkTrack nothing = track(3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (fap::LandmarkFrame& frame : nothing.frames) {
    for (fap::Point& point : frame.at) point = {nan, nan, nan};
  }
  EXPECT_EQ(repair_track(nothing).glitches, 0U);
  fap::LandmarkTrack huge = track(4);
  huge.frames[1].at[0] = {1e308, -1e308, 0};
  huge.frames[2].at[0] = {-1e308, 1e308, 0};
  huge.frames[3].number = std::int64_t(1) << 60;
  EXPECT_EQ(repair_track(huge).gaps, 1U);
  fap::LandmarkTrack slow = track(4);
  slow.rate = fap::Rate{10, 1};
  slow.frames.erase(slow.frames.begin() + 1);
  EXPECT_EQ(repair_track(slow).filled_frames, 0U);
}

LandmarkTableOptions sized(double width, double height) {
  LandmarkTableOptions options;
  options.size = PictureSize{width, height};
  return options;
}

TEST(PictureShape, AWrongSizeIsSeenInTheFace) {
  const std::string text = mediapipe(4, 478, 1280, 720);
  EXPECT_THAT(read_landmark_table(text, sized(1280, 720))->warnings, IsEmpty());
  EXPECT_THAT(read_landmark_table(text, sized(1280, 800))->warnings, IsEmpty()) << "16:10 may be";
  for (const auto& [width, height] : {std::pair{720.0, 1280.0}, {640.0, 480.0}, {512.0, 512.0}}) {
    EXPECT_THAT(read_landmark_table(text, sized(width, height))->warnings,
                ElementsAre(HasSubstr("is --size the displayed size of the video?")))
        << width;
  }
}

TEST(PictureShape, PixelsMayBeWide) {
  // 720x576 shown as 16:9.
  LandmarkTableOptions options = sized(720, 576);
  options.pixel_aspect = 64.0 / 45;
  const auto wide = read_landmark_table(mediapipe(4, 478, 1024, 576), options);
  ASSERT_TRUE(wide) << wide.error().describe();
  EXPECT_THAT(wide->warnings, IsEmpty());
  const auto square = read_landmark_table(mediapipe(4, 478, 1024, 576), sized(1024, 576));
  ASSERT_TRUE(square);
  EXPECT_NEAR(wide->track.frames[2].at[0][0], square->track.frames[2].at[0][0], 1e-6);
  options.pixel_aspect = 0;
  EXPECT_EQ(read_landmark_table(mediapipe(4, 478), options).error().code, Code::invalid_argument);
}

TEST(PictureShape, DepthOfAnotherUnit) {
  const std::string text = mediapipe(4, 478);
  LandmarkTableOptions options = sized(1280, 720);
  EXPECT_TRUE(read_landmark_table(text, options)->track.depth);
  options.depth_scale = 0.01;
  const auto flat = read_landmark_table(text, options);
  ASSERT_TRUE(flat);
  EXPECT_FALSE(flat->track.depth);
  EXPECT_THAT(flat->warnings, ElementsAre(HasSubstr("z has another unit than x and y")));
}

TEST(NeutralFace, OneForSeveral) {
  LandmarkTableOptions options = sized(1280, 720);
  const auto whole = read_landmark_table(mediapipe(12, 478), options);
  ASSERT_TRUE(whole);
  LandmarkTable a = *whole, b = *whole;
  a.track.frames.resize(6);
  b.track.frames.erase(b.track.frames.begin(), b.track.frames.begin() + 6);
  // The other camera is nearer and sees the face elsewhere.
  for (fap::LandmarkFrame& frame : b.track.frames) {
    for (fap::Point& p : frame.at) p = {2 * p[0] + 100, 2 * p[1] - 50, 2 * p[2]};
  }
  const auto rest = common_face({a, b});
  ASSERT_TRUE(rest) << rest.error().describe();
  LandmarkImportOptions import;
  import.face.rest = *rest;
  import.face.smooth = 0;
  const auto first = import_landmarks(a, import);
  const auto second = import_landmarks(b, import);
  ASSERT_TRUE(first && second);
  EXPECT_THAT(first->face.neutral_frames, IsEmpty());
  EXPECT_EQ(first->face.fapu, second->face.fapu);
  const double step = second->face.clip.frames[0].value[3] - first->face.clip.frames[0].value[3];
  EXPECT_NEAR(step, 120, 3) << "20 units a frame, whatever the camera";

  LandmarkImportOptions part;
  part.neutral = "0";
  EXPECT_EQ(common_face({a, b}, part).error().code, Code::invalid_argument);
  EXPECT_EQ(common_face({}).error().code, Code::invalid_argument);
  b.track.points.pop_back();
  for (fap::LandmarkFrame& frame : b.track.frames) frame.at.pop_back();
  EXPECT_THAT(common_face({a, b}).error().message, HasSubstr("different points"));
}

TEST(NeutralFace, AsAFile) {
  LandmarkImportOptions options;
  options.neutral = "0";
  options.table = sized(1280, 720);
  const auto take = import_landmarks(mediapipe(4, 478), options);
  ASSERT_TRUE(take) << take.error().describe();
  const std::string text = write_face_file(take->face.rest);
  EXPECT_TRUE(is_face_file(text));
  const auto back = read_face_file(text);
  ASSERT_TRUE(back) << back.error().describe();
  EXPECT_EQ(write_face_file(*back), text);
  EXPECT_EQ(back->points.size(), take->face.rest.points.size());
  EXPECT_TRUE(back->depth);
  EXPECT_NEAR(back->fapu.mns, take->face.fapu.mns, 1e-6);
  // A flat recording can be measured against a face with depth, not the other way round.
  options.neutral.clear();
  options.face.rest = *back;
  options.table.flat = true;
  EXPECT_TRUE(import_landmarks(mediapipe(4, 478), options));
  options.face.rest->depth = false;
  options.table.flat = false;
  EXPECT_EQ(import_landmarks(mediapipe(4, 478), options).error().code, Code::invalid_argument);
}

TEST(NeutralFace, HostileFiles) {
  const std::string units =
      "\"fapu\": {\"IRISD\": 1, \"ES\": 6, \"ENS\": 4, \"MNS\": 2, \"MW\": 5}";
  const std::string head = "{\"format\": \"animeme-face\", \"version\": 1, ";
  for (const std::string& text :
       {std::string(""), std::string("{}"), std::string("[1]"), head + units + "}",
        head + "\"points\": {\"2.1\": [1, 2, 3]}}", head + units + ", \"points\": {}}",
        head + units + ", \"points\": {\"2.1\": [1, 2]}}",
        head + units + ", \"points\": {\"99.9\": [1, 2, 3]}}",
        head + units + ", \"depth\": 1, \"points\": {\"2.1\": [1, 2, 3]}}",
        "{\"format\": \"animeme-face\", \"version\": 2, " + units + "}",
        "{\"format\": \"animeme-face\", \"version\": \"1\", " + units + "}",
        std::string("{\"fapu_px\": 3, \"neutral_px\": {}}"),
        std::string("{\"fapu_px\": {}, \"neutral_px\": {\"152\": 4}}")}) {
    EXPECT_FALSE(read_face_file(text)) << text;
  }
  EXPECT_FALSE(is_face_file("time_s,x_0\n"));
  EXPECT_TRUE(read_face_file(head + units + ", \"points\": {\"2.1\": [1, 2, 3]}, \"gaze\": 5}"));
}

// Units that are milliseconds, a part of a layout, a face that comes late.
TEST(Landmarks, WhatATableDoesNotSay) {
  const auto lips = read_landmark_table(
      "time_s,x61,y61,x291,y291,x13,y13,x14,y14\n0,1,2,3,4,5,6,7,8\n0.04,1,2,3,4,5,6,7,8\n");
  ASSERT_TRUE(lips) << lips.error().describe();
  EXPECT_EQ(lips->track.points.size(), 4U);
  EXPECT_THAT(lips->warnings, Contains(HasSubstr("a part of those of MediaPipe")));
  std::string text = "timestamp_ms,confidence,8.1_x,8.1_y\n";
  for (int i = 0; i < 8; ++i) {
    text += std::to_string(1000 + 40 * i) + (i < 3 ? ",0,,\n" : ",1,1,2\n");
  }
  const auto late = read_landmark_table(text);
  ASSERT_TRUE(late) << late.error().describe();
  EXPECT_EQ(late->track.rate, (fap::Rate{25, 1}));
  ASSERT_EQ(late->track.frames.size(), 5U);
  EXPECT_EQ(late->track.frames[0].number, 3) << "three frames have passed";
  ASSERT_TRUE(late->start);
  EXPECT_NEAR(*late->start, 1.0, 1e-9);
}

}  // namespace repair_test
}  // namespace animeme::exchange
