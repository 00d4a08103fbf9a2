#include "codec/decode/plane_reader_internal.h"
#include "codec/decode/segment_reader_internal.h"

namespace animeme::fba::internal {

namespace {

using Stage = PlaneProgress::Stage;

class PlaneParser {
 public:
  PlaneParser(BitReader& in, StreamState& state, bool last, ParsedPlane& plane)
      : in_(in), bits_(in, last), state_(state), plane_(plane) {}

  Result<void> run() {
    if (plane_.begun()) {
      in_.seek(progress_.bit);
    } else {
      progress_.bit = in_.position();
    }
    while (progress_.stage != Stage::done) {
      if (!read_stage()) {
        Error error = bits_.take_error();
        if (error.code != Code::need_data) restart();
        return error;
      }
      progress_.bit = in_.position();
    }
    restart();
    return {};
  }

 private:
  void restart() {
    progress_.stage = Stage::header;
    progress_.segment.reset();
  }

  // Reads what a stage is about and says which one is next; false: there is an error. A stage that
  // runs out of bits is read again from its start, or from where it has set progress_.bit.
  bool read_stage() {
    switch (progress_.stage) {
      case Stage::header:
        return header();
      case Stage::skip:
        return skipped_frames();
      case Stage::face_masks:
        return face_settings();
      case Stage::face_ranges:
        return ranges(plane_.face.coding, plane_.face_settings, Stage::viseme);
      case Stage::viseme:
        return viseme();
      case Stage::expression:
        return expression();
      case Stage::face_slots:
        return slots(state_.face, plane_.face, begin_body());
      case Stage::body_masks:
        return body_settings();
      case Stage::body_ranges:
        return ranges(plane_.body.coding, plane_.body_settings, Stage::body_slots);
      case Stage::body_slots:
        return slots(state_.body, plane_.body, Stage::done);
      case Stage::done:
        break;
    }
    return true;
  }

  // Ends a stage whose bits were all there.
  bool proceed(Stage next) {
    if (!bits_.check_end()) return false;
    progress_.stage = next;
    return true;
  }

  bool header() {
    plane_.intra = in_.bit() != 0;
    plane_.object_mask = ObjectMask(in_.bits(2));
    plane_.temporal = {};
    plane_.settled = true;
    if (plane_.object_mask == ObjectMask::nothing) return proceed(Stage::done);
    TemporalHeader& temporal = plane_.temporal;
    if (plane_.intra) {
      if (in_.bit() != 0) {
        CodedRate rate;
        const std::size_t at = in_.position();
        rate.frame_rate = std::uint8_t(in_.bits(8));
        rate.sixteenths = std::uint8_t(in_.bits(4));
        rate.frequency_offset = in_.bit() != 0;
        if (!rate.rate().valid()) return bits_.fail(Code::syntax, "the frame rate is 0", at);
        temporal.rate = rate;
      }
      if (in_.bit() != 0) {
        TimeCode code;
        code.hours = std::uint8_t(in_.bits(5));
        code.minutes = std::uint8_t(in_.bits(6));
        if (!bits_.marker("time code")) return false;
        code.seconds = std::uint8_t(in_.bits(6));
        temporal.time_code = code;
      }
    }
    if (in_.bit() == 0) return begin_parts();
    if (!in_.overrun()) temporal.skip = 0;
    return proceed(Stage::skip);
  }

  // Fields of four bits, as long as they are 15. There may be so many that each is final.
  bool skipped_frames() {
    std::uint32_t part = 0;
    do {
      progress_.bit = in_.position();
      part = in_.bits(4);
      if (in_.overrun()) return bits_.out_of_bits();
      *plane_.temporal.skip += part;
      if (*plane_.temporal.skip > kMaxSkip) {
        return bits_.fail(Code::syntax, "more than a million frames are skipped", in_.position());
      }
    } while (part == 15);
    return begin_parts();
  }

  bool begin_parts() {
    if (!bits_.check_end()) return false;
    const bool face = has_face(plane_.object_mask);
    if (!plane_.intra) {
      const bool face_known = !face || state_.face.coding.valid;
      const bool body_known = !has_body(plane_.object_mask) || state_.body.coding.valid;
      if (!face_known || !body_known) {
        return bits_.fail(Code::syntax,
                          std::string("a predictive ") + (face_known ? "body" : "face") +
                              " plane comes before the first intra plane",
                          in_.position());
      }
    }
    if (!face) return proceed(begin_body());
    return proceed(plane_.intra ? Stage::face_masks : Stage::viseme);
  }
  Stage begin_body() const {
    if (!has_body(plane_.object_mask)) return Stage::done;
    return plane_.intra ? Stage::body_masks : Stage::body_slots;
  }

