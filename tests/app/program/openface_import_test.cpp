// `animeme import` of what OpenFace writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/landmark_tables.h"

namespace animeme {
namespace openface_import_test {

using test::animeme;
using test::expect_faps;
using test::import;
using test::Imported;
using test::openface;
using test::spill;
using test::TempDir;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(ImportOpenFace, PointsInSpace) {
  const Imported take = import(openface(20), {"--neutral", "0", "--smooth", "0", "--no-repair"});
  EXPECT_EQ(take.clip.rate, (fap::Rate{30, 1}));
  EXPECT_EQ(take.clip.frames.size(), 19U);  // without the row that failed
  EXPECT_EQ(take.clip.frames[5].number, 6);
  expect_faps(take.clip, {3, 4, 5, 12, 13, 14, 19, 20, 31, 32, 48, 49, 50, 53, 60, 63}, 1);
  EXPECT_FALSE(take.clip.frames[0].mask[18]);
  EXPECT_THAT(take.talk, AllOf(HasSubstr("points in space"), HasSubstr("given in 1 frame, 0"),
                               HasSubstr("rows with low confidence, skipped: 1"),
                               HasSubstr("1 frames skipped"), Not(HasSubstr("not landmarks"))));
}

TEST(ImportOpenFace, RoundsToTenthsOfAMillimetre) {
  // A tenth of a millimetre is 5 units of MNS (2.1 cm); the fit of the head adds to it.
  const Imported take = import(openface(20, 1), {"--neutral", "0", "--smooth", "0"});
  expect_faps(take.clip, {3, 4, 5, 12, 13, 48, 49, 50}, 12);
}

TEST(ImportOpenFace, GazeIsAgainstTheHead) {
  const Imported take = import(openface(4), {"--neutral", "0", "--smooth", "0"});
  for (const fap::Frame& frame : take.clip.frames) {
    // The eyes keep their place in space while the head turns to the right.
    EXPECT_NEAR(frame.value[24], 1100.0 * double(frame.number), 100);
    EXPECT_NEAR(frame.value[23], 1100.0 * double(frame.number), 100);
    EXPECT_NEAR(frame.value[26], -900.0 * double(frame.number), 100);
  }
}

TEST(ImportOpenFace, InThePicture) {
  // Of heads that do not turn; the pose columns tell the pitch all the same.
  std::string table = openface(20);
  const Imported take = import(table, {"--flat", "--neutral", "0s", "--smooth", "0"});
  EXPECT_THAT(take.talk, HasSubstr("points in the picture"));
  EXPECT_FALSE(take.clip.frames[0].mask[14]);
  for (const fap::Frame& frame : take.clip.frames) {
    EXPECT_NEAR(frame.value[48], 900.0 * double(frame.number), 1);
    EXPECT_EQ(frame.value[49], 0);
  }
}

TEST(ImportOpenFace, OtherCommandsReadTheSameTables) {
  const TempDir dir;
  spill(dir / "take.csv", openface(30, 7, -1));
  ASSERT_EQ(animeme({"import", dir / "take.csv", "--exact", "-o", dir / "take.fap"}).exit_code, 0);
  const auto direct = animeme({"encode", dir / "take.csv", "-o", dir / "a.fba"});
  ASSERT_EQ(direct.exit_code, 0) << direct.err;
  ASSERT_EQ(animeme({"encode", dir / "take.fap", "-o", dir / "b.fba"}).exit_code, 0);
  EXPECT_EQ(test::slurp(dir / "a.fba"), test::slurp(dir / "b.fba"));
}

}  // namespace openface_import_test
}  // namespace animeme
