#include "dam/speaking/tongue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dam/model/builtin.h"
#include "dam/script/phones.h"
#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/stream.h"
#include "dam/speaking/synthesise.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace tongue_test {

const Model& model() {
  static const Model built = *builtin_model();
  return built;
}

/// The tongue in the middle of a phone between two others.
TonguePose middle(const std::string& label, const std::string& beside = "AX") {
  const Script script =
      test::script_of({{"SIL", 0.5}, {beside, 0.1}, {label, 0.1}, {beside, 0.1}, {"SIL", 0.5}});
  return TongueCurves(script).at(0.65);
}

TEST(Tongue, GoesWhereTheSoundIsMade) {
  for (const char* dental : {"TH", "DH"}) {
    EXPECT_GT(middle(dental).tip_out, 120) << dental << ": between the teeth";
    EXPECT_LT(middle(dental).tip_up, 450) << dental;
  }
  for (const char* ridge : {"T", "D", "N", "L"}) {
    EXPECT_GT(middle(ridge).tip_up, 480) << ridge;
    EXPECT_LT(middle(ridge).tip_out, 60) << ridge;
  }
  for (const char* near : {"S", "Z"}) {
    EXPECT_GT(middle(near).tip_up, 200) << near;
    EXPECT_LT(middle(near).tip_up, middle("T").tip_up - 150) << near << ": below the ridge";
  }
  for (const char* back : {"K", "G", "NG"}) {
    EXPECT_GT(middle(back).back_up, 350) << back;
    EXPECT_LT(middle(back).tip_up, 0) << back;
  }
  for (const char* curled : {"R", "ER"}) EXPECT_GT(middle(curled).rolled, 15000) << curled;
  for (const PhoneInfo& phone : phones()) {
    const std::string label(phone.label);
    if (label == "R" || label == "ER" || label == "SIL") continue;
    EXPECT_EQ(middle(label).rolled, 0) << label;
  }
  EXPECT_LT(middle("AA").back_up, -20);
  EXPECT_LT(middle("AA").tip_up, -20);
  EXPECT_GT(middle("IY").back_up, 100);
  EXPECT_GT(middle("IY").tip_up, middle("AE").tip_up + 50);
}

TEST(Tongue, LabialsLeaveItToTheirNeighbours) {
  for (const char* labial : {"P", "B", "M", "F", "V", "HH"}) {
    EXPECT_GT(middle(labial, "IY").back_up, 30) << labial;
    EXPECT_LT(middle(labial, "AA").back_up, 0) << labial;
  }
}

TEST(Tongue, RestsInSilenceAndNeverJumps) {
  test::Uniform random(3);
  std::vector<std::string> labels;
  for (const PhoneInfo& phone : phones()) labels.emplace_back(phone.label);
  for (int round = 0; round < 10; ++round) {
    const Script script = test::random_script(random, labels, 80);
    const TongueCurves curves(script);
    TonguePose before = curves.at(0);
    EXPECT_EQ(before.tip_up, 0);
    const auto steps = int(script.duration() * 1000);
    for (int i = 1; i <= steps; ++i) {
      const TonguePose now = curves.at(i / 1000.0);
      // Not much faster than a raised cosine over the whole way in 0.04 s.
      ASSERT_LT(std::abs(now.tip_up - before.tip_up), 1.2 * 780 * 1.6 / 40) << i;
      ASSERT_LT(std::abs(now.back_up - before.back_up), 1.2 * 640 * 1.6 / 40) << i;
      before = now;
    }
    EXPECT_EQ(before.tip_up, 0);
    EXPECT_EQ(before.rolled, 0);
  }
}

TEST(Tongue, StaysBehindShutLips) {
  SynthesisOptions options;
  options.rate = {100, 1};
  options.tongue = true;
  const auto signal = synthesise(model(),
                                 test::script_of({{"SIL", 0.5},
                                                  {"DH", 0.08},
                                                  {"P", 0.1},
                                                  {"TH", 0.08},
                                                  {"AA", 0.1},
                                                  {"TH", 0.1},
                                                  {"M", 0.1},
                                                  {"DH", 0.08},
                                                  {"SIL", 0.5}}),
                                 options);
  ASSERT_TRUE(signal);
  const auto lips = inner_lip_channels(signal->names);
  const auto out = std::find(signal->names.begin(), signal->names.end(), fap_channel(45));
  ASSERT_NE(out, signal->names.end());
  double most = 0;
  for (std::size_t i = 0; i < signal->frames(); ++i) {
    const double thrust = signal->at(i, std::size_t(out - signal->names.begin()));
    most = std::max(most, thrust);
    EXPECT_TRUE(inner_gap(*signal, i, *lips) > kClosedGap || thrust <= 0) << i;
  }
  EXPECT_GT(most, 100);
}

TEST(Tongue, MovesNothingElse) {
  const Script script = test::script_of({{"SIL", 0.4},
                                         {"DH", 0.08},
                                         {"AH", 0.1},
                                         {"L", 0.08},
                                         {"UW", 0.2},
                                         {"N", 0.1},
                                         {"SIL", 0.4}});
  SynthesisOptions options;
  const auto plain = synthesise(model(), script, options);
  options.tongue = true;
  const auto with = synthesise(model(), script, options);
  ASSERT_TRUE(plain && with);
  ASSERT_EQ(with->names.size(), plain->names.size() + 4);
  for (std::size_t i = 0; i < plain->frames(); ++i)
    for (std::size_t c = 0; c < plain->names.size(); ++c)
      EXPECT_EQ(with->at(i, c), plain->at(i, c));
  Signal again = *with;
  EXPECT_FALSE(add_tongue(again, script)) << "it has one";
  EXPECT_EQ(again.values, with->values);
  Signal rig{{25, 1}, 0, {"handle"}, {1, 2}, {}};
  EXPECT_FALSE(add_tongue(rig, script));
  EXPECT_EQ(rig.names.size(), 1u);
}

TEST(Tongue, StreamsHaveTheSameTongue) {
  test::Uniform random(8);
  const Script script =
      test::random_script(random, {"T", "AA", "L", "R", "TH", "IY", "K", "M", "SIL"}, 60);
  StreamOptions options;
  options.synthesis.tongue = true;
  const auto whole = synthesise(model(), script, options.synthesis);
  ASSERT_TRUE(whole);
  SpeechStream stream(model(), options);
  std::size_t next = 0;
  const auto compare = [&](const Result<Signal>& piece) {
    ASSERT_TRUE(piece);
    EXPECT_EQ(piece->names, whole->names);
    for (std::size_t i = 0; i < piece->frames(); ++i, ++next)
      for (std::size_t c = model().controls.size(); c < piece->names.size(); ++c)
        EXPECT_EQ(piece->at(i, c), whole->at(next, c)) << next;
  };
  for (const Phone& phone : script.phones) {
    ASSERT_TRUE(stream.push(phone));
    compare(stream.pull());
  }
  compare(stream.finish());
  EXPECT_EQ(next, whole->frames());
}

}  // namespace tongue_test
}  // namespace animeme::dam
