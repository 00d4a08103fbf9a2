#include "conformance/analyse.h"

#include <algorithm>
#include <set>

#include "conformance/features.h"
#include "fap/tables.h"

namespace animeme::conformance {
namespace {

std::uint32_t code_at(std::span<const std::uint8_t> bytes, std::int64_t bit) {
  const std::size_t at = std::size_t(bit / 8);
  if (bit < 0 || bit % 8 != 0 || at + 4 > bytes.size()) return 0;
  return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
         std::uint32_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

// Collects the features of one stream.
class Collector {
 public:
  Collector(std::span<const std::uint8_t> bytes, const fba::DecodedStream& decoded,
            const std::vector<PlaneSpec>& specs)
      : bytes_(bytes), decoded_(decoded), specs_(specs) {}

  StreamFacts run() {
    before_the_planes();
    for (std::size_t i = 0; i < specs_.size(); ++i) plane(decoded_.planes[i], specs_[i]);
    over_all_planes();
    rewrite();
    behind_the_planes();
    facts_.features.assign(found_.begin(), found_.end());
    return std::move(facts_);
  }

 private:
  void add(std::string feature) { found_.insert(std::move(feature)); }
  void add_if(bool condition, const char* feature) {
    if (condition) add(feature);
  }

  void before_the_planes() {
    const std::int64_t end = decoded_.planes.front().bit_begin;
    for (std::int64_t bit = 0; bit + 32 <= end; bit += 8) {
      const std::uint32_t code = code_at(bytes_, bit);
      add_if(code == fba::kSequenceStart, "header.sequence");
      add_if(code == fba::kVisualObject, "header.visual_object");
      add_if(code == fba::kUserData, "header.user_data");
      if (code == fba::kObjectStart || code == fba::kOldObjectStart) {
        add(code == fba::kObjectStart ? "start.object" : "start_old.object");
        object_code_ = code;
        object_bit_ = bit;
        return;
      }
    }
  }

  void plane(const fba::Plane& plane, const PlaneSpec& spec) {
    ++facts_.planes;
    facts_.intra_planes += plane.intra;
    facts_.face_planes += fba::has_face(plane.object_mask);
    facts_.body_planes += fba::has_body(plane.object_mask);
    facts_.largest_plane_bits =
        std::max(facts_.largest_plane_bits, plane.bit_end - plane.bit_begin);
    objects_.insert(int(plane.object_mask));
    add(plane.intra ? (facts_.planes > 1 ? "plane.intra_again" : "plane.intra")
                    : "plane.predictive");
    add_if(spec.start_code == StartCode::old_plane, "start_old.plane");
    add_if(!spec.object_start.empty(), "start_again.object");
    temporal(plane);
    if (plane.intra && fba::has_face(plane.object_mask)) face_settings(spec.face);
    if (plane.intra && fba::has_body(plane.object_mask)) body_settings(spec.body);
    if (fba::has_face(plane.object_mask)) high_level(plane);
  }

  void temporal(const fba::Plane& plane) {
    const fba::TemporalHeader& temporal = plane.temporal;
    if (temporal.rate) {
      const bool change = last_rate_ && *last_rate_ != *temporal.rate;
      add_if(change, "rate_odd.change");
      add_if(temporal.rate->sixteenths != 0, "rate_odd.sixteenths");
      add_if(temporal.rate->frequency_offset, "rate_odd.offset");
      add_if(temporal.rate->sixteenths == 0 && !temporal.rate->frequency_offset, "rate.whole");
      last_rate_ = temporal.rate;
    } else if (!last_rate_ && plane.object_mask != fba::ObjectMask::nothing) {
      add("rate.default");
    }
    add_if(temporal.time_code.has_value(), "time.code");
    if (!temporal.skip) return;
    const std::uint32_t skip = *temporal.skip;
    add(skip == 0    ? "skip.0"
        : skip < 14  ? "skip.1_to_13"
        : skip == 14 ? "skip.14"
        : skip == 15 ? "skip.15"
        : skip < 30  ? "skip.16_to_29"
                     : "skip.30_or_more");
  }

  template <class Settings>
  static std::string flags(const Settings& settings) {
    std::string out;
    for (const bool send : settings.send_range) out += send ? '1' : '0';
    return out;
  }

  void face_settings(const fba::FaceSettings& face) {
    for (int g = 0; g < fap::kGroupCount; ++g) {
      add("mask.g" + two_digits(g + 1) + ".type" +
          std::to_string(int(face.mask_type[std::size_t(g)])));
    }
    add_if(face.mask.none(), "mask_empty.face");
    add(face.male ? "gender.male" : "gender.female");
    add(face.fap_quant == 0 ? "quant_zero.face" : "quant." + std::to_string(face.fap_quant));
    add("range_flags." + flags(face));
    bool kept = false;
    const bool new_quant = last_face_ && last_face_->fap_quant != face.fap_quant;
    for (std::size_t kind = 0; kind < 4; ++kind) {
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (!face.mask[fap]) continue;
        const bool sent = face.send_range[kind];
        if (sent) face_sent_[kind].set(fap);
        kept |= !sent;
        add_if(!face_sent_[kind][fap],
               kind < 2 ? "range_default.intra" : "range_default.predictive");
      }
    }
    if (last_face_) {
      add_if(kept, new_quant ? "range_rescaled.face" : "range_kept.same_quant");
      add_if(new_quant, "quant_change.face");
      add_if(last_face_->mask != face.mask || last_face_->mask_type != face.mask_type,
             "mask_change.face");
    }
    last_face_ = face;
  }

  void body_settings(const fba::BodySettings& body) {
    for (int g = 0; g < fba::kBodyGroupCount; ++g) {
      add("body_mask.g" + two_digits(g + 1) + ".type" +
          std::to_string(int(body.mask_type[std::size_t(g)])));
    }
    const bool zero = fba::kBapScale[std::size_t(body.bap_quant)] == 0;
    add(zero ? "quant_zero.body" : "body_quant." + std::to_string(body.bap_quant));
    add("body_flags." + flags(body));
    if (last_body_) {
      const bool kept = body.send_range != std::array<bool, 4>{true, true, true, true};
      const bool new_quant = last_body_->bap_quant != body.bap_quant;
      add_if(kept && new_quant, "range_rescaled.body");
      add_if(kept && !new_quant, "range_kept.same_quant");
      add_if(new_quant, "quant_change.body");
      add_if(last_body_->mask != body.mask, "mask_change.body");
    }
    last_body_ = body;
  }

  void high_level(const fba::Plane& plane) {
    const fap::Frame& face = plane.face;
    if (face.mask[1]) {
      add("viseme." + std::to_string(face.viseme.select1));
      add("viseme_second." + std::to_string(face.viseme.select2));
      add_if(face.viseme.blend != 0, "viseme_flag.blend");
      add_if(face.viseme.def, "viseme_flag.def");
    }
    if (face.mask[2]) {
      const fap::Expression& expression = face.expression;
      add("expression." + std::to_string(expression.select1));
      add("expression_second." + std::to_string(expression.select2));
      add_if(expression.intensity1 != 0 || expression.intensity2 != 0, "expression_flag.intensity");
      add_if(expression.init_face, "expression_flag.init_face");
      add_if(expression.def, "expression_flag.def");
    }
  }

  void over_all_planes() {
    constexpr const char* kNames[4] = {"object.nothing", "object.face", "object.body",
                                       "object.face_and_body"};
    for (const int object : objects_) add(kNames[object]);
    add_if(objects_.size() > 1, "object.mixed");
    int with_code = 0, intra_with_code = 0;
    for (const PlaneSpec& spec : specs_) {
      with_code += spec.start_code != StartCode::none;
      intra_with_code += spec.intra && spec.start_code != StartCode::none;
    }
    const bool only_intra = with_code == intra_with_code && with_code == facts_.intra_planes;
    add(with_code == 0               ? "plane_code.none"
        : with_code == facts_.planes ? "plane_code.all"
        : only_intra                 ? "plane_code.intra"
                                     : "plane_code.some");
  }

  // Whatever they say: bits between a plane and the start code of the next one.
  bool is_stuffing(std::int64_t bit) const {
    for (std::size_t i = 1; i < specs_.size(); ++i) {
      if (specs_[i].start_code != StartCode::none && bit >= decoded_.planes[i - 1].bit_end &&
          bit < decoded_.planes[i].bit_begin - 32) {
        return true;
      }
    }
    return false;
  }

  // Writes the planes again and looks at what the coder went through.
  void rewrite() {
    StreamWriter writer(object_code_);
    std::vector<std::size_t> begins;
    for (const PlaneSpec& spec : specs_) {
      alphabets(writer, spec);
      const Expected written = writer.write(spec);
      if (spec.start_code == StartCode::none && spec.object_start.empty()) {
        begins.push_back(written.bit_begin);
      }
    }
    for (const std::size_t begin : begins) {
      if (facts_.ambiguous_bit < 0 && looks_like_the_end(writer.bits().bit, begin)) {
        facts_.ambiguous_bit = object_bit_ + std::int64_t(begin);
      }
    }
    const CoderTrace& trace = writer.trace();
    const std::vector<std::uint8_t>& bit = writer.bits().bit;
    std::size_t same = 0;
    const std::size_t begin = std::size_t(object_bit_);
    while (same < bit.size() && begin + same < bytes_.size() * 8 &&
           (bit[same] == ((bytes_[(begin + same) / 8] >> (7 - (begin + same) % 8)) & 1) ||
            is_stuffing(std::int64_t(begin + same)))) {
      ++same;
    }
    facts_.same_when_rewritten = same == bit.size();
    if (!facts_.same_when_rewritten) facts_.first_difference_bit = std::int64_t(begin + same);
    add_if(trace.symbols > 0, "coder.adaptive");
    add_if(trace.stuffed > 0, "coder_trap.stuffed");
    add_if(trace.halved > 0, "coder_trap.halved");
    add_if(trace.empty_segments > 0, "coder_trap.empty_segment");
    add_if(zeros_behind_segment(trace, bit), "coder_trap.zeros_behind_segment");
    for (const fba::Plane& plane : decoded_.planes) {
      add_if(start_code_inside(bytes_, std::size_t(plane.bit_begin), std::size_t(plane.bit_end)),
             "coder_trap.start_code_inside");
    }
  }

  void alphabets(const StreamWriter& writer, const PlaneSpec& spec) {
    const auto seen = [&](int low, int high) {
      facts_.largest_alphabet = std::max(facts_.largest_alphabet, high - low + 1);
      add_if(high == low, "range.one_symbol");
      add_if(high - low == 60 || high - low == 120, "range.smallest");
      add_if(high - low == 3720, "range.largest");
    };
    if (fba::has_face(spec.object_mask)) {
      const fap::Mask& mask = spec.intra ? spec.face.mask : writer.face_settings().mask;
      for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
        if (!mask[fap]) continue;
        const auto [low, high] = writer.fap_range(spec, fap);
        seen(low, high);
      }
      for (int which = 0; which < kHighCount; ++which) {
        if (!mask[which <= kBlend ? 1 : 2]) continue;
        const int limit = writer.high_range(spec, which);
        facts_.largest_alphabet =
            std::max(facts_.largest_alphabet, spec.intra ? limit + 1 : 2 * limit + 1);
      }
    }
    if (fba::has_body(spec.object_mask)) {
      const auto& mask = spec.intra ? spec.body.mask : writer.body_settings().mask;
      for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) {
        if (!mask[bap]) continue;
        const auto [low, high] = writer.bap_range(spec, bap);
        seen(low, high);
      }
    }
  }

