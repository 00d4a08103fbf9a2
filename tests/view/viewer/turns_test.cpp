// The page eases turns as the library does.
#include "fap/turns.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/readers/scripts.h"
#include "tests/support/folders.h"

namespace animeme::test {
namespace page_turns_test {

TEST(PageTurns, AreThoseOfTheLibrary) {
  if (!has_node()) GTEST_SKIP() << "node 18 or later is not installed (Debian package nodejs)";
  fap::Sequence clip;
  std::string values;
  for (int i = 0; i < 240; ++i) {
    fap::Frame frame;
    frame.number = i;
    const double turn = 2500 * std::sin(0.02 * i) + 900 * std::sin(0.3 * i) * (i > 120 ? 1 : 0);
    frame.set(49, 170 * int(std::lround(turn / 170)));
    clip.frames.push_back(frame);
    values += " " + std::to_string(frame.value[49]);
  }
  const Json report = run_json("node '" + std::string(test::kSourceFolder) +
                               "/tests/view/viewer/js/turns_report.mjs'" + values);
  ASSERT_EQ(report["clip"].size(), clip.frames.size());
  fap::TurnSmoother turns;
  fap::Sequence eased = clip;
  smooth_turns(eased);
  double moved = 0;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    EXPECT_NEAR(report["clip"][i].get<double>(), eased.frames[i].value[49], 1) << i;
    EXPECT_NEAR(report["stream"][i].get<double>(), turns.next(clip.frames[i]).value[49], 1) << i;
    moved = std::max(moved, std::abs(double(eased.frames[i].value[49] - clip.frames[i].value[49])));
  }
  EXPECT_GT(moved, 40);
}

}  // namespace page_turns_test
}  // namespace animeme::test
