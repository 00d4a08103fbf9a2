#include "fap/tables.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/shared.h"

namespace animeme::fap {
namespace tables_test {

TEST(Tables, GroupsCoverAllFapsInOrder) {
  const int sizes[kGroupCount] = {2, 16, 12, 8, 4, 5, 3, 10, 4, 4};
  int next = 1;
  for (int group = 0; group < kGroupCount; ++group) {
    EXPECT_EQ(kGroups[std::size_t(group)].first, next);
    EXPECT_EQ(kGroups[std::size_t(group)].size, sizes[group]);
    for (int i = 0; i < sizes[group]; ++i) EXPECT_EQ(info(next++).group, group + 1);
  }
  EXPECT_EQ(next, kFapCount + 1);
}

TEST(Tables, KnownRows) {
  const FapInfo& jaw = info(3);
  EXPECT_EQ(jaw.name, "open_jaw");
  EXPECT_EQ(jaw.unit, Unit::mns);
  EXPECT_EQ(jaw.motion, Motion::down);
  EXPECT_TRUE(jaw.unidirectional);
  EXPECT_EQ(jaw.quant_step, 4);
  EXPECT_EQ(jaw.feature_point, "2.1");
  EXPECT_EQ(info(48).name, "head_pitch");
  EXPECT_EQ(info(48).quant_step, 170);
  EXPECT_EQ(info(47).unit, Unit::angle);
  EXPECT_EQ(info(68).name, "pull_r_ear");
  EXPECT_EQ(find_fap("open_jaw"), 3);
  EXPECT_EQ(find_fap("pull_r_ear"), 68);
  EXPECT_EQ(find_fap("Open_Jaw"), std::nullopt);
  EXPECT_EQ(find_fap(""), std::nullopt);
}

TEST(Tables, Sums) {
  int steps = 0;
  int units[7] = {};
  for (const FapInfo& fap : kFaps) {
    if (fap.number >= kFirstLowLevel) steps += fap.quant_step;
    ++units[std::size_t(fap.unit)];
  }
  // Four eyeball angles of 128, three head angles of 170, 512 for the tongue roll, 4 for the jaw,
  // 30 steps of 2 and 27 of 1.
  EXPECT_EQ(steps, 4 * 128 + 3 * 170 + 512 + 4 + 30 * 2 + 27);
  EXPECT_EQ(units[std::size_t(Unit::none)], 2);
  EXPECT_EQ(units[std::size_t(Unit::angle)], 8);
  EXPECT_EQ(units[std::size_t(Unit::irisd)], 6);
  EXPECT_EQ(units[std::size_t(Unit::mw)], 7);
}

TEST(Tables, NumbersAndNamesAreUnique) {
  std::set<std::string_view> names;
  for (int number = 1; number <= kFapCount; ++number) {
    EXPECT_EQ(info(number).number, number);
    EXPECT_TRUE(names.insert(info(number).name).second) << info(number).name;
  }
}

Motion mirrored(Motion motion) {
  if (motion == Motion::left) return Motion::right;
  if (motion == Motion::right) return Motion::left;
  return motion;
}

TEST(Tables, MirrorPairsAreSymmetric) {
  int pairs = 0;
  for (const FapInfo& fap : kFaps) {
    if (fap.mirror == 0) continue;
    const FapInfo& other = info(fap.mirror);
    pairs += fap.number < other.number;
    EXPECT_EQ(other.mirror, fap.number) << fap.name;
    EXPECT_EQ(other.unit, fap.unit) << fap.name;
    EXPECT_EQ(other.quant_step, fap.quant_step) << fap.name;
    EXPECT_EQ(other.group, fap.group) << fap.name;
    EXPECT_EQ(other.default_i_range, fap.default_i_range) << fap.name;
    // Both eyeballs turn left for positive yaw; all other directions are mirror images.
    const bool yaw = fap.number == 23 || fap.number == 24;
    EXPECT_EQ(other.motion, yaw ? fap.motion : mirrored(fap.motion)) << fap.name;
  }
  EXPECT_EQ(pairs, 23);
}

TEST(Tables, LipPartnersAreSymmetric) {
  int pairs = 0;
  for (const FapInfo& fap : kFaps) {
    if (fap.partner == 0) continue;
    const FapInfo& other = info(fap.partner);
    pairs += fap.number < other.number;
    EXPECT_EQ(other.partner, fap.number) << fap.name;
    EXPECT_EQ(other.motion, fap.motion) << fap.name;
    EXPECT_EQ(other.unit, fap.unit) << fap.name;
    EXPECT_EQ(std::string(fap.name) + "_o",
              other.number > fap.number ? std::string(other.name) : std::string(fap.name) + "_o");
  }
  EXPECT_EQ(pairs, 10);
}

TEST(Tables, VisemesExpressionsAndFeaturePoints) {
  EXPECT_EQ(kVisemes[0].name, "sil");
  EXPECT_EQ(kVisemes[14].morph, "viseme_U");
  EXPECT_EQ(kExpressions[3], "anger");
  std::map<std::string, int> per_group;
  std::set<std::string_view> ids;
  for (const FeaturePointInfo& point : kFeaturePoints) {
    ++per_group[std::string(point.id.substr(0, point.id.find('.')))];
    EXPECT_TRUE(ids.insert(point.id).second) << point.id;
  }
  const std::map<std::string, int> expected = {{"2", 14},  {"3", 14}, {"4", 6},  {"5", 4},
                                               {"6", 4},   {"7", 1},  {"8", 10}, {"9", 15},
                                               {"10", 10}, {"11", 6}};
  EXPECT_EQ(per_group, expected);
}

// Rows of a CSV file by column name; fields may be quoted.
using Row = std::map<std::string, std::string>;

std::vector<std::string> split_csv(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside = false;
  for (const char c : line) {
    if (c == '"') {
      inside = !inside;
    } else if (c == ',' && !inside) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

std::vector<Row> read_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  std::string line;
  std::getline(file, line);
  const std::vector<std::string> names = split_csv(line);
  std::vector<Row> rows;
  while (std::getline(file, line)) {
    const std::vector<std::string> fields = split_csv(line);
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < fields.size() && i < names.size(); ++i) row[names[i]] = fields[i];
  }
  return rows;
}

class SpecTables : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::shared_dir().empty()) GTEST_SKIP() << "no reference data (ANIMEME_SHARED)";
    dir_ = test::shared_dir() / "spec" / "tables";
  }
  std::filesystem::path dir_;
};

