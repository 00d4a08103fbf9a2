// FAP text of what is received, when planes are missing.
#include "tools/live/sessions/receive_output.h"

#include <gtest/gtest.h>

#include "codec/decode/access_unit.h"
#include "codec/encode/encode.h"
#include "fap/text.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tests/support/temp_dir.h"

namespace animeme {
namespace receive_output_test {

// Numbers of the frames that are written of 30 planes, with further intra planes, of which 12 to 17
// are lost, and with them what follows up to the next intra plane.
std::vector<std::int64_t> numbers(const live::FapOutputOptions& options) {
  const test::TempDir dir;
  fap::Sequence clip = test::random_clip(6, 30);
  clip.rate = {25, 1};
  fba::EncodeOptions coding;
  coding.intra_seconds = 0.4;
  const auto stream = fba::encode(clip, coding);
  const auto units = fba::split_access_units(*stream);
  live::FapOutput output(dir / "x.fap", options);
  bool lost = false;
  for (std::size_t i = 0; i < units->units.size(); ++i) {
    const fba::AccessUnit& unit = units->units[i];
    if ((i >= 12 && i <= 17) || (lost && !unit.intra)) {
      lost = true;
      continue;
    }
    media::LiveUnit live;
    live.bytes = unit.bytes;
    live.time = unit.time;
    const auto text = output.push(live, units->timescale, lost);
    EXPECT_TRUE(text) << text.error().describe();
    lost = false;
  }
  EXPECT_TRUE(output.finish());
  const auto written = fap::read_text(test::slurp(dir / "x.fap"), {.keep_numbers = true});
  EXPECT_TRUE(written);
  std::vector<std::int64_t> all;
  for (const fap::Frame& frame : written->frames) all.push_back(frame.number);
  return all;
}

TEST(ReceivedText, SkipsFramesWithoutGapsInTheNumbers) {
  const auto skipped = numbers({.gap = media::GapRule::skip});
  ASSERT_GT(skipped.size(), 12u);
  ASSERT_LT(skipped.size(), 25u);
  for (std::size_t i = 0; i < skipped.size(); ++i) EXPECT_EQ(skipped[i], std::int64_t(i));
  const auto exact = numbers({.gap = media::GapRule::skip, .exact = true});
  EXPECT_EQ(exact.size(), skipped.size());
  EXPECT_EQ(exact.back(), 29);
  EXPECT_EQ(exact[11], 11);
  EXPECT_GE(exact[12], 18);
  EXPECT_EQ(numbers({.gap = media::GapRule::hold}).size(), 30u);
}

}  // namespace receive_output_test
}  // namespace animeme
