// A model and curves for another face, by a table of poses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/corpus/corpus.h"
#include "tests/app/program/commands.h"
#include "tools/formats/exchange/pose_table.h"

namespace animeme::test {
namespace retarget_test {

using ::testing::HasSubstr;

dam::Poses read_poses(const std::string& path) {
  const auto poses = exchange::read_pose_table(slurp(path));
  EXPECT_TRUE(poses) << poses.error().describe();
  return poses ? *poses : dam::Poses{};
}

dam::Signal spoken(const TempDir& dir, const std::string& model) {
  // Roundness is added to FAPs as they are, not to what the model has learned.
  succeeds({"speak", "--text", "Papa moved very far.", "--model", model, "--articulate", "0", "-o",
            dir / "out.csv"});
  const auto signal = dam::read_curves(slurp(dir / "out.csv"));
  EXPECT_TRUE(signal) << signal.error().describe();
  return signal ? *signal : dam::Signal{};
}

std::size_t column(const std::vector<std::string>& names, const std::string& name) {
  return std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
}

// The jaw of the other face goes from 0 to 100 the other way, its lips twice as far.
std::string other_poses(const dam::Poses& own) {
  dam::Poses other = own;
  other.names[0] = "Jaw";
  for (std::size_t p = 0; p < own.labels.size(); ++p) {
    for (std::size_t c = 0; c < own.names.size(); ++c) {
      other.values[p * own.names.size() + c] = c == 0 ? 50 - 0.2 * own.at(p, c) : 2 * own.at(p, c);
    }
  }
  return exchange::write_pose_table(other);
}

TEST(Retarget, AModelSpeaksAsTheOtherFace) {
  const TempDir dir;
  succeeds({"retarget", "builtin", "--save-poses", dir / "own.csv"});
  const dam::Poses own = read_poses(dir / "own.csv");
  ASSERT_EQ(own.names[0], "fap3_open_jaw");
  spill(dir / "other.csv", other_poses(own));
  const Json json = json_of({"retarget", "builtin", dir / "other.csv", "-o", dir / "other.dam",
                             "--rename", "fap3_open_jaw=Jaw"});
  EXPECT_EQ(json["controls"][0]["name"], "Jaw");
  EXPECT_NEAR(double(json["controls"][0]["gain"]), -0.2, 1e-5);
  EXPECT_NEAR(double(json["controls"][0]["offset"]), 50, 1e-3);
  EXPECT_EQ(json["controls"][0]["from"], "poses");
  const dam::Signal before = spoken(dir, "builtin"), after = spoken(dir, dir / "other.dam");
  ASSERT_EQ(before.frames(), after.frames());
  EXPECT_EQ(after.names[0], "Jaw");
  const std::size_t corner = column(after.names, "fap6_stretch_l_cornerlip");
  double moved = 0;
  for (std::size_t i = 0; i < before.frames(); ++i) {
    EXPECT_NEAR(after.at(i, 0), 50 - 0.2 * before.at(i, 0), 0.01);
    EXPECT_NEAR(after.at(i, corner), 2 * before.at(i, corner), 0.01);
    moved = std::max(moved, before.at(i, 0));
  }
  EXPECT_GT(moved, 100);
}

TEST(Retarget, CurvesOfOneFaceBecomeThoseOfAnother) {
  const TempDir dir;
  spill(dir / "take.csv", "time_s,jaw,smile,brow\n0,0,0,1\n0.04,1,0.5,1\n0.08,0.5,1,2\n");
  spill(dir / "mine.csv", "pose;brow;jaw;smile\nneutral;1;0;0\nwide;1;1;0\ngrin;1;0;1\n");
  spill(dir / "hers.csv", "pose,jaw,smile,snout\nGrin,5,90,1\nneutral,5,10,1\nwide,25,,1\n");
  const auto result = animeme({"retarget", dir / "take.csv", dir / "hers.csv", "--from",
                               dir / "mine.csv", "-o", dir / "hers_take.csv"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("there is no control snout"));
  EXPECT_THAT(result.err, HasSubstr("they stay unchanged: brow"));
  const auto curves = dam::read_curves(slurp(dir / "hers_take.csv"));
  ASSERT_TRUE(curves) << curves.error().describe();
  const std::vector<double> wanted = {5, 10, 1, 25, 50, 1, 15, 90, 2};
  ASSERT_EQ(curves->values.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(curves->values[i], wanted[i], 1e-9);
}

TEST(Retarget, SaysWhatIsWrongAndWritesNothing) {
  const TempDir dir;
  spill(dir / "smile.csv", "pose,fap3_open_jaw\nrest,0\nsmile,3\n");
  spill(dir / "text.csv", "pose,fap3_open_jaw\nrest,0\nAA,much\n");
  spill(dir / "jaw.csv", "pose,jawOpen\nrest,0\nAA,1\n");
  const auto message = [&](std::vector<std::string> arguments, int code) {
    arguments.insert(arguments.begin(), "retarget");
    const auto result = animeme(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    return result.err;
  };
  const std::string out = dir / "out.dam";
  EXPECT_THAT(message({"builtin", dir / "smile.csv", "-o", out}, 3),
              HasSubstr("smile.csv: 'smile' is not a phone"));
  EXPECT_THAT(message({"builtin", dir / "text.csv", "-o", out}, 3), HasSubstr("text.csv:3:4"));
  EXPECT_THAT(message({"builtin", dir / "jaw.csv", "-o", out}, 3),
              HasSubstr("no control in common"));
  EXPECT_THAT(message({"builtin", dir / "jaw.csv", "-o", out, "--rename", "jaw=jawOpen"}, 2),
              HasSubstr("there is no such control"));
  EXPECT_THAT(message({"builtin", dir / "jaw.csv", "-o", dir / "out.csv"}, 2),
              HasSubstr("the result of a model is a model"));
  EXPECT_THAT(message({"builtin"}, 2), HasSubstr("--save-poses"));
  EXPECT_THAT(message({dir / "jaw.csv", dir / "jaw.csv", "-o", dir / "out.csv"}, 2),
              HasSubstr("--from"));
  EXPECT_EQ(dir.count(), 3u);
}

}  // namespace retarget_test
}  // namespace animeme::test
