// The predefined heads.
#include "fap/head/model.h"

namespace animeme::head {

const std::array<std::string_view, 3> kHeadNames = {"woman", "man", "child"};

namespace {

HeadParameters man() {
  HeadParameters p;
  p.name = "man";
  p.skull_width = 7.55;
  p.face_width = 6.4;
  p.jaw_width = 3.85;
  p.chin_drop = 10.8;
  p.chin_size = 1.5;
  p.cheek = 2.0;
  p.brow_ridge = 0.3;
  p.neck = 4.7;
  p.eye_radius = 1.58;
  p.eye_opening = 1.2;
  p.eye_width = 2.9;
  p.iris = 0.77;
  p.nose_length = 3.95;
  p.nose_size = 0.78;
  p.nose_bridge = 0.35;
  p.mouth_drop = 6.6;
  p.mouth_width = 2.2;
  p.lip_fullness = 0.85;
  p.smile = 0.06;
  p.brow_height = 2.15;
  p.brow_thickness = 0.36;
  p.ear = 1.42;
  p.lashes = 0.14;
  p.skin_colour = 0xDB9C78;
  p.lip_colour = 0xB76457;
  p.cheek_colour = 0xCE7B60;
  p.iris_colour = 0x54707F;
  p.hair_colour = 0x2E2019;
  p.brow_colour = 0x261A14;
  p.cloth_colour = 0x4A5568;
  p.hair = HairStyle::short_cut;
  return p;
}

HeadParameters child() {
  HeadParameters p;
  p.name = "child";
  p.scale = 0.9;
  p.skull_width = 7.7;
  p.skull_height = 7.9;
  p.face_width = 6.2;
  p.jaw_width = 2.95;
  p.chin_drop = 8.3;
  p.chin_size = 1.1;
  p.cheek = 2.55;
  p.brow_ridge = 0;
  p.neck = 3.0;
  p.eye_distance = 3.2;
  p.eye_radius = 1.9;
  p.eye_opening = 1.7;
  p.eye_width = 3.3;
  p.iris = 1.1;
  p.nose_length = 2.85;
  p.nose_size = 0.54;
  p.mouth_drop = 5.05;
  p.mouth_width = 1.75;
  p.lip_fullness = 0.8;
  p.smile = 0.1;
  p.brow_height = 2.6;
  p.brow_thickness = 0.2;
  p.ear = 1.25;
  p.lashes = 0.26;
  p.freckles = 0.55;
  p.skin_colour = 0xEDB796;
  p.lip_colour = 0xCE7468;
  p.cheek_colour = 0xE58A70;
  p.iris_colour = 0x6B4526;
  p.hair_colour = 0x8A5A2B;
  p.brow_colour = 0x6B4423;
  p.cloth_colour = 0xC2703A;
  p.hair = HairStyle::fringe;
  return p;
}

}  // namespace

std::optional<HeadParameters> head_parameters(std::string_view name) {
  if (name == "woman") return HeadParameters{};
  if (name == "man") return man();
  if (name == "child") return child();
  return std::nullopt;
}

}  // namespace animeme::head
