#include "conformance/stream_writer.h"

#include "fap/tables.h"

namespace animeme::conformance {
namespace {

using Groups = std::vector<std::vector<int>>;

// FAP 3..68 by group, in the order of the stream.
const Groups& groups_of(const fba::FaceSettings&) {
  static const Groups groups = [] {
    Groups out;
    for (std::size_t g = 1; g < fap::kGroupCount; ++g) {
      out.emplace_back();
      for (int i = 0; i < fap::kGroups[g].size; ++i)
        out.back().push_back(fap::kGroups[g].first + i);
    }
    return out;
  }();
  return groups;
}

// BAPs likewise.
const Groups& groups_of(const fba::BodySettings&) {
  static const Groups groups = [] {
    Groups out;
    std::size_t slot = 0;
    for (const int size : fba::kBodyGroupSizes) {
      out.emplace_back();
      for (int i = 0; i < size; ++i) out.back().push_back(fba::kBapOrder[slot++]);
    }
    return out;
  }();
  return groups;
}

const std::vector<int>& bap_steps() {
  static const std::vector<int> steps = [] {
    std::vector<int> out(fba::kBapCount + 1);
    for (std::size_t slot = 0; slot < fba::kBapCount; ++slot) {
      out[fba::kBapOrder[slot]] = fba::kBapSteps[slot];
    }
    return out;
  }();
  return steps;
}

int one_if_zero(int divisor) { return divisor == 0 ? 1 : divisor; }
int divisor_of(const fba::FaceSettings& settings) { return one_if_zero(settings.fap_quant); }
int divisor_of(const fba::BodySettings& settings) {
  return one_if_zero(fba::kBapScale[std::size_t(settings.bap_quant)]);
}

std::int64_t step_of(const fba::FaceSettings& settings, int fap) {
  return settings.fap_quant == 0 ? 1 : fap::info(fap).quant_step * settings.fap_quant;
}
std::int64_t step_of(const fba::BodySettings& settings, int bap) {
  const int scale = fba::kBapScale[std::size_t(settings.bap_quant)];
  return scale == 0 ? 1 : bap_steps()[std::size_t(bap)] * scale;
}

// Ranges that were never sent (codec/bitstream.md, section 3.2). The body has none.
int default_range(const fba::FaceSettings&, int kind, int fap, int divisor) {
  const fap::FapInfo& info = fap::info(fap);
  const int range = kind < 2 ? info.default_i_range : info.default_p_range;
  return (range + 59) / 60 * 60 / divisor;
}
int default_range(const fba::BodySettings&, int, int, int) { return 0; }

template <class Family, class Settings>
int range_after(const Family& family, const Settings& settings, int kind, std::size_t number) {
  const int divisor = divisor_of(settings);
  const std::size_t k = std::size_t(kind);
  if (settings.send_range[k]) return settings.range[k][number] * 60 / divisor;
  return family.known ? family.range[k][number]
                      : default_range(settings, kind, int(number), divisor);
}

template <class Family, class Settings>
StreamWriter::Range range_of(const Family& family, const Settings& settings, bool intra,
                             std::size_t number) {
  if (!intra) {
    return {-family.range[fba::kPredictiveMin][number], family.range[fba::kPredictiveMax][number]};
  }
  return {-range_after(family, settings, fba::kIntraMin, number),
          range_after(family, settings, fba::kIntraMax, number)};
}

int high_limit(const fba::FaceSettings& settings, int which) {
  if (which == kSelect1 || which == kSelect2) return 14;
  if (which == kExpression1 || which == kExpression2) return 6;
  const int quant = settings.fap_quant;
  return quant == 0 ? 63 : (63 + quant / 2) / quant;
}

}  // namespace

bool is_selection(int which) {
  return which == kSelect1 || which == kSelect2 || which == kExpression1 || which == kExpression2;
}

bool zeros_behind_segment(const CoderTrace& trace, const std::vector<std::uint8_t>& bit) {
  for (std::size_t i = 0; i < trace.segment_end.size(); ++i) {
    int zeros = trace.zeros_at_end[i];
    const std::size_t end = trace.segment_end[i];
    for (std::size_t k = end; k < end + 14 && k < bit.size() && bit[k] == 0; ++k) ++zeros;
    if (zeros >= 22) return true;
  }
  return false;
}

bool start_code_inside(std::span<const std::uint8_t> bytes, std::size_t begin, std::size_t end) {
  for (std::size_t at = (begin + 7) / 8; at * 8 + 24 <= end; ++at) {
    if (bytes[at] == 0 && bytes[at + 1] == 0 && bytes[at + 2] == 1) return true;
  }
  return false;
}

bool looks_like_the_end(const std::vector<std::uint8_t>& bit, std::size_t plane_begin) {
  const std::size_t border = (plane_begin / 8 + 1) * 8;
  for (std::size_t k = border; k < border + 23; ++k) {
    if (k >= bit.size() || bit[k] != 0) return false;
  }
  return true;
}

StreamWriter::StreamWriter(std::uint32_t object_code) {
  bits_.put(object_code, 32);
  for (auto* family : {&face_, &body_}) {
    const std::size_t count = family == &face_ ? fap::kFapCount + 1 : fba::kBapCount + 1;
    for (auto& range : family->range) range.assign(count, 0);
    family->model.resize(count);
    family->value.assign(count, 0);
  }
}

StreamWriter::Range StreamWriter::fap_range(const PlaneSpec& plane, std::size_t fap) const {
  return range_of(face_, plane.face, plane.intra, fap);
}

StreamWriter::Range StreamWriter::bap_range(const PlaneSpec& plane, std::size_t bap) const {
  return range_of(body_, plane.body, plane.intra, bap);
}

int StreamWriter::high_range(const PlaneSpec& plane, int which) const {
  return high_limit(plane.intra ? plane.face : face_settings_, which);
}

Expected StreamWriter::write(const PlaneSpec& plane) {
  markers_ = 0;
  bad_stuffing_ = plane.damage == Damage::stuffed_bit;
  if (plane.start_code != StartCode::none) {
    bits_.stuff();
    bits_.put(plane.start_code == StartCode::plane ? fba::kPlaneStart : fba::kOldPlaneStart, 32);
  }
  if (!plane.object_start.empty()) bits_.stuff();
  for (const std::uint8_t byte : plane.object_start) bits_.put(byte, 8);
  Expected expected;
  expected.intra = plane.intra;
  expected.object_mask = plane.object_mask;
  expected.bit_begin = bits_.bit.size();
  expected.face.number = number_;
  expected.body.number = number_;
  number_ += 1 + std::int64_t(plane.temporal.skip.value_or(0));
  bits_.put(plane.intra, 1);
  bits_.put(std::uint32_t(plane.object_mask), 2);
  if (plane.object_mask != fba::ObjectMask::nothing) temporal(plane);
  if (fba::has_face(plane.object_mask)) write_face(plane, expected);
  if (fba::has_body(plane.object_mask)) write_body(plane, expected);
  expected.bit_end = bits_.bit.size();
  return expected;
}

std::vector<std::uint8_t> StreamWriter::finish() {
  bits_.stuff();
  bits_.put(fba::kSequenceEnd, 32);
  return bits_.bytes();
}

void StreamWriter::marker(const PlaneSpec& plane) {
  bits_.put(plane.damage == Damage::marker && markers_ == plane.damage_at ? 0 : 1, 1);
  ++markers_;
}

void StreamWriter::temporal(const PlaneSpec& plane) {
  if (plane.intra) {
    const bool zero = plane.damage == Damage::rate_zero;
    bits_.put(plane.temporal.rate.has_value() || zero, 1);
    if (zero) {
      bits_.put(0, 13);
    } else if (plane.temporal.rate) {
      bits_.put(plane.temporal.rate->frame_rate, 8);
      bits_.put(plane.temporal.rate->sixteenths, 4);
      bits_.put(plane.temporal.rate->frequency_offset, 1);
    }
    bits_.put(plane.temporal.time_code.has_value(), 1);
    if (plane.temporal.time_code) {
      bits_.put(plane.temporal.time_code->hours, 5);
      bits_.put(plane.temporal.time_code->minutes, 6);
      marker(plane);
      bits_.put(plane.temporal.time_code->seconds, 6);
    }
  }
  bits_.put(plane.temporal.skip.has_value(), 1);
  if (!plane.temporal.skip) return;
  std::uint32_t rest = *plane.temporal.skip;
  for (; rest >= 15; rest -= 15) bits_.put(15, 4);
  bits_.put(rest, 4);
}

void StreamWriter::face_header(const PlaneSpec& plane) {
  const fba::FaceSettings& settings = plane.face;
  bits_.put(std::uint32_t(settings.fap_quant), 5);
  for (std::size_t g = 0; g < fap::kGroupCount; ++g) {
    marker(plane);
    bits_.put(std::uint32_t(settings.mask_type[g]), 2);
    const int type = int(settings.mask_type[g]);
    for (int i = 0; i < fap::kGroups[g].size; ++i) {
      if (type == 1 || type == 2) {
        bits_.put(settings.mask[std::size_t(fap::kGroups[g].first + i)], 1);
      }
    }
  }
  bits_.put(settings.male, 1);
  bits_.put(plane.damage == Damage::dct_face, 1);
  write_ranges(plane, settings);
}

void StreamWriter::body_header(const PlaneSpec& plane) {
  const fba::BodySettings& settings = plane.body;
  bits_.put(std::uint32_t(settings.bap_quant), 5);
  const Groups& groups = groups_of(settings);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    marker(plane);
    const bool damaged = plane.damage == Damage::body_type2 && int(g) == plane.damage_at;
    const std::uint32_t type = damaged ? 2 : std::uint32_t(settings.mask_type[g]);
    bits_.put(type, 2);
    if (type != 1 && type != 2) continue;
    for (const int bap : groups[g]) bits_.put(settings.mask[std::size_t(bap)], 1);
  }
  bits_.put(settings.male, 1);
  bits_.put(plane.damage == Damage::dct_body, 1);
  write_ranges(plane, settings);
}

