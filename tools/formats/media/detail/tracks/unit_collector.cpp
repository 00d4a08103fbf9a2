#include "tools/formats/media/detail/tracks/unit_collector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/decode/plane_header.h"
#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {
namespace {

constexpr std::int64_t kLatest = std::int64_t(1) << 47;

}  // namespace

UnitCollector::UnitCollector(const ReadOptions& options, std::vector<std::uint8_t> config,
                             bool shared)
    : options_(options), config_(std::move(config)) {
  if (shared) cutter_.emplace();
}

void UnitCollector::lose() {
  ++lost_;
  wait_for_intra_ = true;  // predicted planes build on the lost one
  if (cutter_) cutter_->gap();
}

Error UnitCollector::too_long() const {
  return make_error(Code::out_of_range, "the face track is longer than the limit of " +
                                            std::to_string(options_.max_units) + " planes or " +
                                            std::to_string(options_.max_bytes) +
                                            " bytes; raise the limit");
}

// A packet without a start code is a further part of a unit that was too large for one, if it has
// the time of that unit or none of its own.
bool UnitCollector::continues(const AVPacket& packet) const {
  if (units_.empty() || wait_for_intra_ || (packet.flags & AV_PKT_FLAG_CORRUPT) != 0) return false;
  return packet.pts == AV_NOPTS_VALUE || packet.pts == units_.back().time;
}

Result<void> UnitCollector::append(std::span<const std::uint8_t> bytes) {
  if (bytes_ + bytes.size() > options_.max_bytes) return too_long();
  bytes_ += bytes.size();
  if (cutter_) cutter_->gap();
  std::vector<std::uint8_t>& unit = units_.back().bytes;
  unit.insert(unit.end(), bytes.begin(), bytes.end());
  return {};
}

Result<void> UnitCollector::add(const AVPacket& packet, AVRational time_base) {
  if (packet.data == nullptr || packet.size <= 0) return {};
  base_ = time_base;
  std::span<const std::uint8_t> bytes(packet.data, std::size_t(packet.size));
  const VisualHeaders headers = read_visual_headers(bytes);
  if (headers.size > 0 && config_.empty() && headers.kind == VisualKind::face) {
    config_.assign(bytes.begin(), bytes.begin() + std::ptrdiff_t(headers.size));
  }
  bytes = bytes.subspan(headers.size);
  const std::optional<bool> intra = read_is_intra(bytes);
  if (!intra && continues(packet)) return append(bytes);
  if (!intra || (packet.flags & AV_PKT_FLAG_CORRUPT) != 0) {
    if (!bytes.empty()) lose();
    return {};
  }
  if (wait_for_intra_ && !*intra) {
    ++lost_;
    return {};
  }
  std::int64_t time = packet.pts != AV_NOPTS_VALUE ? packet.pts : packet.dts;
  if (time == AV_NOPTS_VALUE && !units_.empty()) time = units_.back().time + last_duration_;
  if (time == AV_NOPTS_VALUE) time = 0;
  if (time < -kLatest || time > kLatest || (!units_.empty() && time <= units_.back().time)) {
    ++late_;
    lose();
    return {};
  }
  if (units_.size() >= options_.max_units || bytes_ + bytes.size() > options_.max_bytes) {
    return too_long();
  }
  if (wait_for_intra_ && lost_ > 0) gaps_.push_back(units_.size());
  wait_for_intra_ = false;
  lost_before_ = lost_;
  bytes_ += bytes.size();
  last_duration_ = packet.duration > 0 && packet.duration < kLatest ? packet.duration : 0;
  std::vector<PlaneCutter::Piece> pieces{{bytes.size(), 0}};
  if (cutter_) pieces = cutter_->cut(bytes, *intra);
  if (pieces.size() > 1) last_duration_ = 0;  // that of all of them
  for (const PlaneCutter::Piece& piece : pieces) {
    const std::int64_t later = std::llround(piece.seconds / av_q2d(time_base));
    units_.push_back({{bytes.begin(), bytes.begin() + std::ptrdiff_t(piece.size)},
                      read_is_intra(bytes).value_or(false),
                      time + later,
                      last_duration_});
    bytes = bytes.subspan(piece.size);
  }
  return {};
}

