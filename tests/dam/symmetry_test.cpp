#include "dam/signal/symmetry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dam/model/builtin.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace symmetry_test {

std::vector<std::size_t> channels_of(const std::vector<std::string>& names) {
  std::vector<std::size_t> channels;
  for (const MirroredChannel& other : mirrored_channels(names)) channels.push_back(other.channel);
  return channels;
}

TEST(MirroredChannels, ExchangeBothSides) {
  using Channels = std::vector<std::size_t>;
  EXPECT_EQ(channels_of({"fap12", "fap3_open_jaw", "fap13_raise_r_cornerlip"}),
            (Channels{2, 1, 0}));
  EXPECT_EQ(channels_of({"mouthSmileRight", "jawOpen", "mouthSmileLeft"}), (Channels{2, 1, 0}));
  EXPECT_EQ(channels_of({"mouthSmile_L", "mouthSmile_R"}), (Channels{1, 0}));
  EXPECT_EQ(channels_of({"fap12", "Left", "mouthLeft"}), (Channels{0, 1, 2}));  // nobody opposite
  // The jaw to the left is to the right in a mirror.
  const auto jaw = mirrored_channels(std::vector<std::string>{"fap15_shift_jaw"});
  EXPECT_EQ(jaw.at(0).channel, 0u);
  EXPECT_EQ(jaw.at(0).sign, -1);
}

/// The built-in model with a smirk: what is on the left is that much higher.
Model smirking(double units) {
  Model model = *builtin_model();
  for (Control& control : model.controls) {
    const int fap = fap_of_channel(control.name);
    if (fap == 12 || fap == 59) control.rest += units;
    if (fap == 15) control.rest = units;
  }
  return model;
}

const Script kWord{{{0, 1, "SIL", ""},
                    {1, 1.2, "W", "word"},
                    {1.2, 1.5, "ER", "word"},
                    {1.5, 1.7, "D", "word"},
                    {1.7, 3, "SIL", ""}}};

TEST(SymmetricRest, IsTheSameOnBothSides) {
  const Model model = smirking(60);
  const auto learned = synthesise(model, kWord);
  const auto signal = synthesise(model, kWord, {.symmetric_rest = true});
  ASSERT_TRUE(learned && signal);
  ASSERT_EQ(signal->frames(), learned->frames());
  const auto mirror = mirrored_channels(signal->names);
  double most = 0, most_learned = 0;
  for (std::size_t c = 0; c < mirror.size(); ++c) {
    const MirroredChannel& other = mirror[c];
    const auto difference = [&](const Signal& of, std::size_t frame) {
      return std::abs(of.at(frame, c) - other.sign * of.at(frame, other.channel));
    };
    for (const std::size_t frame : {std::size_t(0), signal->frames() - 1}) {
      most = std::max(most, difference(*signal, frame));
      most_learned = std::max(most_learned, difference(*learned, frame));
    }
    // The motion is as learned: each channel is moved by the same amount throughout.
    const double moved = signal->at(0, c) - learned->at(0, c);
    EXPECT_NEAR(signal->at(30, c) - learned->at(30, c), moved, 40) << signal->names[c];
    if (other.channel == c && other.sign > 0) {
      EXPECT_NEAR(moved, 0, 1e-9) << signal->names[c];
    }
  }
  EXPECT_LT(most, 1e-6);
  EXPECT_GT(most_learned, 50);
}

}  // namespace symmetry_test
}  // namespace animeme::dam
