#include "codec/decode/unit_writer_internal.h"

#include "codec/syntax/plane.h"

namespace animeme::fba::internal {
namespace {

void copy(BitReader& in, BitWriter& out, std::int64_t count) {
  for (; count >= 32; count -= 32) out.bits(in.bits(32), 32);
  out.bits(in.bits(int(count)), int(count));
}

// Everything before skip_frames, in bits; 0: there is no temporal header.
int bits_before_skip(BitReader in) {
  const std::size_t begin = in.position();
  const bool intra = in.bit() != 0;
  if (ObjectMask(in.bits(2)) == ObjectMask::nothing) return 0;
  if (intra) {
    if (in.bit() != 0) in.bits(13);  // rate
    if (in.bit() != 0) in.bits(18);  // time code
  }
  return int(in.position() - begin);
}

void pass_skip(BitReader& in) {
  if (in.bit() == 0) return;
  while (in.bits(4) == 15 && !in.overrun()) {
  }
}

}  // namespace

void write_skip(BitWriter& out, const std::optional<std::uint32_t>& skip) {
  out.bit(skip.has_value());
  if (!skip) return;
  std::uint32_t rest = *skip;
  for (; rest >= 15; rest -= 15) out.bits(15, 4);
  out.bits(rest, 4);
}

std::vector<std::uint8_t> write_unit(std::span<const std::uint8_t> stream, std::int64_t begin,
                                     std::int64_t end, bool first,
                                     std::optional<std::uint32_t> skip) {
  BitWriter out;
  if (first) {
    out.start_code(kObjectStart);
    out.stuff();
  }
  out.start_code(kPlaneStart);
  BitReader in(stream, std::size_t(begin));
  const int before = skip ? bits_before_skip(in) : 0;
  if (before > 0) {
    copy(in, out, before);
    write_skip(out, *skip > 0 ? skip : std::nullopt);
    pass_skip(in);
  }
  copy(in, out, end - std::int64_t(in.position()));
  out.stuff();
  return out.take();
}

}  // namespace animeme::fba::internal
