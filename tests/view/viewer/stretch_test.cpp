// Sound at other speeds: its pitch, its level, no clicks, and everything where it belongs.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/readers/scripts.h"
#include "tests/support/folders.h"

namespace animeme::test {
namespace stretch_test {

TEST(Stretch, KeepsPitchLevelAndPlace) {
  if (!has_node()) GTEST_SKIP() << "node 18 or later is not installed (Debian package nodejs)";
  const Json report = run_json("node '" + std::string(test::kSourceFolder) +
                               "/tests/view/viewer/js/stretch_report.mjs'");
  ASSERT_TRUE(report.contains("tones"));
  EXPECT_EQ(report["tones"].size(), 6u);
  for (const auto& [speed, tone] : report["tones"].items()) {
    EXPECT_NEAR(tone["pitch"].get<double>(), 220, 1) << speed;
    EXPECT_NEAR(tone["level"].get<double>(), 1, 0.02) << speed;
    EXPECT_LT(tone["jump"].get<double>(), 1.1) << speed;
  }
  for (const auto& [speed, bursts] : report["bursts"].items()) {
    ASSERT_EQ(bursts.size(), 3u) << speed;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(bursts[i].get<double>(), 0.5 * double(i + 1), 0.02) << speed;
    }
  }
}

TEST(Stretch, JoinsTheEndsOfALoop) {
  if (!has_node()) GTEST_SKIP() << "node 18 or later is not installed (Debian package nodejs)";
  const Json report = run_json("node '" + std::string(test::kSourceFolder) +
                               "/tests/view/viewer/js/stretch_report.mjs'");
  ASSERT_TRUE(report.contains("loop"));
  const Json& loop = report["loop"];
  EXPECT_NEAR(loop["pitch"].get<double>(), 220, 1);
  EXPECT_LT(loop["jump"].get<double>(), 1.1);
  ASSERT_EQ(loop["bursts"].size(), 2u);
  EXPECT_NEAR(loop["bursts"][0].get<double>(), 1, 0.02);
  EXPECT_NEAR(loop["bursts"][1].get<double>(), 3, 0.02);
}

}  // namespace stretch_test
}  // namespace animeme::test
