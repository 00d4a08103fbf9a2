#include "tools/formats/inspect/bits.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>
#include <utility>
#include <vector>

#include "codec/syntax/arith.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/inspect/body_difference.h"

namespace animeme::inspect {

namespace {

using fba::BodySettings;
using fba::FaceSettings;

// --- headers, as codec/bitstream.md, sections 2, 3 and 7, lays them out

std::int64_t temporal_bits(const fba::Plane& plane) {
  std::int64_t bits = 1;  // skip_frames
  if (plane.temporal.skip) bits += 4 * (std::int64_t(*plane.temporal.skip) / 15 + 1);
  if (!plane.intra) return bits;
  return bits + 2 + (plane.temporal.rate ? 13 : 0) + (plane.temporal.time_code ? 18 : 0);
}

std::int64_t mask_bits(fba::MaskType type, int group_size) {
  const bool by_mask = type == fba::MaskType::hold || type == fba::MaskType::interpolate;
  return 3 + (by_mask ? group_size : 0);  // marker and type
}

int markers_of(int group_size) { return (group_size + 3) / 4; }

// Quantiser, gender, coding type, the range flags, and the range sets that are there.
template <class Settings>
std::int64_t settings_bits(const Settings& settings, int markers, std::int64_t coded) {
  const auto& send = settings.send_range;
  return 5 + 1 + 1 + 4 + std::count(send.begin(), send.end(), true) * (markers + 5 * coded);
}

std::int64_t settings_bits(const FaceSettings& face) {
  std::int64_t bits = 0;
  int markers = 0;
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    const int size = fap::kGroups[group].size;
    bits += mask_bits(face.mask_type[group], size);
    if (group > 0) markers += markers_of(size);
  }
  const int high = int(face.mask[1]) + int(face.mask[2]);
  return bits + settings_bits(face, markers, std::int64_t(face.mask.count()) - high);
}

std::int64_t settings_bits(const BodySettings& body) {
  std::int64_t bits = 0;
  int markers = 0;
  for (std::size_t group = 0; group < fba::kBodyGroupCount; ++group) {
    bits += mask_bits(body.mask_type[group], fba::kBodyGroupSizes[group]);
    markers += markers_of(fba::kBodyGroupSizes[group]);
  }
  return bits + settings_bits(body, markers, std::int64_t(body.mask.count()));
}

// --- values

// The models of one value, followed as the coder follows them.
class ValueCost {
 public:
  // Level limits: smallest and largest are magnitudes.
  void begin(std::int32_t p_min, std::int32_t p_max) {
    lowest_ = -p_min;
    model_.reset(std::uint32_t(p_min + p_max + 1));
  }
  double intra(std::int32_t value, std::int32_t i_min, std::int32_t i_max) {
    value_ = value;
    return std::log2(double(i_min + i_max + 1));
  }
  double predictive(std::int32_t value, std::int32_t step) {
    const std::int64_t level = (std::int64_t(value) - value_) / step;
    value_ = value;
    const std::uint32_t symbol = std::uint32_t(level - lowest_);
    if (symbol >= model_.size()) return 0;  // cannot come from a decoder
    const fba::SymbolInterval interval = model_.interval(symbol);
    model_.update(symbol);
    return std::log2(double(interval.total) / double(interval.high - interval.low));
  }

 private:
  fba::AdaptiveModel model_;
  std::int32_t lowest_ = 0;
  std::int32_t value_ = 0;
};

// The low-level FAPs, or the BAPs, by number.
template <std::size_t N>
class FamilyCost {
 public:
  // `first` parameter, and ranges in levels that hold until others are sent.
  explicit FamilyCost(std::size_t first) : first_(first), cost_(N) {}
  void set_range(std::size_t kind, std::size_t number, std::int32_t level) {
    range_[kind][number] = level;
  }