int number_or_zero(const std::string& field) { return field.empty() ? 0 : std::stoi(field); }

const char* name_of(Motion motion) {
  const char* names[] = {"na",    "down",    "up",      "left",
                         "right", "forward", "growing", "concave upward"};
  return names[std::size_t(motion)];
}

TEST_F(SpecTables, FapTableEqualsTheSpecification) {
  const std::vector<Row> rows = read_csv(dir_ / "fap_semantics.csv");
  ASSERT_EQ(rows.size(), std::size_t(kFapCount));
  for (const Row& row : rows) {
    const FapInfo& fap = info(std::stoi(row.at("number")));
    const std::string point = row.at("fdp_subgroup") == "na" ? "" : row.at("fdp_subgroup");
    EXPECT_EQ(fap.name, row.at("name"));
    EXPECT_EQ(fap.unit == Unit::none ? "na" : unit_name(fap.unit), row.at("fapu")) << fap.name;
    EXPECT_EQ(name_of(fap.motion), row.at("positive_motion")) << fap.name;
    EXPECT_EQ(fap.unidirectional, row.at("direction") == "unidirectional") << fap.name;
    EXPECT_EQ(fap.group, std::stoi(row.at("group"))) << fap.name;
    EXPECT_EQ(fap.feature_point, point) << fap.name;
    EXPECT_EQ(fap.quant_step, std::stoi(row.at("quant_step"))) << fap.name;
    EXPECT_EQ(fap.mirror, number_or_zero(row.at("mirror_fap"))) << fap.name;
    EXPECT_EQ(fap.partner, number_or_zero(row.at("inner_outer_fap"))) << fap.name;
    // The decoder's ranges are kept for FAP 47, see tables.cpp.
    if (fap.number == 47) continue;
    EXPECT_EQ(fap.default_i_range, std::stoi(row.at("i_max"))) << fap.name;
    EXPECT_EQ(fap.default_p_range, std::stoi(row.at("p_max"))) << fap.name;
  }
}

TEST_F(SpecTables, DefaultRangesEqualTheDecoders) {
  const std::vector<Row> rows = read_csv(dir_ / "fap_table.csv");
  ASSERT_FALSE(rows.empty());
  int checked = 0;
  for (const Row& row : rows) {
    const FapInfo& fap = info(std::stoi(row.at("fap_number")));
    if (fap.number < kFirstLowLevel) continue;
    EXPECT_EQ(fap.default_i_range, std::stoi(row.at("src_default_i_max"))) << fap.name;
    EXPECT_EQ(fap.default_p_range, std::stoi(row.at("src_default_p_max"))) << fap.name;
    ++checked;
  }
  EXPECT_EQ(checked, kLowLevelCount);
}

TEST_F(SpecTables, PairsEqualTheSpecification) {
  const std::vector<Row> rows = read_csv(dir_ / "fap_left_right_pairs.csv");
  ASSERT_EQ(rows.size(), 23u);
  for (const Row& row : rows) {
    EXPECT_EQ(info(std::stoi(row.at("fap_left"))).mirror, std::stoi(row.at("fap_right")));
    EXPECT_EQ(info(std::stoi(row.at("fap_left"))).name, row.at("name_left"));
  }
}

TEST_F(SpecTables, FeaturePointsEqualTheSpecification) {
  const std::vector<Row> rows = read_csv(dir_ / "feature_points.csv");
  ASSERT_EQ(rows.size(), kFeaturePoints.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(kFeaturePoints[i].id, rows[i].at("feature_point"));
    EXPECT_EQ(kFeaturePoints[i].name, rows[i].at("name"));
  }
}

TEST_F(SpecTables, VisemesAndExpressionsEqualTheSpecification) {
  const std::vector<Row> visemes = read_csv(dir_ / "mpeg4_viseme_names.csv");
  ASSERT_EQ(visemes.size(), kVisemes.size());
  for (std::size_t i = 0; i < visemes.size(); ++i) {
    EXPECT_EQ(visemes[i].at("viseme_select"), std::to_string(i));
    EXPECT_EQ(visemes[i].at("visage_name"), kVisemes[i].name);
    EXPECT_EQ(visemes[i].at("oculus_readyplayerme_name"), kVisemes[i].morph);
  }
  const std::vector<Row> phonemes = read_csv(dir_ / "visemes.csv");
  ASSERT_EQ(phonemes.size(), kVisemes.size());
  for (std::size_t i = 1; i < phonemes.size(); ++i) {
    EXPECT_EQ(phonemes[i].at("phonemes"), kVisemes[i].phonemes);
  }
  const std::vector<Row> expressions = read_csv(dir_ / "expressions.csv");
  ASSERT_EQ(expressions.size(), kExpressions.size());
  for (std::size_t i = 1; i < expressions.size(); ++i) {
    EXPECT_EQ(expressions[i].at("name"), kExpressions[i]);
  }
}

}  // namespace tables_test
}  // namespace animeme::fap
