/// @file
/// Receives the packets of one medium: selects the sender, orders packets and prepares receiver
/// reports. Source: RFC 3550 sections 6.4, 8.2 and appendix A.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tools/formats/media/rtp/jitter.h"
#include "tools/formats/media/rtp/rtcp.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::media {

/// Accepts one sender at a time: an identifier (SSRC) at an address. It is the first that has sent
/// two packets close in sequence, one of them with the start of a unit if that can be determined.
/// The sender of the session description needs only one packet and has priority: others wait a
/// second for it. Another sender takes over when the first has been silent for a second, or if it
/// has the same address; its packets are kept until then. Everything else is counted as foreign.
class RtpInput {
 public:
  /// The medium according to the session description.
  struct Settings {
    int payload_type = -1;              ///< others are ignored; -1: any
    std::uint32_t clock = 90000;        ///< ticks a second
    int bundle_id = 0;                  ///< of the header extension; 0: none
    ReorderLimits limits;               ///< see ReorderBuffer
    std::optional<std::uint32_t> ssrc;  ///< of the described sender
    bool face = false;                  ///< units begin with a start code
    bool any_source = false;            ///< ignore addresses
  };
  /// Settings are not checked.
  explicit RtpInput(const Settings& settings) : settings_(settings), buffer_(settings.limits) {}

  /// Result of add().
  enum class Taken : std::uint8_t {
    no,       ///< not RTP, not for us, a duplicate, or from a sender not yet accepted
    yes,      ///< next() may return something
    restart,  ///< a new sender: flush() and take the rest of the old one, then accept()
  };
  /// `now`: seconds of a steady clock, as everywhere below.
  Taken add(std::span<const std::uint8_t> datagram, const UdpAddress& from, double now);
  /// Whether a datagram is from the current sender, by identifier and address.
  bool hears(std::span<const std::uint8_t> datagram, const UdpAddress& from) const;
  void flush() { buffer_.flush(); }  ///< gives up missing packets
  /// Switches to the new sender, or waits for one if there is none.
  void accept();

  /// nullopt: wait for deadline() or the next datagram.
  std::optional<ReorderBuffer::Item> next(double now) { return buffer_.next(now); }
  /// When next() returns something without a further packet.
  std::optional<double> deadline() const { return buffer_.deadline(); }

  /// false: not from the current sender at its host. A report of a sender not yet accepted is kept
  /// for take_report().
  bool add_report(const RtcpReport& report, const UdpAddress& from, double now);
  /// The report that the sender sent before it was accepted; returned once.
  std::optional<SenderInfo> take_report();
  /// A sender leaves; false: not the current one.
  bool add_bye(std::uint32_t ssrc, const UdpAddress& from, double now);
  /// Of the current sender; nullopt: none yet.
  std::optional<std::uint32_t> ssrc() const { return ssrc_; }
  std::optional<double> bye_at() const { return bye_at_; }  ///< when it said goodbye
  double last_heard() const { return last_heard_; }         ///< when its last packet arrived

  /// The receiver report block for the time since the last call.
  ReportBlock report(double now);
  /// Totals over all senders.
  ReorderBuffer::Counts counts() const;
  std::int64_t bytes() const { return bytes_; }           ///< of all accepted RTP datagrams
  std::int64_t foreign() const { return foreign_; }       ///< ignored datagrams
  void ignore() { ++foreign_; }                           ///< counts another one
  double wait() const { return buffer_.longest_wait(); }  ///< ReorderBuffer::longest_wait()
  double latest() const { return buffer_.latest(); }      ///< ReorderBuffer::latest()
  /// Interarrival jitter.
  double jitter_seconds() const { return jitter_.ticks() / settings_.clock; }

  /// A datagram of a potential sender.
  struct Early {
    std::vector<std::uint8_t> bytes;  ///< unchanged
    UdpAddress from;                  ///< who sent it
    double at = 0;                    ///< time of arrival, seconds
  };
  /// Of all potential senders, in order of arrival.
  std::vector<Early> early() const;

 private:
  struct Candidate {
    std::uint32_t ssrc = 0;
    UdpAddress from;
    double begin = 0;  // when it was heard first
    std::deque<Early> datagrams;
    std::size_t bytes = 0;
    std::uint16_t sequence = 0;  // of its last packet
    bool begins = false;         // one of them is the begin of a unit
    bool follows = false;        // two of them are near to each other
  };
  struct EarlyReport {
    std::uint32_t ssrc = 0;
    UdpAddress from;
    SenderInfo info;
  };

  Taken consider(const RtpPacket& packet, Early datagram);
  bool proved(const Candidate& candidate) const;
  bool may_take_over(const Candidate& candidate, double now) const;
  void take(RtpPacket packet, std::size_t size, double now);
  bool is_control(std::uint32_t ssrc, const UdpAddress& from, double now);

  Settings settings_;
  ReorderBuffer buffer_;
  JitterMeter jitter_;
  std::optional<std::uint32_t> ssrc_;
  UdpAddress from_, control_;  // where the sender sends from; control_: nobody yet
  double control_heard_ = 0;
  std::vector<Candidate> candidates_;
  std::optional<Candidate> chosen_;
  bool renewed_ = false;  // the sender of the session description has gone
  std::deque<EarlyReport> early_reports_;
  std::optional<double> bye_at_;
  double last_heard_ = 0;
  std::int64_t bytes_ = 0;
  std::int64_t foreign_ = 0;
  ReorderBuffer::Counts before_;  // of earlier senders
  std::int64_t reported_expected_ = 0;
  std::int64_t reported_received_ = 0;
  std::uint32_t last_sr_ = 0;
  double last_sr_at_ = 0;
};

}  // namespace animeme::media
