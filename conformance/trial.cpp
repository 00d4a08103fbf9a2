#include "conformance/trial.h"

#include "codec/text/epf.h"
#include "fap/text.h"

namespace animeme::conformance {

Trial decode_all(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMostErrors = 1000;  // a stream of start codes has one a byte or so
  Trial trial;
  fba::Decoder decoder;
  decoder.push(bytes);
  decoder.finish();
  while (trial.errors.size() < kMostErrors) {
    Result<fba::Event> event = decoder.next();
    if (!event) {
      if (event.error().code == Code::end_of_stream) break;
      trial.errors.push_back(std::move(event).error());
    } else if (event->kind == fba::Event::Kind::plane) {
      if (trial.stream.planes.empty()) trial.stream.rate = event->plane.rate;
      trial.stream.planes.push_back(std::move(event->plane));
    }
  }
  return trial;
}

std::string kind_of_error(Code code) {
  return code == Code::syntax         ? "syntax"
         : code == Code::truncated    ? "truncated"
         : code == Code::unsupported  ? "unsupported"
         : code == Code::out_of_range ? "out_of_range"
                                      : "other";
}

void set_switches(std::span<const std::uint8_t> bytes, const fba::DecodedStream& decoded,
                  Case& info) {
  std::size_t with_code = 0, intra_without = 0;
  info.old_codes = false;
  for (const fba::Plane& plane : decoded.planes) {
    with_code += plane.start_code;
    intra_without += plane.intra && !plane.start_code;
    if (!plane.start_code) continue;
    info.old_codes = bytes[std::size_t(plane.bit_begin / 8) - 1] == (fba::kOldPlaneStart & 0xFF);
  }
  info.plane_start_codes = with_code == decoded.planes.size()    ? "all"
                           : with_code > 0 && intra_without == 0 ? "intra"
                                                                 : "none";
}

Result<std::vector<std::uint8_t>> encode_again(const Case& info, std::string_view parameters,
                                               std::string_view source_face,
                                               std::string_view source_body) {
  Result<std::vector<fba::EpfPlane>> planes = fba::read_epf(parameters);
  if (!planes) return planes.error();
  fap::Sequence clip;
  if (!source_face.empty()) {
    Result<fap::Sequence> read = fap::read_text(source_face);
    if (!read) return read.error();
    clip = std::move(*read);
  }
  fba::BodySequence bodies;
  if (!source_body.empty()) {
    Result<fba::BodySequence> read = fba::read_bap_text(source_body);
    if (!read) return read.error();
    bodies = std::move(*read);
  }
  fba::StreamOptions options;
  options.old_codes = info.old_codes;
  if (info.plane_start_codes == "intra") options.plane_start_codes = fba::PlaneStartCodes::intra;
  if (info.plane_start_codes == "all") options.plane_start_codes = fba::PlaneStartCodes::all;
  return fba::encode_epf(clip, bodies.frames, *planes, options);
}

}  // namespace animeme::conformance
