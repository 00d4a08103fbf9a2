// Streams that two decoders read: ours, and a plain one that shares no code with it; and clips at
// rest most of the time, which make short planes.
#pragma once

#include <gtest/gtest.h>

#include <exception>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "tests/support/random_clip.h"
#include "tests/support/standard_decoder.h"

namespace animeme::test {

inline StandardDecoder::Values face_values(const fap::Frame& face) {
  StandardDecoder::Values out;
  for (int n = fap::kFirstLowLevel; n <= fap::kFapCount; ++n) {
    if (face.mask[std::size_t(n)]) out[n] = face.value[std::size_t(n)];
  }
  const auto add = [&](int first, std::initializer_list<int> values) {
    for (const int value : values) out[first++] = value;
  };
  if (face.mask[1]) {
    const fap::Viseme& v = face.viseme;
    add(100, {v.select1, v.select2, v.blend, v.def});
  }
  if (face.mask[2]) {
    const fap::Expression& e = face.expression;
    add(200, {e.select1, e.intensity1, e.select2, e.intensity2, e.init_face, e.def});
  }
  return out;
}

inline StandardDecoder::Values body_values(const fba::BodyFrame& body) {
  StandardDecoder::Values out;
  for (std::size_t n = 1; n <= std::size_t(fba::kBapCount); ++n) {
    if (body.mask[n]) out[int(n)] = body.value[n];
  }
  return out;
}

/// Does the plain decoder have every plane that ours has? Says in what they differ.
inline testing::AssertionResult both_read(const std::vector<std::uint8_t>& stream) {
  auto ours = fba::decode(stream);
  if (!ours) return testing::AssertionFailure() << ours.error().describe();
  if (!ours->warnings.empty()) return testing::AssertionFailure() << ours->warnings.front();
  std::vector<StandardDecoder::Plane> theirs;
  try {
    theirs = StandardDecoder::decode(stream);
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "the plain decoder: " << error.what();
  }
  if (theirs.size() != ours->planes.size()) {
    return testing::AssertionFailure()
           << ours->planes.size() << " planes, the plain decoder has " << theirs.size();
  }
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    const fba::Plane& plane = ours->planes[i];
    const bool same =
        theirs[i].intra == plane.intra && theirs[i].object_mask == int(plane.object_mask) &&
        theirs[i].skip == long(plane.temporal.skip.value_or(0)) &&
        theirs[i].bit == std::size_t(plane.bit_begin) &&
        theirs[i].face == face_values(plane.face) &&
        theirs[i].body == (plane.body ? body_values(*plane.body) : StandardDecoder::Values());
    if (!same) return testing::AssertionFailure() << "plane " << i << " differs";
  }
  return testing::AssertionSuccess();
}

/// A face at rest most of the time: a few FAPs, some of which move now and then by little.
inline fap::Sequence quiet_clip(Random& random) {
  constexpr fap::Rate kRates[] = {{25, 1}, {30, 1}, {60, 1}, {30000, 1001}, {12, 1}};
  fap::Sequence clip;
  clip.rate = kRates[random.range(0, 4)];
  std::vector<std::size_t> faps;
  for (int i = random.range(1, 5); i > 0; --i) faps.push_back(std::size_t(random.range(3, 68)));
  fap::Frame frame;
  for (const std::size_t fap : faps) frame.value[fap] = random.range(-60, 60), frame.mask.set(fap);
  if (random.chance(10)) frame.mask.set(1);
  if (random.chance(5)) frame.mask.set(2);
  const int activity = random.range(0, 30);
  const int frames = random.range(1, 60);
  for (int i = 0; i < frames; ++i) {
    if (random.chance(activity)) {
      frame.value[faps[std::size_t(random.range(0, int(faps.size()) - 1))]] +=
          random.range(-30, 30);
    }
    if (frame.mask[1] && random.chance(activity)) frame.viseme.select1 = random.range(0, 14);
    clip.frames.push_back(frame);
    frame.number += random.chance(3) ? random.range(2, 40) : 1;
  }
  return clip;
}

inline std::vector<fba::BodyFrame> quiet_body(Random& random, const fap::Sequence& face) {
  std::vector<fba::BodyFrame> body;
  fba::BodyFrame frame;
  const std::size_t bap = std::size_t(random.range(1, fba::kBapCount));
  frame.mask.set(bap);
  for (const fap::Frame& other : face.frames) {
    frame.number = other.number;
    if (random.chance(10)) frame.value[bap] = random.range(-1800, 1800);
    body.push_back(frame);
  }
  return body;
}

inline fba::EncodeOptions some_options(Random& random) {
  fba::EncodeOptions options = random.chance(50) ? fba::file_options() : fba::EncodeOptions{};
  options.fap_quant = random.chance(60) ? random.range(1, 4) : random.range(0, 31);
  options.bap_quant = random.range(0, 31);
  if (random.chance(50)) options.intra_seconds = random.range(1, 30) / 25.0;
  options.stream.plane_start_codes = fba::PlaneStartCodes(random.range(0, 2));
  options.stream.old_codes = random.chance(20);
  options.skip_still = random.chance(20);
  options.kept_ranges = options.intra_seconds == 0 && random.chance(50);
  // These search, which takes long.
  if (random.chance(2)) options.max_bits_per_second = random.range(100, 1000);
  if (random.chance(2)) options.max_rms = random.range(1, 5);
  options.default_ranges = !options.kept_ranges && random.chance(25);
  return options;
}

}  // namespace animeme::test