template <class Settings>
void StreamWriter::write_ranges(const PlaneSpec& plane, const Settings& settings) {
  for (const bool send : settings.send_range) bits_.put(send, 1);
  for (std::size_t kind = 0; kind < 4; ++kind) {
    if (!settings.send_range[kind]) continue;
    for (const std::vector<int>& group : groups_of(settings)) {
      for (std::size_t i = 0; i < group.size(); ++i) {
        if (i % 4 == 0) marker(plane);
        const std::size_t number = std::size_t(group[i]);
        if (settings.mask[number]) bits_.put(settings.range[kind][number], 5);
      }
    }
  }
}

template <class Settings>
void StreamWriter::install(Family& family, const Settings& settings) {
  const int divisor = divisor_of(settings);
  for (const auto& group : groups_of(settings)) {
    for (const int number : group) {
      const std::size_t n = std::size_t(number);
      for (std::size_t kind = 0; kind < 4; ++kind) {
        int& range = family.range[kind][n];
        if (!family.known) range = default_range(settings, int(kind), number, divisor);
        if (settings.mask[n] && settings.send_range[kind]) {
          range = settings.range[kind][n] * 60 / divisor;
        }
      }
      if (!settings.mask[n]) continue;
      family.model[n].reset(family.range[fba::kPredictiveMax][n] +
                            family.range[fba::kPredictiveMin][n] + 1);
    }
  }
  family.known = true;
}

