// Captured points: tables of any kind, and C3D.
#include "tools/formats/exchange/points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/c3d_writer.h"
#include "tools/formats/exchange/c3d.h"

namespace animeme::exchange {
namespace points_test {

using test::C3dFile;
using testing::ElementsAre;
using testing::HasSubstr;

PointRecording table(const std::string& text, const PointTableOptions& options = {}) {
  const auto read = read_point_table(text, options);
  EXPECT_TRUE(read) << (read ? "" : read.error().describe());
  return read ? *read : PointRecording{};
}

std::string refusal(const std::string& text, const PointTableOptions& options = {}) {
  const auto read = read_point_table(text, options);
  EXPECT_FALSE(read) << text;
  return read ? "" : read.error().describe();
}

TEST(PointTable, ReadsNamesOfAnyForm) {
  const auto take = table(
      "time_s,UL_x,UL_y,UL_z,LL.X,LL.Y,LL.Z,lip corner x,lip corner y,lip corner z,note\n"
      "0.00,1,2,3,4,5,6,7,8,9,a\n"
      "0.01,1,2,3,,5,6,nan,8,9,b\n");
  EXPECT_EQ(take.track.dimensions, 3u);
  EXPECT_THAT(take.track.names, ElementsAre("UL", "LL", "lip corner"));
  EXPECT_EQ(take.track.rate, (fap::Rate{100, 1}));
  EXPECT_THAT(take.track.frame(0), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9));
  EXPECT_TRUE(take.track.seen(1, 0));
  EXPECT_FALSE(take.track.seen(1, 1));
  EXPECT_FALSE(take.track.seen(1, 2));
  EXPECT_TRUE(std::isnan(take.track.frame(1)[4]));  // no half of a point
}

TEST(PointTable, ReadsNumbersAsTheTrackersWriteThem) {
  const auto flat = table(
      "time_s;x61;y61;x_0;y_0;landmark_17_x;landmark_17_y\n0;1;2;3;4;5;6\n0.04;1;2;3;4;5;6\n");
  EXPECT_EQ(flat.track.dimensions, 2u);
  EXPECT_THAT(flat.track.names, ElementsAre("61", "0", "17"));
  // OpenFace: the points in space, and rows without a face.
  const auto space = table(
      "frame, timestamp, success, gaze_0_x, gaze_0_y, gaze_0_z, x_0, y_0, X_0, Y_0, Z_0\n"
      "1, 0.00, 1, 0, 0, 1, 100, 200, 1, 2, 3\n"
      "2, 0.04, 0, 0, 0, 1, 100, 200, 1, 2, 3\n");
  EXPECT_THAT(space.track.names, ElementsAre("0"));
  EXPECT_EQ(space.track.dimensions, 3u);
  EXPECT_TRUE(space.track.seen(0, 0));
  EXPECT_FALSE(space.track.seen(1, 0));
}

TEST(PointTable, FramesThatAreMissingAreNotSeen) {
  const auto take = table("time_s,a_x,a_y\n0.00,1,2\n0.04,1,2\n0.16,5,6\n0.20,5,6\n");
  ASSERT_EQ(take.track.frames(), 6u);
  EXPECT_TRUE(take.track.seen(1, 0));
  EXPECT_FALSE(take.track.seen(2, 0));
  EXPECT_FALSE(take.track.seen(3, 0));
  EXPECT_TRUE(take.track.seen(4, 0));
}

TEST(PointTable, SharesOfAPictureAndRates) {
  PointTableOptions options;
  options.size = PictureSize{1280, 720};
  options.rate = fap::Rate{30, 1};
  const auto take = table("a_x,a_y\n0.5,0.5\n0.25,1\n", options);
  EXPECT_THAT(take.track.values, ElementsAre(640, 360, 320, 720));
  EXPECT_EQ(take.track.rate, (fap::Rate{30, 1}));
}

TEST(PointTable, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal(""), HasSubstr("empty"));
  EXPECT_THAT(refusal("time_s,jaw\n0,1\n"), HasSubstr("no column is a coordinate"));
  EXPECT_THAT(refusal("time_s,a_x\n0,1\n"), HasSubstr("the point a has no column for its y"));
  EXPECT_THAT(refusal("time_s,a_x,a_y\n"), HasSubstr("no row"));
  EXPECT_THAT(refusal("a_x,a_y\n1,2\n"), HasSubstr("--rate"));
  EXPECT_THAT(refusal("time_s,a_x,a_y\n0,1,2\n0.04,left,2\n"),
              HasSubstr("line 3:6: a_x is 'left'"));
  EXPECT_THAT(refusal("time_s,a_x,a_y,a_x\n0,1,2,3\n"), HasSubstr("a_x"));
  EXPECT_THAT(refusal("time_s,a_x,a_y\n0,1\n"), HasSubstr("line 2"));
  // Two rows a day apart would be millions of frames.
  PointTableOptions options;
  options.rate = fap::Rate{100, 1};
  EXPECT_THAT(refusal("time_s,a_x,a_y\n0,1,2\n0.01,1,2\n5000,1,2\n", options),
              HasSubstr("too many"));
}

