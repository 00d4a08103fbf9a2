// What bench_codec codes: clips with the settings of their one intra plane, and the same for the
// textbook coder.
#pragma once

#include <string>
#include <vector>

#include "codec/encode/encoder.h"
#include "fap/frame.h"
#include "tests/bench/textbook_coder.h"

namespace animeme::bench {

struct Material {
  std::string name;
  // For the codec.
  fba::ObjectMask object_mask = fba::ObjectMask::face;
  fba::FaceSettings face_settings;
  fba::BodySettings body_settings;
  std::vector<fap::Frame> faces;
  std::vector<fba::BodyFrame> bodies;
  // For the textbook coder.
  textbook::Layout layout;
  textbook::Planes planes;
  // What both write.
  std::vector<std::uint8_t> stream;
};

/// A face that moves like a talking one: slow waves of different speeds and phases.
fap::Sequence moving_face(int frames);

Material wide_face();   ///< 66 FAPs, ranges +-1860
Material tight_face();  ///< 66 FAPs, ranges of the clip
Material visemes();     ///< FAP 1 alone
Material body();        ///< 296 BAPs, ranges +-1860

/// The stream of the codec's Encoder, plane by plane.
std::vector<std::uint8_t> encode_planes(const Material& material);

/// Empty if the textbook coder writes the same bytes as the codec and both read the same values;
/// else what is wrong.
std::string check(const Material& material);

}  // namespace animeme::bench