  template <class Settings, class Frame, class StepOf>
  void add(const Settings& settings, int scale, bool intra, const Frame& frame, StepOf step_of,
           std::array<double, N>& bits) {
    for (std::size_t number = first_; number < N; ++number) {
      if (!settings.mask[number]) continue;
      ValueCost& cost = cost_[number];
      if (!intra) {
        bits[number] += cost.predictive(frame.value[number], step_of(number));
        continue;
      }
      for (std::size_t kind = 0; kind < 4; ++kind) {
        if (settings.send_range[kind]) {
          range_[kind][number] = settings.range[kind][number] * 60 / scale;
        }
      }
      bits[number] += cost.intra(frame.value[number], range_[fba::kIntraMin][number],
                                 range_[fba::kIntraMax][number]);
      cost.begin(range_[fba::kPredictiveMin][number], range_[fba::kPredictiveMax][number]);
    }
  }

 private:
  std::size_t first_;
  std::vector<ValueCost> cost_;
  std::array<std::array<std::int32_t, N>, 4> range_{};
};

// FAP 1 and 2: fixed ranges, and flags outside the coder.
class HighLevelCost {
 public:
  void add(const FaceSettings& settings, bool intra, const fap::Frame& frame,
           std::array<double, fap::kFapCount + 1>& bits) {
    const std::int32_t blend = fba::blend_range(settings.fap_quant);
    const std::int32_t step = fba::fap_scale(settings.fap_quant);
    if (settings.mask[1]) {
      const fap::Viseme& v = frame.viseme;
      bits[1] += one(0, v.select1, 14, 1, intra) + one(1, v.select2, 14, 1, intra) +
                 one(2, v.blend, blend, step, intra) + 1;
    }
    if (settings.mask[2]) {
      const fap::Expression& e = frame.expression;
      bits[2] += one(3, e.select1, 6, 1, intra) + one(4, e.intensity1, blend, step, intra) +
                 one(5, e.select2, 6, 1, intra) + one(6, e.intensity2, blend, step, intra) + 2;
    }
  }

 private:
  double one(std::size_t which, std::int32_t value, std::int32_t max, std::int32_t step,
             bool intra) {
    if (!intra) return cost_[which].predictive(value, step);
    cost_[which].begin(max, max);
    return cost_[which].intra(value, 0, max);
  }

  std::array<ValueCost, 7> cost_;
};

class StreamCost {
 public:
  void add(const fba::Plane& plane, BitStatistics& out) {
    if (plane.face_settings) {
      const FaceSettings& face = *plane.face_settings;
      const int scale = fba::fap_scale(face.fap_quant);
      if (plane.intra) begin_face(scale);
      const auto step = [&](std::size_t fap) {
        return face.fap_quant == 0 ? 1 : fap::info(int(fap)).quant_step * scale;
      };
      high_.add(face, plane.intra, plane.face, out.ideal_fap_bits);
      face_.add(face, scale, plane.intra, plane.face, step, out.ideal_fap_bits);
    }
    if (plane.body_settings && plane.body) {
      const BodySettings& body = *plane.body_settings;
      const int scale = fba::bap_scale(body.bap_quant);
      const auto step = [&](std::size_t bap) {
        return body.bap_quant == 0 ? 1 : bap_step(int(bap)) * scale;
      };
      body_.add(body, scale, plane.intra, *plane.body, step, out.ideal_bap_bits);
    }
  }

 private:
  // codec/bitstream.md, section 3.2: the default ranges, scaled by the quantiser of the first intra
  // plane.
  void begin_face(int scale) {
    if (begun_) return;
    begun_ = true;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      const fap::FapInfo& info = fap::info(fap);
      for (std::size_t kind = 0; kind < 4; ++kind) {
        const int range = kind / 2 == 0 ? info.default_i_range : info.default_p_range;
        face_.set_range(kind, std::size_t(fap), (range + 59) / 60 * 60 / scale);
      }
    }
  }

  HighLevelCost high_;
  FamilyCost<fap::kFapCount + 1> face_{fap::kFirstLowLevel};
  FamilyCost<fba::kBapCount + 1> body_{1};
  bool begun_ = false;
};

