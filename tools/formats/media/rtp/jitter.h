/// @file
/// Puts packets in order that arrive reordered, duplicated or not at all. Uses no sockets or
/// clocks; the caller passes the time. Source: RFC 3550 appendix A.1 and A.8.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <map>
#include <optional>
#include <variant>

#include "tools/formats/media/rtp/rtp_packet.h"

namespace animeme::media {

/// Unwraps a 32-bit counter: picks the value nearest to the last one.
class Unwrapper {
 public:
  std::int64_t add(std::uint32_t value);  ///< the unwrapped value, nearest to the previous one
  void reset() { known_ = false; }        ///< the next value starts afresh

 private:
  bool known_ = false;
  std::int64_t last_ = 0;
};

/// Limits on waiting for missing packets.
struct ReorderLimits {
  double seconds = 0.1;                      ///< initial and minimum wait for an earlier packet
  double most_seconds = 1;                   ///< maximum wait, however late packets are
  std::size_t packets = 256;                 ///< maximum number of waiting packets
  std::size_t bytes = std::size_t(1) << 20;  ///< and of their payload bytes
};

/// Orders one sender's packets by sequence number. The first packet waits, too, since an earlier
/// one or its copy may still arrive, and a face that begins with a loss cannot be shown before the
/// next intra plane. The wait is 1.25 times the largest lateness, including copies, of the last 15
/// to 30 seconds (tools/formats/media/live/receiving.md, section 3).
///
/// A jump of more than 3000 numbers, or back to numbers received more than five seconds ago, counts
/// as a restart of the sender if the following packet continues from there; otherwise the packet is
/// dropped.
class ReorderBuffer {
 public:
  /// Packets are missing here; 0: unknown number.
  struct Missing {
    std::int64_t packets = 0;  ///< at least 1 if known
  };
  using Item = std::variant<RtpPacket, Missing>;  ///< result of next()

  /// Limits as they are, unchecked.
  explicit ReorderBuffer(ReorderLimits limits) : limits_(limits) {}

  /// true: a new packet (late ones count as old).
  bool add(RtpPacket packet, double now);
  /// The next packet, or the gap before it once the wait is over.
  std::optional<Item> next(double now);
  /// When next() returns something even without a further packet.
  std::optional<double> deadline() const;
  /// Nothing more will come: what is missing is lost.
  void flush() { flushing_ = true; }
  /// An empty buffer for another sender on the same path, which keeps the measured lateness.
  ReorderBuffer renewed() const;
  double longest_wait() const { return longest_wait_; }  ///< maximum of wait() so far
  double wait() const;                                   ///< current wait, seconds
  double latest() const {
    return latest_;
  }  ///< largest lateness after a successor or copy, seconds

  /// Totals over the life of the buffer.
  struct Counts {
    std::int64_t received = 0;    ///< excluding duplicates and late ones
    std::int64_t lost = 0;        ///< given up
    std::int64_t late = 0;        ///< arrived after they had been given up
    std::int64_t duplicates = 0;  ///< already received
    std::int64_t reordered = 0;   ///< arrived after a later one
  };
  const Counts& counts() const { return counts_; }  ///< so far
  /// Packets expected so far, by sequence numbers.
  std::int64_t expected() const { return expected_before_ + (begun_ ? highest_ - first_ + 1 : 0); }
  /// Highest sequence number, wraps in the bits above 16.
  std::uint32_t highest() const { return std::uint32_t(highest_); }

 private:
  struct Waiting {
    RtpPacket packet;
    double since = 0;
  };
  static constexpr std::size_t kHistory = 1024;
  /// How late packets were.
  struct Lateness {
    double begin = 0;                    // of the window
    double worst = 0, worst_before = 0;  // in it, and in the one before
  };

  std::int64_t extend(std::uint16_t sequence) const;
  void begin_at(std::int64_t sequence);
  bool is_elsewhere(std::int64_t sequence, double now) const;
  void expect_up_to(std::int64_t sequence, double now);
  void measure(std::int64_t sequence, double now);
  bool was_given(std::int64_t sequence) const;
  void count_old(std::int64_t sequence);
  bool must_go(double now) const;
  bool beginning(double now) const;

  ReorderLimits limits_;
  std::map<std::int64_t, Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::bitset<kHistory> given_;  // of the last numbers before next_
  // When the last numbers up to highest_ came, or the first one behind them if they did not.
  std::array<double, kHistory> since_{};
  double last_new_ = 0;  // when highest_ came
  Lateness lateness_;
  double latest_ = 0, longest_wait_ = 0;
  bool begun_ = false;
  double begin_until_ = 0;  // so long packets may come that are earlier than the first
  bool restarted_ = false;  // tell of a gap of unknown size
  bool flushing_ = false;
  std::int64_t next_ = 0;
  std::int64_t first_ = 0;
  std::int64_t highest_ = 0;
  std::int64_t expected_before_ = 0;  // the last new begin
  std::optional<Waiting> jump_;       // a packet far away, which waits for its successor
  Counts counts_;
};

/// Interarrival jitter of RFC 3550 section 6.4.1, in ticks.
class JitterMeter {
 public:
  /// A packet with `timestamp` arrived at `now` seconds; `clock` ticks a second.
  void add(std::uint32_t timestamp, double now, std::uint32_t clock);
  double ticks() const { return jitter_; }  ///< of the clock

 private:
  bool begun_ = false;
  double last_arrival_ = 0;
  std::uint32_t last_timestamp_ = 0;
  double jitter_ = 0;
};

}  // namespace animeme::media