  void behind_the_planes() {
    const std::int64_t last = decoded_.planes.back().bit_end;
    const std::int64_t border = (last / 8 + 1) * 8;
    std::int64_t end = -1;
    if (code_at(bytes_, last) == fba::kSequenceEnd) {
      add("end_odd.unstuffed");
      end = last + 32;
    } else if (code_at(bytes_, border) == fba::kSequenceEnd) {
      add(last % 8 == 0 ? "end.aligned" : "end.stuffed");
      end = border + 32;
    } else {
      add("end_odd.missing");
    }
    add_if(end >= 0 && end < std::int64_t(bytes_.size()) * 8, "end_odd.bytes_behind");
  }

  std::span<const std::uint8_t> bytes_;
  const fba::DecodedStream& decoded_;
  const std::vector<PlaneSpec>& specs_;
  StreamFacts facts_;
  std::set<std::string> found_;
  std::set<int> objects_;
  std::uint32_t object_code_ = fba::kObjectStart;
  std::int64_t object_bit_ = 0;
  std::optional<fba::CodedRate> last_rate_;
  std::optional<fba::FaceSettings> last_face_;
  std::optional<fba::BodySettings> last_body_;
  std::array<fap::Mask, 4> face_sent_;
};

}  // namespace

StreamFacts analyse(std::span<const std::uint8_t> bytes, const fba::DecodedStream& decoded) {
  const std::vector<PlaneSpec> specs = plane_specs(bytes, decoded);
  StreamFacts facts = Collector(bytes, decoded, specs).run();
  sort_features(facts.features);
  return facts;
}

}  // namespace animeme::conformance