void UnitCollector::set_durations() {
  for (std::size_t i = 0; i + 1 < units_.size(); ++i) {
    units_[i].duration = units_[i + 1].time - units_[i].time;
  }
  fba::AccessUnit& last = units_.back();
  if (last.duration > 0) return;
  if (units_.size() > 1) last.duration = units_[units_.size() - 2].duration;
  // A single plane has no duration: one frame at 25 frames a second.
  else
    last.duration = std::max<std::int64_t>(1, base_.den / (25 * std::int64_t(base_.num)));
}

void add_damage_at_end(Container& file, std::string reason, std::int64_t frames) {
  fba::Damage& end = file.damage.emplace_back();
  const fba::AccessUnit& last = file.face.units.back();
  end.seconds = double(last.time + last.duration) / file.face.timescale;
  end.frames = frames;
  end.reason = std::move(reason);
}

void UnitCollector::find_gaps(bool noticed) {
  constexpr double kRoom = 0.75;      // of a frame
  constexpr std::size_t kUsual = 20;  // more than one in so many: their times mean something else
  std::vector<std::size_t> found;
  fap::Rate rate{30, 1};
  std::size_t jumps = 0;
  double expected = 0;  // time of the next unit, in seconds; of the first its own
  for (std::size_t i = 0; i < units_.size(); ++i) {
    const auto header = fba::read_plane_header(units_[i].bytes);
    if (!header) continue;
    if (header->temporal.rate) rate = header->temporal.rate->rate();
    const double time = double(units_[i].time) * av_q2d(base_);
    if (i > 0 && time - expected > rate.seconds(kRoom)) {
      ++jumps;
      if (noticed || !header->intra) found.push_back(i);
    }
    expected = time + rate.seconds(1 + double(header->temporal.skip.value_or(0)));
  }
  if (jumps > 1 + units_.size() / kUsual) return;
  gaps_.insert(gaps_.end(), found.begin(), found.end());
  std::sort(gaps_.begin(), gaps_.end());
}

Result<void> UnitCollector::finish(std::int64_t shift, Container& result) {
  if (lost_ > 0 && !options_.repair) {
    result.warnings.push_back(std::to_string(lost_) +
                              " planes are damaged or follow a damaged one and were left out");
  }
  if (late_ > 0) {
    result.warnings.push_back(std::to_string(late_) + " planes have time stamps out of order");
  }
  if (units_.empty()) {
    return make_error(Code::syntax, "the face track has no readable intra plane");
  }
  set_durations();
  for (fba::AccessUnit& unit : units_) {
    unit.time = (unit.time - shift) * base_.num;
    unit.duration *= base_.num;
  }
  if (read_visual_headers(config_).kind != VisualKind::face) {
    result.warnings.push_back(
        "the file does not state the face's configuration; Simple Face Animation is assumed");
    config_ = default_face_config();
  } else {
    result.visual_profile = read_visual_headers(config_).profile;
  }
  result.face.config = std::move(config_);
  result.face.timescale = std::uint32_t(base_.den);
  result.face.units = std::move(units_);
  return options_.repair ? repair(result) : Result<void>();
}

Result<void> UnitCollector::repair(Container& result) {
  auto damage = fba::repair_units(result.face, gaps_);
  if (!damage) {
    return make_error(Code::syntax,
                      "the face track has no readable intra plane: " + damage.error().message);
  }
  result.damage = std::move(*damage);
  if (wait_for_intra_) {
    add_damage_at_end(result, "planes at the end are damaged or follow a damaged one",
                      lost_ - lost_before_);
  }
  return {};
}

}  // namespace animeme::media
