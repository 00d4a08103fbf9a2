// Receiver reports.
#include <algorithm>

#include "tools/formats/media/rtp/rtp_receiver.h"

namespace animeme::media {

namespace {

constexpr double kRequestSeconds = 0.25;  // between requests for an intra plane

}  // namespace

// Half to one and a half times five seconds, as RFC 3550 section 6.2 asks, so that receivers that
// began together do not report together.
double RtpReceiver::report_interval() {
  dice_ ^= dice_ << 13;
  dice_ ^= dice_ >> 17;
  dice_ ^= dice_ << 5;
  return 2.5 + 5.0 * (dice_ >> 8) / double(1 << 24);
}

std::vector<RtpDatagram> RtpReceiver::reports(double now) {
  std::vector<RtpDatagram> out;
  const Source* face = source(LiveTrack::face);
  const auto sender = face != nullptr ? face->input.ssrc() : std::nullopt;
  if (options_.send_reports && sender && wants_intra_ && now >= next_request_) {
    next_request_ = now + kRequestSeconds;
    RtcpMessage message;
    message.reports.push_back({id_, std::nullopt, {}});
    message.requests.push_back({id_, *sender, std::nullopt});
    out.push_back({LiveTrack::face, true, write_rtcp(message)});
  }
  for (Source& each : sources_) {
    if (!options_.send_reports || !each.begun || now < each.next_report) continue;
    const bool first = each.next_report == 0;
    each.next_report = now + (first ? 1 : report_interval());
    if (first) continue;
    RtcpMessage message;
    message.reports.push_back({id_, std::nullopt, {each.input.report(now)}});
    message.names.push_back({id_, "animeme-" + std::to_string(id_)});
    out.push_back({each.track, true, write_rtcp(message)});
  }
  return out;
}

ReceiveStats RtpReceiver::stats() const {
  ReceiveStats stats;
  for (const Source& each : sources_) {
    const ReorderBuffer::Counts counts = each.input.counts();
    stats.packets += counts.received + counts.late + counts.duplicates;
    stats.bytes += each.input.bytes();
    stats.lost += counts.lost;
    stats.late += counts.late;
    stats.duplicates += counts.duplicates;
    stats.reordered += counts.reordered;
    stats.foreign += each.input.foreign();
    stats.wait = std::max(stats.wait, each.input.wait());
    stats.latest = std::max(stats.latest, each.input.latest());
    if (each.track == LiveTrack::face) stats.jitter = each.input.jitter_seconds();
  }
  stats.sessions = sessions_;
  return stats;
}

}  // namespace animeme::media
