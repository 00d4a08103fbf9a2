#include "tools/formats/media/detail/tracks/unit_collector.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "codec/decode/plane_header.h"
#include "tools/formats/media/detail/tracks/face_header.h"

namespace animeme::media {
namespace {

constexpr std::int64_t kLatest = std::int64_t(1) << 47;
constexpr double kRoom = 0.75;  // for a lost unit, of a frame

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
  if (passed_ + units_.size() >= options_.max_units || bytes_ + bytes.size() > options_.max_bytes) {
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
  if (!take_) return {};
  std::size_t whole = 0;
  for (; whole + 1 < units_.size(); ++whole) {
    units_[whole].duration = units_[whole + 1].time - units_[whole].time;
    if (auto done = pass(units_[whole]); !done) return done;
  }
  units_.erase(units_.begin(), units_.begin() + std::ptrdiff_t(whole));
  return {};
}

// The decoder tells whether there is something to repair; see fba::repair_units().
Result<void> UnitCollector::pass(fba::AccessUnit& unit) {
  if (const auto header = fba::read_plane_header(unit.bytes)) {
    if (header->temporal.rate) rate_ = header->temporal.rate->rate();
    const double time = double(unit.time) * av_q2d(base_);
    jumps_ = jumps_ || (passed_ > 0 && time - expected_ > rate_.seconds(kRoom));
    expected_ = time + rate_.seconds(1 + double(header->temporal.skip.value_or(0)));
  }
  if (passed_++ == 0) first_time_ = unit.time;
  last_passed_duration_ = unit.duration;
  decoder_.push(unit.bytes);
  for (;;) {
    const auto event = decoder_.next();
    if (!event) {
      intact_ = intact_ && event.error().code == Code::need_data;
      break;
    }
    intact_ = intact_ && event->kind != fba::Event::Kind::warning;
    decoded_ += event->kind == fba::Event::Kind::plane ? 1 : 0;
  }
  unit.duration *= base_.num;
  return take_(unit, config_);
}

Result<bool> UnitCollector::finish_passing(std::int64_t shift, bool find_gaps,
                                           FaceSummary& result) {
  const bool stated = read_visual_headers(config_).kind == VisualKind::face;
  if (units_.empty() || lost_ > 0 || late_ > 0 || !gaps_.empty() || !stated) return false;
  fba::AccessUnit& last = units_.back();
  const std::int64_t time = last.time;
  if (last.duration <= 0) {
    if (passed_ == 0) return false;
    last.duration = last_passed_duration_;
  }
  const std::int64_t duration = last.duration;
  if (auto done = pass(last); !done) return done.error();
  decoder_.push(fba::end_code());
  decoder_.finish();
  for (;;) {
    const auto event = decoder_.next();
    if (!event) {
      intact_ = intact_ && event.error().code == Code::end_of_stream;
      break;
    }
    intact_ = intact_ && event->kind != fba::Event::Kind::warning;
    decoded_ += event->kind == fba::Event::Kind::plane ? 1 : 0;
  }
  result.visual_profile = read_visual_headers(config_).profile;
  result.timescale = std::uint32_t(base_.den);
  result.units = passed_;
  result.start = (first_time_ - shift) * base_.num;
  result.end = (time + duration - shift) * base_.num;
  return intact_ && decoded_ == passed_ && !(find_gaps && jumps_);
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