void StreamWriter::write_face(const PlaneSpec& plane, Expected& expected) {
  if (plane.intra) {
    face_header(plane);
    face_settings_ = plane.face;
    install(face_, face_settings_);
    for (int which = 0; which < kHighCount; ++which) {
      high_.model[std::size_t(which)].reset(2 * high_limit(face_settings_, which) + 1);
    }
  }
  const fap::Mask& mask = face_settings_.mask;
  fap::Frame& frame = expected.face;
  frame.mask = mask;
  const auto& high = high_.value;
  if (mask[1]) {
    write_high(plane, kSelect1, kBlend);
    bits_.put(plane.viseme_def, 1);
    frame.viseme = {high[kSelect1], high[kSelect2], high[kBlend], plane.viseme_def};
  }
  if (mask[2]) {
    write_high(plane, kExpression1, kIntensity2);
    bits_.put(plane.init_face, 1);
    bits_.put(plane.expression_def, 1);
    frame.expression = {high[kExpression1], high[kIntensity1], high[kExpression2],
                        high[kIntensity2],  plane.init_face,   plane.expression_def};
  }
  write_values(plane, face_, face_settings_, plane.fap);
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (mask[fap]) frame.value[fap] = face_.value[fap];
  }
}

void StreamWriter::write_body(const PlaneSpec& plane, Expected& expected) {
  if (plane.intra) {
    body_header(plane);
    body_settings_ = plane.body;
    install(body_, body_settings_);
  }
  write_values(plane, body_, body_settings_, plane.bap);
  expected.body.mask = body_settings_.mask;
  for (std::size_t bap = 1; bap <= fba::kBapCount; ++bap) {
    if (body_settings_.mask[bap]) expected.body.value[bap] = body_.value[bap];
  }
}

void StreamWriter::write_high(const PlaneSpec& plane, int first, int last) {
  SegmentWriter segment(bits_, trace_, bad_stuffing_);
  for (int which = first; which <= last; ++which) {
    const std::size_t w = std::size_t(which);
    const int limit = high_limit(face_settings_, which);
    const int step = is_selection(which) ? 1 : one_if_zero(face_settings_.fap_quant);
    if (plane.intra) {
      Frequencies flat;
      flat.reset(limit + 1);
      segment.encode(flat, std::size_t(plane.high[w]));
      high_.value[w] = plane.high[w] * step;
    } else {
      const std::size_t symbol = std::size_t(plane.high[w] + limit);
      segment.encode(high_.model[w], symbol);
      high_.model[w].update(symbol);
      high_.value[w] += plane.high[w] * step;
    }
  }
  segment.flush();
}

template <class Settings, class Levels>
void StreamWriter::write_values(const PlaneSpec& plane, Family& family, const Settings& settings,
                                const Levels& levels) {
  SegmentWriter segment(bits_, trace_, bad_stuffing_);
  for (const auto& group : groups_of(settings)) {
    for (const int number : group) {
      const std::size_t n = std::size_t(number);
      if (!settings.mask[n]) continue;
      const std::int64_t change = levels[n] * step_of(settings, number);
      if (plane.intra) {
        Frequencies flat;
        flat.reset(family.range[fba::kIntraMax][n] + family.range[fba::kIntraMin][n] + 1);
        segment.encode(flat, std::size_t(levels[n] + family.range[fba::kIntraMin][n]));
        family.value[n] = std::int32_t(change);
      } else {
        const std::size_t symbol = std::size_t(levels[n] + family.range[fba::kPredictiveMin][n]);
        const bool before = family.model[n].halved;
        segment.encode(family.model[n], symbol);
        family.model[n].update(symbol);
        if (!before && family.model[n].halved) ++trace_.halved;
        family.value[n] += std::int32_t(change);
      }
    }
  }
  segment.flush();
}

}  // namespace animeme::conformance
