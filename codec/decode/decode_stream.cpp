#include <algorithm>

#include "codec/decode/decoder_internal.h"

namespace animeme::fba {

namespace {

constexpr std::size_t kMaxWarnings = 100;

void add_warning(DecodedStream& out, std::int64_t bit, const std::string& text) {
  if (out.warnings.size() >= kMaxWarnings) return;
  out.warnings.push_back("bit " + std::to_string(bit) + ": " + text);
}

// The rate of the stream is that of its first plane.
void note_rate(DecodedStream& out) {
  const Plane& plane = out.planes.back();
  if (out.planes.size() == 1) out.rate = plane.rate;
  if (plane.rate != out.rate && plane.temporal.rate) {
    add_warning(out, plane.bit_begin,
                "the frame rate changes; the first one is kept for all planes");
  }
}

}  // namespace

Result<DecodedStream> decode(std::span<const std::uint8_t> stream) {
  Decoder decoder;
  DecodedStream out;
  std::size_t pushed = 0;
  for (;;) {
    out.planes.emplace_back();  // filled in place
    const Result<bool> filled = decoder.impl_->advance(out.planes.back());
    if (filled && *filled) {
      note_rate(out);
      continue;
    }
    out.planes.pop_back();
    if (filled) {
      const Event event = decoder.impl_->take_waiting();
      if (event.kind == Event::Kind::warning) {
        add_warning(out, event.bit, event.text);
      } else if (out.planes.empty()) {
        out.info = event.info;
      }
      continue;
    }
    const Error& error = filled.error();
    if (error.code == Code::need_data) {
      const std::size_t count = std::min(internal::kPieceBytes, stream.size() - pushed);
      decoder.push(stream.subspan(pushed, count));
      pushed += count;
      if (pushed == stream.size()) decoder.finish();
      continue;
    }
    if (error.code != Code::end_of_stream) return error;
    const std::int64_t ignored = std::int64_t(stream.size()) - error.where.bit / 8;
    if (ignored > 0) {
      add_warning(out, error.where.bit,
                  std::to_string(ignored) + " bytes after the end code are ignored");
    }
    return out;
  }
}

fap::Sequence face_sequence(const DecodedStream& stream) {
  fap::Sequence sequence;
  sequence.rate = stream.rate;
  for (const Plane& plane : stream.planes) {
    if (has_face(plane.object_mask)) sequence.frames.push_back(plane.face);
  }
  return sequence;
}

}  // namespace animeme::fba
