#include "codec/decode/segment_reader_internal.h"

namespace animeme::fba::internal {

namespace {

// Both: false if the bits do not suffice.
bool flat_symbol(SegmentDecoder& segment, std::uint32_t n, std::uint16_t& symbol) {
  if (!segment.ready()) return false;
  symbol = std::uint16_t(n - 1 - segment.target(n));
  return segment.consume(flat_interval(symbol, n));
}
bool model_symbol(SegmentDecoder& segment, const AdaptiveModel& model, std::uint16_t& symbol) {
  if (!segment.ready()) return false;
  SymbolInterval interval;
  symbol = std::uint16_t(model.find(segment.target(model.total()), interval));
  return segment.consume(interval);
}

Result<void> end_segment(const PlaneBits& bits, const SegmentDecoder& segment) {
  const std::size_t end = segment.end();
  if (end > bits.in().size()) return bits.out_of_bits();
  if (segment.bad_stuffing() != SIZE_MAX) {
    return bits.fail(Code::syntax, "the bit after 22 zeros is not the stuffed 1",
                     segment.bad_stuffing());
  }
  bits.in().seek(end);
  return {};
}

}  // namespace

Error PlaneBits::out_of_bits() const {
  if (!last_) return need_more_data();
  return error_at_bit(Code::truncated, "the stream ends in the middle of a plane",
                      std::int64_t(in_.size()));
}

Error PlaneBits::fail(Code code, std::string message, std::size_t bit) const {
  if (in_.overrun()) return out_of_bits();
  return error_at_bit(code, std::move(message), std::int64_t(bit));
}

Result<void> PlaneBits::marker(const char* where) const {
  if (in_.bit() != 0) return {};
  return fail(Code::syntax, std::string("marker bit in the ") + where + " is 0, must be 1",
              in_.position() - 1);
}

Result<void> read_high_segment(const PlaneBits& bits, const HighLevelState& high, int fap_quant,
                               int first, int last, ParsedPlane& plane) {
  SegmentDecoder segment(bits.in(), bits.last());
  for (int which = first; which <= last; ++which) {
    const std::size_t index = std::size_t(which);
    const std::uint32_t max = std::uint32_t(high_level_max(which, fap_quant));
    const bool done = plane.intra
                          ? flat_symbol(segment, max + 1, plane.high_symbols[index])
                          : model_symbol(segment, high.model[index], plane.high_symbols[index]);
    if (!done) return bits.out_of_bits();
  }
  return end_segment(bits, segment);
}

Result<void> read_slot_segment(const PlaneBits& bits, const SlotState& state, bool intra,
                               PlaneProgress& progress, ParsedSlots& parsed) {
  const SlotCoding& coding = intra ? parsed.coding : state.coding;
  const std::size_t count = coding.coded.size();
  parsed.symbols.resize(count);
  std::size_t i = progress.segment ? progress.symbols : 0;
  SegmentDecoder segment =
      progress.segment ? *progress.segment : SegmentDecoder(bits.in(), bits.last());
  if (progress.segment) segment.resume(bits.in().bytes(), bits.last());
  bool more = segment.ready();
  if (intra) {
    for (; more && i < count; i += more ? 1 : 0) {
      more = flat_symbol(segment, coding.alphabet(true, coding.coded[i]), parsed.symbols[i]);
    }
  } else {
    for (; more && i < count; i += more ? 1 : 0) {
      more = model_symbol(segment, state.model[coding.coded[i]], parsed.symbols[i]);
    }
  }
  if (!more) {
    progress.segment = segment;
    progress.symbols = i;
    return bits.out_of_bits();
  }
  progress.segment.reset();
  return end_segment(bits, segment);
}

}  // namespace animeme::fba::internal
