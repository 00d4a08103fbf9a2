// Landmarks of trackers as a library: tables, what the options change, hostile input.
#include "tools/formats/exchange/landmarks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/landmark_tables.h"

namespace animeme::exchange {
namespace landmarks_test {

using test::expect_faps;
using test::mediapipe;
using test::openface;
using test::sixty_eight;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string plain_name(int i, char axis) { return std::string(1, axis) + std::to_string(i); }

TEST(ExchangeLandmarks, OpenFace) {
  const std::string text = openface(8);
  EXPECT_TRUE(is_landmark_table(text));
  const auto table = read_landmark_table(text);
  ASSERT_TRUE(table) << table.error().describe();
  EXPECT_EQ(table->track.rate, (fap::Rate{30, 1}));
  EXPECT_TRUE(table->track.depth);
  EXPECT_EQ(table->track.frames.size(), 7U);
  EXPECT_EQ(table->track.frames[5].number, 6) << "the tracker was not sure of a row";
  EXPECT_THAT(table->warnings, ElementsAre(HasSubstr("low confidence, skipped: 1")));

  LandmarkTableOptions flat;
  flat.flat = true;
  EXPECT_FALSE(read_landmark_table(text, flat)->track.depth);
  LandmarkTableOptions all;
  all.confidence = 0;
  EXPECT_EQ(read_landmark_table(text, all)->track.frames.size(), 7U) << "success is 0";
}

TEST(ExchangeLandmarks, FapsOfATake) {
  LandmarkImportOptions options;
  options.neutral = "0";
  options.face.smooth = 0;
  const auto take = import_landmarks(openface(5), options);
  ASSERT_TRUE(take) << take.error().describe();
  EXPECT_TRUE(take->depth);
  EXPECT_THAT(take->warnings, IsEmpty());
  EXPECT_THAT(take->face.neutral_frames, ElementsAre(0));
  EXPECT_GT(take->face.fapu.es, 0);
  expect_faps(take->face.clip, {3, 5, 12, 19, 31, 48, 49, 50}, 1);
}

TEST(ExchangeLandmarks, TheNeutralPartIsTextOfTheUser) {
  const std::string text = sixty_eight(10, plain_name);
  LandmarkImportOptions options;
  options.table.rate = fap::Rate{25, 1};
  const auto frames = [&](const char* neutral) {
    options.neutral = neutral;
    const auto take = import_landmarks(text, options);
    return take ? take->face.neutral_frames : std::vector<std::int64_t>();
  };
  EXPECT_THAT(frames("0-2"), ElementsAre(0, 1, 2));
  EXPECT_THAT(frames("0.04s-0.08s"), ElementsAre(1, 2));
  EXPECT_THAT(frames("0.04-0.08s"), ElementsAre(1, 2));
  for (const char* bad : {"x", "-", "s", "2-1", "-1", "0-1e999", "nan", "10", "9s", "1-2-3"}) {
    options.neutral = bad;
    const auto take = import_landmarks(text, options);
    ASSERT_FALSE(take) << bad;
    EXPECT_EQ(take.error().code, Code::invalid_argument) << bad;
    EXPECT_THAT(take.error().message, HasSubstr(bad));
  }
}

TEST(ExchangeLandmarks, SharesOfAPicture) {
  const std::string text = mediapipe(4, 478, 640, 480);
  const auto guessed = read_landmark_table(text);
  ASSERT_TRUE(guessed) << guessed.error().describe();
  EXPECT_THAT(guessed->warnings, ElementsAre(HasSubstr("assumed to be 4:3")));
  LandmarkTableOptions told;
  told.size = parse_picture_size("640x480");
  const auto table = read_landmark_table(text, told);
  ASSERT_TRUE(table) << table.error().describe();
  EXPECT_THAT(table->warnings, IsEmpty());
  // The guess has the same proportions, so it differs by a factor alone.
  const fap::Point& a = guessed->track.frames[2].at[0];
  const fap::Point& b = table->track.frames[2].at[0];
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(a[k] * 160, b[k], 1e-9);
}

TEST(ExchangeLandmarks, SizesOfPictures) {
  const auto size = parse_picture_size("1280x720");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 1280);
  EXPECT_EQ(size->height, 720);
  EXPECT_TRUE(parse_picture_size("16:9"));
  for (const char* bad : {"", "x", "16", "16x", "x9", "0x9", "-1x9", "nanx9", "1e9x1", "4x3x2"}) {
    EXPECT_FALSE(parse_picture_size(bad)) << bad;
  }
}

TEST(ExchangeLandmarks, TablesThatAreNone) {
  EXPECT_FALSE(is_landmark_table(""));
  EXPECT_FALSE(is_landmark_table("time_s,jawOpen,jawLeft\n"));
  EXPECT_FALSE(is_landmark_table("x_0,y_0,x_0,y_0\n"));
  EXPECT_TRUE(
      is_landmark_table("\xEF\xBB\xBF"
                        "8.1_x;8.2_x;8.3_x;NASION_Y\r\n"));
}

TEST(ExchangeLandmarks, HostileTables) {
  const std::string good = sixty_eight(3, plain_name);
  const std::string head = good.substr(0, good.find('\n') + 1);
  std::string huge = good;
  huge.replace(huge.find('\n') + 1, 3, "1e308");
  const struct {
    std::string text;
    Code code;
    const char* what;
  } cases[] = {
      {"", Code::truncated, "empty"},
      {head, Code::truncated, "no row after the header"},
      {"x_999999,y_999999\n1,2\n", Code::not_found, "no column"},
      {"x0,y0,x1\n1,2,3\n", Code::not_found, "2 numbered points are not a known layout"},
      {"8.1_x,8.1_y,8.2_x\n1,2,3\n", Code::not_found, "8.2 has no column for its y"},
      {"8.1_x,8.1_y,FP8.1_X\n1,2,3\n", Code::syntax, "twice"},
      {"8.1_x,8.1_y\n1,two\n", Code::syntax, "8.1_y is 'two', which is not a number"},
      {"8.1_x,8.1_y\n1\n", Code::syntax, "1 fields where the header has 2"},
      {"time,8.1_x,8.1_y\nnow,1,2\n", Code::syntax, "time is 'now', which is not a time"},
      {"face_id,8.1_x,8.1_y\nnan,1,2\n", Code::truncated, "no row"},
      {"time,8.1_x,8.1_y\n1e308,1,2\n-1e308,1,2\n", Code::out_of_range, "goes back"},
  };
  LandmarkTableOptions options;
  options.rate = fap::Rate{25, 1};
  for (const auto& one : cases) {
    const auto table = read_landmark_table(one.text, options);
    ASSERT_FALSE(table) << one.text;
    EXPECT_EQ(table.error().code, one.code) << one.text << table.error().describe();
    EXPECT_THAT(table.error().message, HasSubstr(one.what)) << one.text;
  }
  EXPECT_EQ(read_landmark_table(good).error().code, Code::invalid_argument) << "no times, no rate";
  options.rate = fap::Rate{0, 0};
  EXPECT_EQ(read_landmark_table(good, options).error().code, Code::invalid_argument);
  options.rate = fap::Rate{25, 1};
  options.face = 3;
  const auto other = read_landmark_table("face_id,8.1_x,8.1_y\n1,1,2\n", options);
  EXPECT_EQ(other.error().code, Code::not_found);
  // Points that are far away or not seen at all give an error or a face, never a crash.
  LandmarkImportOptions import;
  import.table.rate = fap::Rate{25, 1};
  import.neutral = "0-2";
  const auto far = import_landmarks(huge, import);
  ASSERT_TRUE(far) << far.error().describe();
  EXPECT_EQ(far->face.clip.frames.size(), 3U) << "a corner of the jaw gives no FAP";
  std::string farther = head;
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 136; ++i) farther += i == 135 ? "-1e308\n" : "1e308;";
  }
  EXPECT_FALSE(import_landmarks(farther, import));
  std::string blind = head;
  for (int i = 0; i < 3; ++i) blind += std::string(135, ';') + "\n";
  EXPECT_FALSE(import_landmarks(blind, import));
}

}  // namespace landmarks_test
}  // namespace animeme::exchange