  bool face_settings() {
    FaceSettings& settings = plane_.face_settings;
    settings = {};
    settings.fap_quant = int(in_.bits(5));
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      if (!bits_.marker("face masks")) return false;
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

    plane_.face.coding.begin(state_.face.coding, settings.mask, settings.fap_quant,
                             fap_scale(settings.fap_quant));
    return range_flags(settings, Stage::face_ranges);
  }

  const FaceSettings& settings_in_force() const {
    return plane_.intra ? plane_.face_settings : state_.face_settings;
  }

  bool viseme() {
    if (settings_in_force().mask[1]) {
      if (!high_segment(kVisemeSelect1, kVisemeBlend)) return false;
      plane_.viseme_def = in_.bit() != 0;
    }
    return proceed(Stage::expression);
  }

  bool expression() {
    if (settings_in_force().mask[2]) {
      if (!high_segment(kExpressionSelect1, kExpressionIntensity2)) return false;
      plane_.init_face = in_.bit() != 0;
      plane_.expression_def = in_.bit() != 0;
    }
    return proceed(Stage::face_slots);
  }

  bool high_segment(int first, int last) {
    return read_high_segment(bits_, state_.high, settings_in_force().fap_quant, first, last,
                             plane_);
  }

  bool body_settings() {
    BodySettings& settings = plane_.body_settings;
    settings = {};
    settings.bap_quant = int(in_.bits(5));
    std::size_t slot = 0;
    for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
      if (!bits_.marker("body masks")) return false;
      const MaskType type = MaskType(in_.bits(2));
      settings.mask_type[group] = type;
      if (type == MaskType::interpolate) {
        return bits_.fail(Code::syntax, "body mask type 2 is not allowed", in_.position() - 2);
      }
      for (int i = 0; i < kBodyGroupSizes[group]; ++i, ++slot) {
        const bool coded = type == MaskType::hold ? in_.bit() != 0 : type == MaskType::all;
        settings.mask[kBapOrder[slot]] = coded;
      }
    }
    settings.male = in_.bit() != 0;
    if (in_.bit() != 0) return dct("body");
    plane_.body.coding.begin(state_.body.coding, settings.mask, settings.bap_quant,
                             bap_scale(settings.bap_quant));
    return range_flags(settings, Stage::body_ranges);
  }

  bool dct(const char* part) {
    return bits_.fail(Code::unsupported,
                      std::string("the ") + part +
                          " is coded in DCT mode (fba_object_coding_type 1), whose tables are not "
                          "public; only the arithmetic mode can be decoded",
                      in_.position() - 1);
  }

  bool slots(SlotState& state, ParsedSlots& parsed, Stage next) {
    return read_slot_segment(bits_, state, parsed, plane_) && proceed(next);
  }

  // codec/bitstream.md, section 3.2: up to four sets, a marker at every fourth member of each
  // group.
  template <class Settings>
  bool range_flags(Settings& settings, Stage next) {
    for (bool& flag : settings.send_range) flag = in_.bit() != 0;
    progress_.kind = 0;
    return proceed(next);
  }

  template <class Settings>
  bool ranges(SlotCoding& coding, Settings& settings, Stage next) {
    for (; progress_.kind < 4; ++progress_.kind) {
      progress_.bit = in_.position();
      if (!settings.send_range[progress_.kind]) continue;
      // The size of a set is known, so that a set which is still arriving is not read in vain.
      const bool arrived = in_.position() + coding.range_bits() <= in_.size();
      if (!arrived && !bits_.last()) return bits_.out_of_bits();
      if (!range_set(coding, settings, progress_.kind)) return false;
    }
    return proceed(next);
  }

  template <class Settings>
  bool range_set(SlotCoding& coding, Settings& settings, std::size_t kind) {
    std::size_t slot = 0;
    for (const std::uint8_t size : coding.table->group_sizes) {
      for (int i = 0; i < size; ++i, ++slot) {
        if (i % 4 == 0) {
          if (!bits_.marker("ranges")) return false;
        }
        const std::size_t number = coding.table->number[slot];
        if (!settings.mask[number]) continue;
        const int m = int(in_.bits(5));
        settings.range[kind][number] = std::uint8_t(m);
        coding.range[kind][slot] = level_range(m, coding.scale);
      }
    }
    return bits_.check_end();
  }

  BitReader& in_;
  PlaneBits bits_;
  StreamState& state_;
  ParsedPlane& plane_;
  PlaneProgress& progress_ = plane_.progress;
};

}  // namespace

Result<void> parse_plane(BitReader& in, StreamState& state, bool last, ParsedPlane& plane) {
  return PlaneParser(in, state, last, plane).run();
}

}  // namespace animeme::fba::internal
