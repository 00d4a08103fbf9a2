/// @file
/// The packets of one medium as they come in: who sends them, in which order, and what there is to
/// report back about it. Source: RFC 3550 sections 6.4, 8.2 and appendix A.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/media/live/jitter.h"
#include "tools/media/live/rtcp.h"

namespace animeme::media {

/// Accepts one sender at a time. Another one takes over once two of its packets have come in
/// sequence, or at once if the first has said goodbye or was silent for two seconds.
class RtpInput {
 public:
  /// What the session description says of the medium.
  struct Settings {
    int payload_type = -1;        ///< others are not for us; -1: any
    std::uint32_t clock = 90000;  ///< ticks a second
    int bundle_id = 0;            ///< of the header extension; 0: none
    ReorderLimits limits;         ///< see ReorderBuffer
  };
  /// Settings as they are, unchecked.
  explicit RtpInput(const Settings& settings) : settings_(settings), buffer_(settings.limits) {}

  /// What became of a datagram.
  enum class Taken : std::uint8_t {
    no,       ///< not RTP, not for us, came before, or has to prove itself
    yes,      ///< next() may have something
    restart,  ///< a new sender: take what flush() leaves of the old one, then accept()
  };
  /// `now`: seconds of a steady clock, as everywhere below.
  Taken add(std::span<const std::uint8_t> datagram, double now);
  void flush() { buffer_.flush(); }  ///< what is missing is lost
  /// Goes over to the new sender.
  void accept(double now);

  /// Nothing: wait for deadline() or the next datagram.
  std::optional<ReorderBuffer::Item> next(double now) { return buffer_.next(now); }
  /// When next() will have something by itself.
  std::optional<double> deadline() const { return buffer_.deadline(); }

  /// Of the sender itself; others are passed over. false: not ours.
  bool add_report(const RtcpReport& report, double now);
  void add_bye(std::uint32_t ssrc, double now);  ///< a sender leaves
  /// Of the sender in force; nothing: none yet.
  std::optional<std::uint32_t> ssrc() const { return ssrc_; }
  std::optional<double> bye_at() const { return bye_at_; }  ///< when it said goodbye
  double last_heard() const { return last_heard_; }         ///< when its last packet came

  /// What a receiver report says of the time since the last call.
  ReportBlock report(double now);
  /// Totals over all senders.
  ReorderBuffer::Counts counts() const;
  std::int64_t bytes() const { return bytes_; }  ///< of all RTP datagrams taken
  /// Interarrival jitter.
  double jitter_seconds() const { return jitter_.ticks() / settings_.clock; }

 private:
  Taken consider(RtpPacket packet, double now);
  void take(RtpPacket packet, double now);

  Settings settings_;
  ReorderBuffer buffer_;
  JitterMeter jitter_;
  std::optional<std::uint32_t> ssrc_;
  std::vector<RtpPacket> candidate_;  // of another sender, one or two
  std::optional<double> bye_at_;
  double last_heard_ = 0;
  std::int64_t bytes_ = 0;
  ReorderBuffer::Counts before_;  // of earlier senders
  std::int64_t reported_expected_ = 0;
  std::int64_t reported_received_ = 0;
  std::uint32_t last_sr_ = 0;
  double last_sr_at_ = 0;
};

}  // namespace animeme::media
