/// @file
/// Packets that overtake each other, come twice or not at all, put in order. Knows nothing of
/// sockets and clocks; the caller says what time it is. Source: RFC 3550 appendix A.1 and A.8.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <map>
#include <optional>
#include <variant>

#include "tools/formats/media/rtp/rtp_packet.h"

namespace animeme::media {

/// A 32-bit counter without its wraps: the value next to the last one.
class Unwrapper {
 public:
  std::int64_t add(std::uint32_t value);  ///< the value without wraps; near the one before
  void reset() { known_ = false; }        ///< the next value begins anew

 private:
  bool known_ = false;
  std::int64_t last_ = 0;
};

/// How long a packet may keep others waiting.
struct ReorderLimits {
  double seconds = 0.1;     ///< time that a packet waits for an earlier one, at first and at least
  double most_seconds = 1;  ///< at most, however late packets come
  std::size_t packets = 256;                 ///< at most so many wait
  std::size_t bytes = std::size_t(1) << 20;  ///< with so much payload
};

/// One sender's packets in order of sequence numbers. The first packet waits, too: an earlier one,
/// or its copy, may be on its way, and a face that begins with a loss begins an intra plane later.
/// How long packets wait follows from how late others came, copies included: a quarter longer than
/// the worst of the last 15 to 30 seconds (tools/formats/media/live/receiving.md, section 3).
///
/// A jump of more than 3000 numbers, or back to numbers that came more than five seconds ago, is
/// taken for a sender that has begun anew if the packet after it goes on from there; else the
/// packet is dropped.
class ReorderBuffer {
 public:
  /// So many packets are missing at this place; 0: not known.
  struct Missing {
    std::int64_t packets = 0;  ///< at least 1 where known
  };
  using Item = std::variant<RtpPacket, Missing>;  ///< what comes out

  /// Limits as they are, unchecked.
  explicit ReorderBuffer(ReorderLimits limits) : limits_(limits) {}

  /// true: it had not come before (late ones count as old).
  bool add(RtpPacket packet, double now);
  /// The next packet, or the gap in front of it once the wait is over.
  std::optional<Item> next(double now);
  /// When next() will have something without a further packet.
  std::optional<double> deadline() const;
  /// Nothing more will come: what is missing is lost.
  void flush() { flushing_ = true; }
  /// An empty one for another sender on the same way: knows how late packets come here.
  ReorderBuffer renewed() const;
  double longest_wait() const { return longest_wait_; }  ///< the most that wait() was
  double wait() const;                                   ///< seconds that a packet waits by now
  double latest() const {
    return latest_;
  }  ///< seconds that one came behind its successor, or copy

  /// Totals over the life of the buffer.
  struct Counts {
    std::int64_t received = 0;    ///< without duplicates and late ones
    std::int64_t lost = 0;        ///< given up
    std::int64_t late = 0;        ///< came after they had been given up
    std::int64_t duplicates = 0;  ///< came before
    std::int64_t reordered = 0;   ///< came behind a later one
  };
  const Counts& counts() const { return counts_; }  ///< so far
  /// Packets that should have come up to now, by their sequence numbers.
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
  /// A packet of `timestamp` came at `now` seconds; `clock` ticks a second.
  void add(std::uint32_t timestamp, double now, std::uint32_t clock);
  double ticks() const { return jitter_; }  ///< of the clock

 private:
  bool begun_ = false;
  double last_arrival_ = 0;
  std::uint32_t last_timestamp_ = 0;
  double jitter_ = 0;
};

}  // namespace animeme::media
