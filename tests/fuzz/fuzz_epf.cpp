// Any text as an encoder parameter file, and a stream from it.
#include <cstdint>
#include <string_view>

#include "codec/text/epf.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto planes = animeme::fba::read_epf({reinterpret_cast<const char*>(data), size});
  if (!planes) return 0;
  animeme::fap::Sequence clip;
  for (int i = 0; i < 4; ++i) {
    animeme::fap::Frame frame;
    frame.number = i;
    for (int fap = 3; fap <= animeme::fap::kFapCount; ++fap) frame.set(fap, i * 7 - fap);
    clip.frames.push_back(frame);
  }
  std::vector<animeme::fba::BodyFrame> bodies(4);
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].number = std::int64_t(i);
  (void)animeme::fba::encode_epf(clip, bodies, *planes);
  return 0;
}
