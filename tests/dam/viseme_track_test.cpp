// Speech as FAP 1: contacts are made, the motion is followed, nothing jumps.
#include "dam/speaking/viseme_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dam/model/builtin.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "fap/viseme.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace viseme_track_test {

using test::script_of;

// "bob meets five ..." with short and long sounds, diphthongs and HH.
Script sentence() {
  return script_of({{"SIL", 0.2},
                    {"B", 0.08},
                    {"AA", 0.16},
                    {"B", 0.06},
                    {"M", 0.07},
                    {"IY", 0.12},
                    {"T", 0.05},
                    {"S", 0.09},
                    {"F", 0.1},
                    {"AY", 0.2},
                    {"V", 0.06},
                    {"HH", 0.07},
                    {"UW", 0.15},
                    {"L", 0.06},
                    {"P", 0.09},
                    {"S", 0.1},
                    {"SIL", 0.3}});
}

fap::Sequence clip_of(const Script& script, fap::Rate rate) {
  const auto signal = synthesise(*builtin_model(), script, {.rate = rate});
  EXPECT_TRUE(signal) << (signal ? "" : signal.error().describe());
  auto clip = to_sequence(*signal);
  EXPECT_TRUE(clip);
  return *clip;
}

double weight(const fap::Viseme& viseme, int number) {
  return fap::coded_viseme(viseme)[std::size_t(number)];
}

// What is shown by fap/viseme.h.
double shown(const fap::Viseme& viseme, int fap) {
  const auto weights = fap::coded_viseme(viseme);
  double sum = 0;
  for (int v = 0; v < fap::kVisemeCount; ++v) {
    sum += weights[std::size_t(v)] * fap::viseme_shape(v).value[std::size_t(fap)];
  }
  return sum;
}

class AtRate : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Rates, AtRate, ::testing::Values(25u, 30u, 60u));

TEST_P(AtRate, ContactsAreShownInFull) {
  const Script script = sentence();
  const fap::Sequence clip = clip_of(script, {GetParam(), 1});
  const auto track = viseme_track(script, clip);
  ASSERT_EQ(track.size(), clip.frames.size());
  for (const Phone& phone : script.phones) {
    const PhoneInfo* info = find_phone(phone.label);
    if (!info->bilabial && !info->labiodental) continue;
    const auto at = std::size_t(std::lround((phone.start + phone.end) / 2 * GetParam()));
    EXPECT_EQ(weight(track[at], info->viseme_start), 1) << phone.label << " at " << phone.start;
  }
}

TEST_P(AtRate, SoundsAreThoseThatAreSpokenThere) {
  const Script script = sentence();
  const fap::Sequence clip = clip_of(script, {GetParam(), 1});
  const auto track = viseme_track(script, clip);
  for (std::size_t i = 0; i < track.size(); ++i) {
    EXPECT_GE(track[i].select1, 0);
    EXPECT_LE(track[i].select1, 14);
    EXPECT_NE(track[i].select1, track[i].select2);
    EXPECT_GE(track[i].blend, 0);
    EXPECT_LE(track[i].blend, 63);
    EXPECT_FALSE(track[i].def);
  }
  EXPECT_EQ(weight(track.front(), 0), 1);
  EXPECT_EQ(weight(track.back(), 0), 1);
}

// Also where the lips of the model are less round than those of the table: no N stands for a UW.
TEST_P(AtRate, LongSoundsAreShownByTheirOwnVisemes) {
  const Script script = script_of({{"SIL", 0.2},
                                   {"S", 0.1},
                                   {"UW", 0.18},
                                   {"N", 0.08},
                                   {"IH", 0.12},
                                   {"Z", 0.08},
                                   {"F", 0.1},
                                   {"UW", 0.2},
                                   {"L", 0.08},
                                   {"OW", 0.2},
                                   {"T", 0.08},
                                   {"AA", 0.2},
                                   {"SIL", 0.3}});
  const auto track = viseme_track(script, clip_of(script, {GetParam(), 1}));
  for (const Phone& phone : script.phones) {
    const PhoneInfo* info = find_phone(phone.label);
    if (info->viseme_start == 0 || phone.duration() < 0.15) continue;
    const auto at = std::size_t(std::lround((phone.start + phone.end) / 2 * GetParam()));
    double own = weight(track[at], info->viseme_start);
    if (info->viseme_end != info->viseme_start) own += weight(track[at], info->viseme_end);
    EXPECT_GE(own, 0.6) << phone.label << " at " << phone.start;
  }
}

// The jaw as it is shown follows the jaw of the clip, and takes no larger steps than a border
// between two shapes asks for.
TEST_P(AtRate, TheMotionIsFollowedWithoutJumps) {
  const Script script = sentence();
  const fap::Sequence clip = clip_of(script, {GetParam(), 1});
  const auto track = viseme_track(script, clip);
  const double rest = clip.frames.front().value[5];
  double dot = 0, a2 = 0, b2 = 0, steps = 0, wanted_steps = 0;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const double a = shown(track[i], 5), b = clip.frames[i].value[5] - rest;
    dot += a * b;
    a2 += a * a;
    b2 += b * b;
    if (i == 0) continue;
    steps = std::max(steps, std::abs(a - shown(track[i - 1], 5)));
    wanted_steps = std::max(wanted_steps, std::abs(b - (clip.frames[i - 1].value[5] - rest)));
  }
  EXPECT_GT(dot / std::sqrt(a2 * b2), 0.85);
  EXPECT_LT(steps, std::max(3 * wanted_steps, 120.0));
}

TEST(VisemeTrack, TakesThePlaceOfTheMouth) {
  const Script script = sentence();
  fap::Sequence clip = clip_of(script, {25, 1});
  for (fap::Frame& frame : clip.frames) frame.set(19, 300);
  fap::Sequence beside = clip;
  show_visemes(script, clip, VisemePlace::instead);
  show_visemes(script, beside, VisemePlace::beside);
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    EXPECT_TRUE(clip.frames[i].mask[1] && clip.frames[i].mask[19]);
    EXPECT_EQ(clip.frames[i].mask.count(), 2u);
    EXPECT_EQ(clip.frames[i].value[3], 0);
    EXPECT_TRUE(beside.frames[i].mask[1] && beside.frames[i].mask[3]);
    EXPECT_EQ(beside.frames[i].viseme, clip.frames[i].viseme);
  }
}

TEST(VisemeTrack, OddScripts) {
  EXPECT_TRUE(viseme_track(sentence(), {}).empty());
  fap::Sequence clip{{25, 1}, std::vector<fap::Frame>(5), ""};
  for (std::size_t i = 0; i < 5; ++i) clip.frames[i].number = std::int64_t(i);
  for (const Script& script : {Script{}, script_of({{"SIL", 0.2}}), script_of({{"HH", 0.2}}),
                               script_of({{"AA", 0.01}}), script_of({{"P", 90.0}})}) {
    EXPECT_EQ(viseme_track(script, clip).size(), 5u);
  }
}

}  // namespace viseme_track_test
}  // namespace animeme::dam
