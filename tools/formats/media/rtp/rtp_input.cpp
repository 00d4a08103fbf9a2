#include "tools/formats/media/rtp/rtp_input.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "tools/formats/media/rtp/wire_internal.h"

namespace animeme::media {
namespace {

constexpr double kSilence = 1;
constexpr double kControlSilence = 15;  // reports come every five seconds or so
constexpr int kNear = 16;               // sequence numbers
constexpr std::size_t kMostCandidates = 8;
constexpr std::size_t kMostEarlyBytes = 1 << 17;  // of a candidate, as are these
constexpr std::size_t kMostEarly = 256;
constexpr std::size_t kMostReports = 8;

ReorderBuffer::Counts sum(ReorderBuffer::Counts a, const ReorderBuffer::Counts& b) {
  a.received += b.received;
  a.lost += b.lost;
  a.late += b.late;
  a.duplicates += b.duplicates;
  a.reordered += b.reordered;
  return a;
}

bool begins_unit(std::span<const std::uint8_t> payload) {
  return payload.size() > 4 && payload[0] == 0 && payload[1] == 0 && payload[2] == 1 &&
         payload[3] >= 0xB0;
}

}  // namespace

RtpInput::Taken RtpInput::add(std::span<const std::uint8_t> datagram, const UdpAddress& from,
                              double now) {
  std::optional<RtpPacket> packet = read_rtp(datagram, settings_.bundle_id);
  const bool ours =
      packet && (settings_.payload_type < 0 || packet->payload_type == settings_.payload_type);
  if (ours && hears(datagram, from)) {
    take(std::move(*packet), datagram.size(), now);
    return Taken::yes;
  }
  ++foreign_;
  if (!ours) return Taken::no;
  return consider(*packet, {{datagram.begin(), datagram.end()}, from, now});
}

bool RtpInput::hears(std::span<const std::uint8_t> datagram, const UdpAddress& from) const {
  WireReader in(datagram);
  in.take(8);  // flags, type, sequence number, timestamp
  return ssrc_ == in.u32() && !in.failed() && (settings_.any_source || from == from_);
}

void RtpInput::take(RtpPacket packet, std::size_t size, double now) {
  bytes_ += std::int64_t(size);
  last_heard_ = now;
  const std::uint32_t timestamp = packet.timestamp;
  if (buffer_.add(std::move(packet), now)) jitter_.add(timestamp, now, settings_.clock);
}

RtpInput::Taken RtpInput::consider(const RtpPacket& packet, Early datagram) {
  const double now = datagram.at;
  const auto same = [&](const Candidate& each) {
    return each.ssrc == packet.ssrc && (settings_.any_source || each.from == datagram.from);
  };
  auto found = std::find_if(candidates_.begin(), candidates_.end(), same);
  if (found == candidates_.end()) {
    if (candidates_.size() >= kMostCandidates) {  // the one that was heard longest ago
      candidates_.erase(std::min_element(candidates_.begin(), candidates_.end(),
                                         [](const auto& a, const auto& b) {
                                           return a.datagrams.back().at < b.datagrams.back().at;
                                         }));
    }
    candidates_.push_back({packet.ssrc, datagram.from, now, {}});
    found = std::prev(candidates_.end());
  }
  Candidate& who = *found;
  const int step = std::int16_t(packet.sequence - who.sequence);
  if (!who.datagrams.empty() && std::abs(step) <= kNear) who.follows = true;
  who.sequence = packet.sequence;
  who.begins = who.begins || !settings_.face || begins_unit(packet.payload);
  who.bytes += datagram.bytes.size();
  who.datagrams.push_back(std::move(datagram));
  while (who.datagrams.size() > 1 &&
         (who.datagrams.size() > kMostEarly || who.bytes > kMostEarlyBytes)) {
    who.bytes -= who.datagrams.front().bytes.size();
    who.datagrams.pop_front();
  }
  if (!proved(who) || !may_take_over(who, now)) return Taken::no;
  chosen_ = std::move(who);
  candidates_.erase(found);
  if (ssrc_) return Taken::restart;
  accept();
  return Taken::yes;
}

bool RtpInput::proved(const Candidate& candidate) const {
  return candidate.begins && (candidate.follows || settings_.ssrc == candidate.ssrc);
}

bool RtpInput::may_take_over(const Candidate& candidate, double now) const {
  const bool described = settings_.ssrc == candidate.ssrc;
  if (!ssrc_) {
    // The one that was described may be about to come.
    const bool expected = settings_.ssrc && !renewed_;
    return described || !expected || now - candidate.begin > kSilence;
  }
  if (now - last_heard_ > kSilence || (described && ssrc_ != candidate.ssrc)) return true;
  return !settings_.any_source && ssrc_ != candidate.ssrc && candidate.from == from_ &&
         from_ != UdpAddress();
}

void RtpInput::accept() {
  renewed_ = ssrc_.has_value();
  before_ = counts();
  buffer_ = buffer_.renewed();
  jitter_ = {};
  ssrc_.reset();
  bye_at_.reset();
  from_ = control_ = {};
  reported_expected_ = reported_received_ = 0;
  last_sr_ = 0;
  if (!chosen_) return;
  ssrc_ = chosen_->ssrc;
  from_ = chosen_->from;
  foreign_ -= std::int64_t(chosen_->datagrams.size());
  for (const Early& each : chosen_->datagrams) {
    if (auto packet = read_rtp(each.bytes, settings_.bundle_id)) {
      take(std::move(*packet), each.bytes.size(), each.at);
    }
  }
  chosen_.reset();
}

std::vector<RtpInput::Early> RtpInput::early() const {
  std::vector<Early> all;
  for (const Candidate& each : candidates_) {
    all.insert(all.end(), each.datagrams.begin(), each.datagrams.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return all;
}

// Reports come from another port as a rule: the first one that has the identifier at the host of
// the sender, as long as it is heard.
bool RtpInput::is_control(std::uint32_t ssrc, const UdpAddress& from, double now) {
  if (ssrc_ != ssrc) return false;
  if (settings_.any_source || from == from_) return true;
  if (!from.same_host(from_)) return false;
  const bool silent = control_ == UdpAddress() || now - control_heard_ > kControlSilence;
  if (!silent && control_ != from) return false;
  control_ = from;
  control_heard_ = now;
  return true;
}

bool RtpInput::add_report(const RtcpReport& report, const UdpAddress& from, double now) {
  if (!report.sender) return false;
  if (!is_control(report.ssrc, from, now)) {
    if (ssrc_ == report.ssrc) {
      ++foreign_;
      return false;
    }
    if (early_reports_.size() >= kMostReports) early_reports_.pop_front();
    early_reports_.push_back({report.ssrc, from, *report.sender});
    return false;
  }
  last_sr_ = std::uint32_t(report.sender->ntp >> 16);
  last_sr_at_ = now;
  return true;
}

std::optional<SenderInfo> RtpInput::take_report() {
  std::optional<SenderInfo> last;
  std::erase_if(early_reports_, [&](const EarlyReport& each) {
    if (each.ssrc != ssrc_) return false;
    if (settings_.any_source || each.from.same_host(from_)) {
      last = each.info;
      control_ = each.from;
      control_heard_ = last_heard_;
    }
    return true;
  });
  return last;
}

bool RtpInput::add_bye(std::uint32_t ssrc, const UdpAddress& from, double now) {
  if (!is_control(ssrc, from, now)) {
    ++foreign_;
    return false;
  }
  if (!bye_at_) bye_at_ = now;
  return true;
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
