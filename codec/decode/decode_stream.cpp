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

// Room for one more plane. Planes are large, so they are moved to larger memory less often than a
// vector does by itself: there is room at once for as many as there will be, judged by those so
// far, but for no more than eight times as many.
void make_room(std::vector<Plane>& planes, std::size_t stream_bits) {
  constexpr std::size_t kFirst = 64;
  if (planes.size() < planes.capacity()) return;
  if (planes.empty()) return planes.reserve(std::min(kFirst, stream_bits / 8));
  const double share = double(planes.back().bit_end) / double(stream_bits);
  const double guess = double(planes.size()) / share * 1.25;  // early planes are longer
  planes.reserve(
      std::size_t(std::clamp(guess, 2.0 * double(planes.size()), 8.0 * double(planes.size()))));
}

}  // namespace

Result<DecodedStream> decode(std::span<const std::uint8_t> stream) {
  Decoder decoder;
  DecodedStream out;
  std::size_t pushed = 0;
  for (;;) {
    make_room(out.planes, stream.size() * 8);
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
