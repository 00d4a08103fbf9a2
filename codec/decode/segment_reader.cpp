#include "codec/decode/segment_reader_internal.h"

namespace animeme::fba::internal {

namespace {

// Both: false if the bits do not suffice.
[[gnu::always_inline]] inline bool flat_symbol(SegmentCursor& segment, std::uint32_t n,
                                               std::uint16_t& symbol) {
  symbol = std::uint16_t(n - 1 - segment.target(n));
  const SymbolInterval interval = flat_interval(symbol, n);
  return segment.consume(interval.low, interval.high, n);
}
[[gnu::always_inline]] inline bool model_symbol(SegmentCursor& segment, const AdaptiveModel& model,
                                                std::uint16_t& symbol) {
  SymbolInterval interval;
  symbol = std::uint16_t(model.find(segment.target(model.total()), interval));
  return segment.consume(interval.low, interval.high, interval.total);
}

// Reads symbols `first` to `count` - 1; `read(cursor, i)` reads one, false if the bits do not
// suffice. Returns which one that was, or `count`.
template <class Read>
std::size_t read_symbols(SegmentDecoder& segment, std::size_t first, std::size_t count,
                         const Read& read) {
  if (!segment.ready()) return first;
  SegmentCursor cursor = segment.cursor();  // a copy, which stays in the processor
  std::size_t i = first;
  for (; i < count && read(cursor, i); ++i) {
    if (cursor.needs_bits()) segment.refill(cursor);
  }
  segment.set_cursor(cursor);
  return i;
}

bool end_segment(PlaneBits& bits, const SegmentDecoder& segment, ParsedPlane& plane) {
  const std::size_t end = segment.end();
  if (end > bits.in().size()) return bits.out_of_bits();
  if (segment.bad_stuffing() != SIZE_MAX) {
    return bits.fail(Code::syntax, "the bit after 22 zeros is not the stuffed 1",
                     segment.bad_stuffing());
  }
  bits.in().seek(end);
  plane.settled = plane.settled && segment.cursor().settled();
  return true;
}

// A segment without symbols: two bits, and the look-ahead that any segment has.
bool pass_empty_segment(PlaneBits& bits) {
  BitReader& in = bits.in();
  const std::size_t begin = in.position();
  if (begin + (bits.last() ? 2 : 16) > in.size()) return bits.out_of_bits();
  in.seek(begin + 2);
  return true;
}

}  // namespace

bool PlaneBits::out_of_bits() {
  error_ = last_ ? error_at_bit(Code::truncated, "the stream ends in the middle of a plane",
                                std::int64_t(in_.size()))
                 : need_more_data();
  return false;
}

bool PlaneBits::fail(Code code, std::string message, std::size_t bit) {
  if (in_.overrun()) return out_of_bits();
  error_ = error_at_bit(code, std::move(message), std::int64_t(bit));
  return false;
}

bool PlaneBits::marker(const char* where) {
  if (in_.bit() != 0) return true;
  return fail(Code::syntax, std::string("marker bit in the ") + where + " is 0, must be 1",
              in_.position() - 1);
}

bool read_high_segment(PlaneBits& bits, const HighLevelState& high, int fap_quant, int first,
                       int last, ParsedPlane& plane) {
  SegmentDecoder segment(bits.in(), bits.last());
  const std::size_t end = std::size_t(last) + 1;
  const auto read = [&](SegmentCursor& cursor, std::size_t which) {
    if (!plane.intra) return model_symbol(cursor, high.model[which], plane.high_symbols[which]);
    const std::uint32_t max = std::uint32_t(high_level_max(int(which), fap_quant));
    return flat_symbol(cursor, max + 1, plane.high_symbols[which]);
  };
  if (read_symbols(segment, std::size_t(first), end, read) != end) return bits.out_of_bits();
  return end_segment(bits, segment, plane);
}

bool read_slot_segment(PlaneBits& bits, SlotState& state, ParsedSlots& parsed, ParsedPlane& plane) {
  const bool intra = plane.intra;
  PlaneProgress& progress = plane.progress;
  const SlotCoding& coding = intra ? parsed.coding : state.coding;
  const std::uint16_t* coded = coding.coded.data();
  const std::size_t count = coding.coded.size();
  if (count == 0) return pass_empty_segment(bits);
  parsed.symbols.resize(count);
  std::uint16_t* symbols = parsed.symbols.data();
  const std::size_t first = progress.segment ? progress.symbols : 0;
  SegmentDecoder segment =
      progress.segment ? *progress.segment : SegmentDecoder(bits.in(), bits.last());
  if (progress.segment) segment.resume(bits.in().bytes(), bits.last());
  std::size_t end = first;
  if (intra) {
    end = read_symbols(segment, first, count, [&](SegmentCursor& cursor, std::size_t i) {
      return flat_symbol(cursor, coding.alphabet(true, coded[i]), symbols[i]);
    });
  } else {
    AdaptiveModel* models = state.model.data();
    end = read_symbols(segment, first, count, [=](SegmentCursor& cursor, std::size_t i) {
      AdaptiveModel& model = models[coded[i]];
      std::uint16_t symbol = 0;
      if (!model_symbol(cursor, model, symbol)) return false;
      // While the processor waits for the next symbol, it has time for that.
      model.update(symbol);
      model.expect(symbol);
      symbols[i] = symbol;
      return true;
    });
  }
  if (end != count) {
    progress.segment = segment;
    progress.symbols = end;
    return bits.out_of_bits();
  }
  progress.segment.reset();
  return end_segment(bits, segment, plane);
}

}  // namespace animeme::fba::internal