C3dFile three_markers() {
  C3dFile file;
  file.labels = {"ULIP", "LLIP", "CHIN"};
  for (int i = 0; i < 5; ++i) {
    file.frames.push_back({10.5 + i, -20.25, 3, 0, 11, -30.5 - i, 3.75, 1, 9, -60, 0.5, 0});
  }
  file.frames[2][7] = -1;  // the lower lip is hidden
  return file;
}

TEST(C3d, ReadsAllProcessorsAndBothKindsOfNumbers) {
  for (const auto processor :
       {C3dFile::Processor::intel, C3dFile::Processor::dec, C3dFile::Processor::mips}) {
    for (const double scale : {-0.1, 0.25}) {
      C3dFile file = three_markers();
      file.processor = processor;
      file.scale = scale;
      file.analogue = scale < 0 ? 0 : 3;
      const auto bytes = file.bytes();
      ASSERT_TRUE(is_c3d(bytes));
      const auto take = read_c3d(bytes);
      ASSERT_TRUE(take) << take.error().describe();
      EXPECT_THAT(take->track.names, ElementsAre("ULIP", "LLIP", "CHIN"));
      EXPECT_EQ(take->track.rate, (fap::Rate{100, 1}));
      EXPECT_EQ(take->unit, "mm");
      EXPECT_TRUE(take->warnings.empty());
      ASSERT_EQ(take->track.frames(), 5u);
      for (std::size_t i = 0; i < 5; ++i) {
        for (std::size_t p = 0; p < 3; ++p) {
          ASSERT_EQ(take->track.seen(i, p), i != 2 || p != 1);
          for (std::size_t k = 0; k < 3 && (i != 2 || p != 1); ++k) {
            EXPECT_NEAR(take->track.frame(i)[3 * p + k], file.frames[i][4 * p + k],
                        scale < 0 ? 1e-5 : 0.13);
          }
        }
      }
    }
  }
}

TEST(C3d, NamesWithoutLabelsAndTwice) {
  C3dFile file = three_markers();
  file.labels = {"LIP", "", "LIP"};
  const auto take = read_c3d(file.bytes());
  ASSERT_TRUE(take);
  EXPECT_THAT(take->track.names, ElementsAre("LIP", "M2", "LIP_2"));
}

TEST(C3d, AFileThatIsCutOffGivesWhatIsThere) {
  const auto bytes = three_markers().bytes();
  const std::size_t frame = 3 * 4 * 4;
  const auto take = read_c3d(std::span(bytes).first(bytes.size() - 2 * frame + 1));
  ASSERT_TRUE(take);
  EXPECT_EQ(take->track.frames(), 3u);
  EXPECT_THAT(take->warnings, ElementsAre(HasSubstr("3 of 5 frames")));
  // Anywhere else it is an error, never a crash.
  for (std::size_t size = 0; size < bytes.size() - 5 * frame; ++size) {
    EXPECT_FALSE(read_c3d(std::span(bytes).first(size))) << size;
  }
}

TEST(C3d, DamageIsAnErrorOrOtherNumbers) {
  const auto whole = three_markers().bytes();
  std::size_t refused = 0;
  for (std::size_t at = 0; at < 1200; ++at) {
    for (const int value : {0, 1, 127, 128, 255}) {
      auto bytes = whole;
      bytes[at] = std::uint8_t(value);
      const auto take = read_c3d(bytes);
      if (!take) {
        ++refused;
        EXPECT_FALSE(take.error().message.empty());
      } else {
        EXPECT_EQ(take->track.values.size(), take->track.frames() * take->track.size());
      }
    }
  }
  EXPECT_GT(refused, 100u);
}

}  // namespace points_test
}  // namespace animeme::exchange
