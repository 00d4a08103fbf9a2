#include "codec/plane_reader_internal.h"

namespace animeme::fba::internal {

namespace {

class PlaneParser {
 public:
  PlaneParser(BitReader& in, const StreamState& state, bool last, ParsedPlane& plane)
      : in_(in), state_(state), last_(last), plane_(plane) {}

  Result<void> run() {
    plane_.intra = in_.bit() != 0;
    plane_.object_mask = ObjectMask(in_.bits(2));
    plane_.temporal = {};
    const bool face = has_face(plane_.object_mask);
    const bool body = has_body(plane_.object_mask);
    if (face || body) {
      if (auto done = temporal_header(); !done) return done;
    }
    if (face) {
      if (auto done = face_part(); !done) return done;
    }
    if (body) {
      if (auto done = body_part(); !done) return done;
    }
    return check_end();
  }

 private:
  // What to say when the bits have run out: ask for more, or that there are none.
  Result<void> check_end() const {
    if (!in_.overrun()) return {};
    return out_of_bits();
  }
  Error out_of_bits() const {
    if (!last_) return make_error(Code::need_data, "the plane is not complete yet");
    return error_at_bit(Code::truncated, "the stream ends in the middle of a plane",
                        std::int64_t(in_.size()));
  }
  // An error, unless the offending bits are not there at all.
  Error fail(Code code, std::string message, std::size_t bit) const {
    if (in_.overrun()) return out_of_bits();
    return error_at_bit(code, std::move(message), std::int64_t(bit));
  }
  Result<void> marker(const char* where) {
    if (in_.bit() != 0) return {};
    return fail(Code::syntax, std::string("marker bit in the ") + where + " is 0, must be 1",
                in_.position() - 1);
  }

  Result<void> temporal_header() {
    TemporalHeader& temporal = plane_.temporal;
    if (plane_.intra) {
      if (in_.bit() != 0) {
        CodedRate rate;
        const std::size_t at = in_.position();
        rate.frame_rate = std::uint8_t(in_.bits(8));
        rate.sixteenths = std::uint8_t(in_.bits(4));
        rate.frequency_offset = in_.bit() != 0;
        if (!rate.rate().valid()) return fail(Code::syntax, "the frame rate is 0", at);
        temporal.rate = rate;
      }
      if (in_.bit() != 0) {
        TimeCode code;
        code.hours = std::uint8_t(in_.bits(5));
        code.minutes = std::uint8_t(in_.bits(6));
        if (auto ok = marker("time code"); !ok) return ok;
        code.seconds = std::uint8_t(in_.bits(6));
        temporal.time_code = code;
      }
    }
    if (in_.bit() != 0) {
      std::uint32_t skip = 0;
      std::uint32_t part = 0;
      do {
        part = in_.bits(4);
        skip += part;
        if (skip > kMaxSkip) {
          return fail(Code::syntax, "more than a million frames are skipped", in_.position());
        }
      } while (part == 15);
      temporal.skip = skip;
    }
    return check_end();
  }

  Result<void> face_part() {
    HighLevelState high;  // ranges only
    if (plane_.intra) {
      plane_.face.coding = state_.face.coding;
      if (auto done = face_settings(); !done) return done;
    } else if (!state_.face.coding.valid) {
      return fail(Code::syntax, "a predictive face plane comes before the first intra plane",
                  in_.position());
    }
    const FaceSettings& settings = plane_.intra ? plane_.face_settings : state_.face_settings;
    high.fap_quant = settings.fap_quant;
    if (settings.mask[1]) {
      if (auto done = high_segment(high, kVisemeSelect1, kVisemeBlend); !done) return done;
      plane_.viseme_def = in_.bit() != 0;
    }
    if (settings.mask[2]) {
      auto done = high_segment(high, kExpressionSelect1, kExpressionIntensity2);
      if (!done) return done;
      plane_.init_face = in_.bit() != 0;
      plane_.expression_def = in_.bit() != 0;
    }
    return slot_segment(state_.face, plane_.face);
  }

  Result<void> face_settings() {
    FaceSettings& settings = plane_.face_settings;
    settings = {};
    settings.fap_quant = int(in_.bits(5));
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      if (auto ok = marker("face masks"); !ok) return ok;
      settings.mask_type[group] = MaskType(in_.bits(2));
      const fap::GroupInfo& info = fap::kGroups[group];
      const MaskType type = settings.mask_type[group];
      const bool by_mask = type == MaskType::hold || type == MaskType::interpolate;
      for (int i = 0; i < info.size; ++i) {
        const bool coded = by_mask ? in_.bit() != 0 : type == MaskType::all;
        settings.mask[std::size_t(info.first + i)] = coded;
      }
    }
    settings.male = in_.bit() != 0;
    if (in_.bit() != 0) return dct("face");

    SlotCoding& coding = plane_.face.coding;
    coding.valid = true;
    coding.scale = fap_scale(settings.fap_quant);
    coding.quantised = settings.fap_quant != 0;
    coding.coded.clear();
    for (std::uint16_t slot = 0; slot < fap::kLowLevelCount; ++slot) {
      if (settings.mask[std::size_t(slot + fap::kFirstLowLevel)]) coding.coded.push_back(slot);
    }
    return ranges(coding, settings.mask, settings.send_range, settings.range);
  }

