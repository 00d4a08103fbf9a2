#include "dam/signal/articulators_internal.h"

#include <gtest/gtest.h>

#include <utility>

namespace animeme::dam {
namespace articulators_test {

TEST(Articulators, AreFoundByNamesOfFapsAndShapes) {
  const std::pair<const char*, Articulator> cases[] = {
      {"fap3_open_jaw", Articulator::jaw},
      {"fap18_depress_chin", Articulator::jaw},
      {"fap4", Articulator::lips},
      {"fap58_raise_b_lip_rm_o", Articulator::lips},
      {"fap7_stretch_r_cornerlip", Articulator::width},
      {"fap54", Articulator::width},
      {"fap12_raise_l_cornerlip", Articulator::corners},
      {"fap60", Articulator::corners},
      {"fap16_push_b_lip", Articulator::forward},
      {"fap31_raise_l_i_eyebrow", Articulator::other},
      {"fap68", Articulator::other},
      {"fap69", Articulator::other},
      {"fap600", Articulator::other},
      {"jawOpen", Articulator::jaw},
      {"mouthStretchLeft", Articulator::width},
      {"mouthSmileRight", Articulator::corners},
      {"mouthPucker", Articulator::forward},
      {"mouthUpperUpLeft", Articulator::lips},
      {"browInnerUp", Articulator::other},
      {"", Articulator::other},
  };
  for (const auto& [name, articulator] : cases)
    EXPECT_EQ(articulator_of(name), articulator) << name;
}

}  // namespace articulators_test
}  // namespace animeme::dam
