#include "tools/media/live/rtp_input.h"

#include <algorithm>
#include <utility>

namespace animeme::media {
namespace {

constexpr double kSilence = 2;

ReorderBuffer::Counts sum(ReorderBuffer::Counts a, const ReorderBuffer::Counts& b) {
  a.received += b.received;
  a.lost += b.lost;
  a.late += b.late;
  a.duplicates += b.duplicates;
  a.reordered += b.reordered;
  return a;
}

}  // namespace

RtpInput::Taken RtpInput::add(std::span<const std::uint8_t> datagram, double now) {
  std::optional<RtpPacket> packet = read_rtp(datagram, settings_.bundle_id);
  if (!packet) return Taken::no;
  if (settings_.payload_type >= 0 && packet->payload_type != settings_.payload_type) {
    return Taken::no;
  }
  if (!ssrc_) ssrc_ = packet->ssrc;
  if (packet->ssrc != *ssrc_) return consider(std::move(*packet), now);
  bytes_ += std::int64_t(datagram.size());
  candidate_.clear();
  take(std::move(*packet), now);
  return Taken::yes;
}

void RtpInput::take(RtpPacket packet, double now) {
  last_heard_ = now;
  const std::uint32_t timestamp = packet.timestamp;
  if (buffer_.add(std::move(packet), now)) jitter_.add(timestamp, now, settings_.clock);
}

RtpInput::Taken RtpInput::consider(RtpPacket packet, double now) {
  const bool goes_on = !candidate_.empty() && candidate_.back().ssrc == packet.ssrc &&
                       std::uint16_t(candidate_.back().sequence + 1) == packet.sequence;
  if (!goes_on) candidate_.clear();
  candidate_.push_back(std::move(packet));
  const bool gone = bye_at_ || now - last_heard_ > kSilence;
  return candidate_.size() > 1 || gone ? Taken::restart : Taken::no;
}

void RtpInput::accept(double now) {
  if (candidate_.empty()) return;
  before_ = sum(before_, buffer_.counts());
  buffer_ = ReorderBuffer(settings_.limits);
  jitter_ = {};
  ssrc_ = candidate_.front().ssrc;
  bye_at_.reset();
  reported_expected_ = reported_received_ = 0;
  last_sr_ = 0;
  for (RtpPacket& packet : std::exchange(candidate_, {})) take(std::move(packet), now);
}

bool RtpInput::add_report(const RtcpReport& report, double now) {
  if (!report.sender || (ssrc_ && report.ssrc != *ssrc_)) return false;
  if (!ssrc_) ssrc_ = report.ssrc;
  last_sr_ = std::uint32_t(report.sender->ntp >> 16);
  last_sr_at_ = now;
  return true;
}

void RtpInput::add_bye(std::uint32_t ssrc, double now) {
  if (ssrc_ == ssrc && !bye_at_) bye_at_ = now;
}

ReportBlock RtpInput::report(double now) {
  const ReorderBuffer::Counts& counts = buffer_.counts();
  const std::int64_t expected = buffer_.expected() - reported_expected_;
  const std::int64_t received = counts.received - reported_received_;
  reported_expected_ += expected;
  reported_received_ += received;

  ReportBlock block;
  block.ssrc = ssrc_.value_or(0);
  const std::int64_t lost = std::max<std::int64_t>(0, expected - received);
  if (expected > 0)
    block.fraction = std::uint8_t(std::min<std::int64_t>(255, lost * 256 / expected));
  block.lost = std::int32_t(
      std::clamp<std::int64_t>(reported_expected_ - reported_received_, -0x800000, 0x7FFFFF));
  block.highest = buffer_.highest();
  block.jitter = std::uint32_t(jitter_.ticks());
  block.last_sr = last_sr_;
  if (last_sr_ != 0) block.since_sr = std::uint32_t(std::max(0.0, now - last_sr_at_) * 65536);
  return block;
}

ReorderBuffer::Counts RtpInput::counts() const { return sum(before_, buffer_.counts()); }

}  // namespace animeme::media