  Result<void> body_part() {
    if (plane_.intra) {
      plane_.body.coding = state_.body.coding;
      if (auto done = body_settings(); !done) return done;
    } else if (!state_.body.coding.valid) {
      return fail(Code::syntax, "a predictive body plane comes before the first intra plane",
                  in_.position());
    }
    return slot_segment(state_.body, plane_.body);
  }

  Result<void> body_settings() {
    BodySettings& settings = plane_.body_settings;
    settings = {};
    settings.bap_quant = int(in_.bits(5));
    SlotCoding& coding = plane_.body.coding;
    coding.valid = true;
    coding.scale = bap_scale(settings.bap_quant);
    coding.quantised = settings.bap_quant != 0;
    coding.coded.clear();
    std::uint16_t slot = 0;
    for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
      if (auto ok = marker("body masks"); !ok) return ok;
      const MaskType type = MaskType(in_.bits(2));
      settings.mask_type[group] = type;
      if (type == MaskType::interpolate) {
        return fail(Code::syntax, "body mask type 2 is not allowed", in_.position() - 2);
      }
      for (int i = 0; i < kBodyGroupSizes[group]; ++i, ++slot) {
        const bool coded = type == MaskType::hold ? in_.bit() != 0 : type == MaskType::all;
        if (!coded) continue;
        settings.mask.set(kBapOrder[slot]);
        coding.coded.push_back(slot);
      }
    }
    settings.male = in_.bit() != 0;
    if (in_.bit() != 0) return dct("body");
    return ranges(coding, settings.mask, settings.send_range, settings.range);
  }

  Error dct(const char* part) const {
    return fail(Code::unsupported,
                std::string("the ") + part +
                    " is coded in DCT mode (fba_object_coding_type 1), whose tables are not "
                    "public; only the arithmetic mode can be decoded",
                in_.position() - 1);
  }

  // Section 3.2: up to four sets, a marker at every fourth member of each group.
  template <class Mask, class RangeArray>
  Result<void> ranges(SlotCoding& coding, const Mask& mask, std::array<bool, 4>& send,
                      RangeArray& sent) {
    for (bool& flag : send) flag = in_.bit() != 0;
    coding.set_default_ranges();
    for (std::size_t kind = 0; kind < 4; ++kind) {
      if (!send[kind]) continue;
      std::size_t slot = 0;
      for (const std::uint8_t size : coding.table->group_sizes) {
        for (int i = 0; i < size; ++i, ++slot) {
          if (i % 4 == 0) {
            if (auto ok = marker("ranges"); !ok) return ok;
          }
          const std::size_t number = coding.table->number[slot];
          if (!mask[number]) continue;
          const int m = int(in_.bits(5));
          sent[kind][number] = std::uint8_t(m);
          coding.range[kind][slot] = level_range(m, coding.scale);
        }
      }
    }
    return check_end();
  }

  Result<void> high_segment(const HighLevelState& high, int first, int last) {
    if (auto ok = check_end(); !ok) return ok;
    SegmentDecoder segment(in_);
    for (int which = first; which <= last; ++which) {
      const std::size_t index = std::size_t(which);
      const std::uint32_t max = std::uint32_t(high.max_level(which));
      plane_.high_symbols[index] = plane_.intra ? flat_symbol(segment, max + 1)
                                                : model_symbol(segment, state_.high.model[index]);
    }
    return end_segment(segment);
  }

  Result<void> slot_segment(const SlotState& state, ParsedSlots& parsed) {
    if (auto ok = check_end(); !ok) return ok;
    const SlotCoding& coding = plane_.intra ? parsed.coding : state.coding;
    parsed.symbols.resize(coding.coded.size());
    SegmentDecoder segment(in_);
    for (std::size_t i = 0; i < coding.coded.size(); ++i) {
      const std::size_t slot = coding.coded[i];
      parsed.symbols[i] = plane_.intra ? flat_symbol(segment, coding.alphabet(true, slot))
                                       : model_symbol(segment, state.model[slot]);
    }
    return end_segment(segment);
  }

  static std::uint32_t flat_symbol(SegmentDecoder& segment, std::uint32_t n) {
    const std::uint32_t symbol = n - 1 - segment.target(n);
    segment.consume(flat_interval(symbol, n));
    return symbol;
  }
  static std::uint32_t model_symbol(SegmentDecoder& segment, const AdaptiveModel& model) {
    SymbolInterval interval;
    const std::uint32_t symbol = model.find(segment.target(model.total()), interval);
    segment.consume(interval);
    return symbol;
  }

  Result<void> end_segment(const SegmentDecoder& segment) {
    // As long as more may come, even the look-ahead has to be there: decoding on zeros that
    // stand for missing bits could end at a wrong place that happens to look complete.
    const std::size_t needed = last_ ? segment.end() : segment.window_end();
    if (needed > in_.size()) return out_of_bits();
    if (segment.bad_stuffing()) {
      return fail(Code::syntax, "the bit after 22 zeros is not the stuffed 1",
                  segment.bad_stuffing_position());
    }
    in_.seek(segment.end());
    return {};
  }

  BitReader& in_;
  const StreamState& state_;
  const bool last_;
  ParsedPlane& plane_;
};

}  // namespace

Result<void> parse_plane(BitReader& in, const StreamState& state, bool last, ParsedPlane& plane) {
  return PlaneParser(in, state, last, plane).run();
}

}  // namespace animeme::fba::internal
