// The lips of the head that a stream shows: shut where the sentence wants them shut.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dam/phones.h"
#include "dam/script.h"
#include "fap/fill.h"
#include "fap/head/rig.h"
#include "fap/text.h"
#include "tests/support/program.h"

namespace animeme {
namespace {

using test::animeme;
using test::TempDir;

// Largest distance between the lips, cm, over the middle half of the mouth.
float widest_gap(const head::Rig& rig, const head::Pose& pose) {
  const auto& skin = pose.positions[std::size_t(head::Part::skin)];
  float gap = 0;
  for (std::size_t i = rig.lips.size() / 4; i < rig.lips.size() * 3 / 4; ++i) {
    gap = std::max(gap, length(skin[rig.lips[i].upper] - skin[rig.lips[i].lower]));
  }
  return gap;
}

TEST(Lips, OfTheHeadMeetInEveryPBM) {
  const TempDir dir;
  const auto made =
      animeme({"speak", "--text", "My baby mumbles about a purple apple pie, and Pam may hum.",
               "--rate", "50", "-o", dir / "talk.fap", "--save-script", dir / "talk.TextGrid"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto clip = fap::read_text(test::slurp(dir / "talk.fap"));
  const auto script = dam::read_script(test::slurp(dir / "talk.TextGrid"));
  ASSERT_TRUE(clip);
  ASSERT_TRUE(script);
  for (const std::string_view name : head::kHeadNames) {
    const auto made_head = head::make_head(*head::head_parameters(name));
    const head::Rig rig = head::make_rig(*made_head);
    std::vector<float> gaps;
    for (const fap::Frame& frame : clip->frames) {
      gaps.push_back(widest_gap(rig, head::pose(rig, frame)));
    }
    int closures = 0;
    float widest = 0;
    for (const dam::Phone& phone : script->phones) {
      const dam::PhoneInfo* info = dam::find_phone(phone.label);
      if (info == nullptr || !info->bilabial) continue;
      ++closures;
      float least = 10;
      for (std::size_t i = 0; i < gaps.size(); ++i) {
        const double time = clip->rate.seconds(double(clip->frames[i].number));
        const bool during = time > phone.start - 0.02 && time < phone.end + 0.02;
        if (during) least = std::min(least, gaps[i]);
      }
      EXPECT_LT(least, 1e-4f) << name << ": " << phone.label << " of " << phone.word << " at "
                              << phone.start << " s";
      widest = std::max(widest, least);
    }
    EXPECT_GT(closures, 10);
    EXPECT_GT(*std::max_element(gaps.begin(), gaps.end()), 0.4f) << "the mouth opens";
  }
}

}  // namespace
}  // namespace animeme