// --- rates

PlaneBits plane_bits(std::vector<std::uint32_t> bits) {
  PlaneBits out;
  out.planes = bits.size();
  if (bits.empty()) return out;
  std::sort(bits.begin(), bits.end());
  const std::size_t half = bits.size() / 2;
  out.largest = bits.back();
  out.mean =
      double(std::accumulate(bits.begin(), bits.end(), std::int64_t(0))) / double(bits.size());
  out.median =
      bits.size() % 2 == 1 ? double(bits[half]) : (double(bits[half - 1]) + double(bits[half])) / 2;
  return out;
}

// The most bits of the planes that begin within one second. What stands before a plane counts with
// it.
class Window {
 public:
  void add(double seconds, std::int64_t bits) {
    planes_.emplace_back(seconds, bits);
    inside_ += bits;
    // A little less than a second, so that 25 planes a second are 25 and not 26 after rounding.
    while (seconds - planes_.front().first > 1 - 1e-9) {
      inside_ -= planes_.front().second;
      planes_.pop_front();
    }
    most_ = std::max(most_, inside_);
  }
  // With so many bits behind the last plane.
  std::int64_t most(std::int64_t rest) const { return std::max(most_, inside_ + rest); }

 private:
  std::deque<std::pair<double, std::int64_t>> planes_;
  std::int64_t inside_ = 0, most_ = 0;
};

}  // namespace

double BitStatistics::ideal_bits() const {
  const auto sum = [](const auto& bits) { return std::accumulate(bits.begin(), bits.end(), 0.0); };
  return sum(ideal_fap_bits) + sum(ideal_bap_bits);
}

std::int64_t header_bits(const fba::Plane& plane) {
  std::int64_t bits = 3;  // is_intra, fba_object_mask
  if (plane.object_mask == fba::ObjectMask::nothing) return bits;
  bits += temporal_bits(plane);
  if (!plane.intra) return bits;
  if (plane.face_settings) bits += settings_bits(*plane.face_settings);
  if (plane.body_settings) bits += settings_bits(*plane.body_settings);
  return bits;
}

struct BitMeter::Impl {
  BitStatistics out;
  StreamCost cost;
  std::vector<std::uint32_t> intra;
  std::vector<std::uint32_t> predictive;
  std::int64_t plane_total = 0;
  fap::Rate rate;  // of the first plane
  Window window;
  std::int64_t end = 0;
  std::int64_t number = -1;
};

BitMeter::BitMeter() : impl_(std::make_unique<Impl>()) {}
BitMeter::~BitMeter() = default;

void BitMeter::add(const fba::Plane& plane) {
  Impl& m = *impl_;
  if (m.number < 0) m.rate = plane.rate;
  const std::int64_t bits = plane.bit_end - plane.bit_begin;
  (plane.intra ? m.intra : m.predictive).push_back(std::uint32_t(bits));
  m.plane_total += bits;
  m.out.header_bits += header_bits(plane);
  m.cost.add(plane, m.out);
  m.window.add(m.rate.seconds(double(plane.number)), plane.bit_end - m.end);
  m.end = plane.bit_end;
  m.number = plane.number;
}

BitStatistics BitMeter::measured(std::size_t bytes) const {
  const Impl& m = *impl_;
  BitStatistics out = m.out;
  const std::int64_t total = std::int64_t(bytes) * 8;
  out.framing_bits = total - m.plane_total;
  out.value_bits = m.plane_total - out.header_bits;
  out.intra = plane_bits(m.intra);
  out.predictive = plane_bits(m.predictive);
  out.seconds = m.rate.seconds(double(m.number + 1));
  out.kbit_per_s = tools::kbit_per_s(bytes, out.seconds);
  out.peak_kbit_per_s = double(m.window.most(total - m.end)) / std::min(out.seconds, 1.0) * 1e-3;
  return out;
}

}  // namespace animeme::inspect
