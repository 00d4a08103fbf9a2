// Random legal settings and values, taken from the input: what is encoded is decoded again, and
// the encoder's own reconstruction is what the decoder gives.
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "codec/decoder.h"
#include "codec/encoder.h"
#include "codec/epf.h"

namespace {

using namespace animeme;  // NOLINT: a test

// Numbers from the input; zeros when it is used up.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  int range(int low, int high) {
    std::uint32_t value = byte();
    if (high - low > 255) value = (value << 8) | byte();
    return low + int(value % std::uint32_t(high - low + 1));
  }
  bool flag() { return (byte() & 1) != 0; }
  bool empty() const { return at_ >= size_; }

 private:
  std::uint8_t byte() { return at_ < size_ ? data_[at_++] : std::uint8_t(0); }
  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t at_ = 0;
};

fba::FaceSettings settings(Source& in) {
  fba::FaceSettings face;
  face.fap_quant = in.range(0, 31);
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    face.mask_type[group] = fba::MaskType(in.range(0, 3));
    for (int i = 0; i < fap::kGroups[group].size; ++i) {
      const bool coded = face.mask_type[group] == fba::MaskType::all ||
                         (face.mask_type[group] != fba::MaskType::none && in.flag());
      face.mask[std::size_t(fap::kGroups[group].first + i)] = coded;
    }
  }
  face.male = in.flag();
  for (bool& send : face.send_range) send = in.flag();
  for (auto& set : face.range) {
    for (auto& m : set) m = std::uint8_t(in.range(0, 31));
  }
  return face;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source in(data, size);
  fba::StreamOptions options;
  options.plane_start_codes = fba::PlaneStartCodes(in.range(0, 2));
  options.old_codes = in.flag();
  fba::Encoder encoder(options);
  std::vector<fap::Frame> expected;
  fba::FaceSettings face;
  for (int i = 0; i < 40 && !in.empty(); ++i) {
    fba::PlaneInput plane;
    plane.intra = i == 0 || in.range(0, 9) == 0;
    if (plane.intra) {
      face = settings(in);
      plane.temporal.rate =
          fba::CodedRate{std::uint8_t(in.range(1, 255)), std::uint8_t(in.range(0, 15)), in.flag()};
      if (in.flag()) plane.temporal.time_code = fba::TimeCode{};
    }
    if (in.range(0, 7) == 0) plane.temporal.skip = std::uint32_t(in.range(0, 400));
    fap::Frame frame;
    for (auto& value : frame.value) value = in.range(-2000, 2000);
    frame.viseme = {in.range(0, 14), in.range(0, 14), in.range(0, 63), in.flag()};
    frame.expression = {in.range(0, 6),  in.range(0, 63), in.range(0, 6),
                        in.range(0, 63), in.flag(),       in.flag()};
    plane.face = &frame;
    plane.face_settings = &face;
    if (encoder.write(plane)) expected.push_back(encoder.reconstruction());
  }
  if (expected.empty()) return 0;
  const auto decoded = fba::decode(encoder.finish());
  if (!decoded || decoded->planes.size() != expected.size()) std::abort();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    expected[i].number = decoded->planes[i].face.number;
    if (decoded->planes[i].face != expected[i]) std::abort();
  }
  return 0;
}
