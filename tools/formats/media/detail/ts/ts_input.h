// Whose transport stream is heard, by the addresses that datagrams come from; knows neither sockets
// nor clocks. Source: tools/formats/media/live/receiving.md, section 1.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "tools/formats/media/detail/ts/ts_events.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::media {

/// Hears the first address that has sent a program with a face or a sound. Another one that has,
/// and a unit of it, takes over when the first is silent for a second, or has ended; LiveRestart
/// tells.
class TsInput {
 public:
  /// `any_source`: all addresses are one.
  explicit TsInput(bool any_source = false) : any_source_(any_source) {}

  /// Takes a datagram and appends what follows from it to `out`. `now`: seconds of a steady clock.
  void push(std::span<const std::uint8_t> bytes, const UdpAddress& from, double now,
            std::deque<LiveEvent>& out);
  /// Nothing will come any more.
  void finish(std::deque<LiveEvent>& out) { parser_.finish(out); }

  bool found() const { return sender_.has_value() || sessions_ > 0; }  ///< somebody was heard
  ReceiveStats stats() const;                                          ///< of all senders

 private:
  struct Sender {
    UdpAddress from;
    TsDemuxer demuxer;
    double last = 0;
    std::vector<TsEvent> found;  // while it is not heard
    std::size_t bytes = 0;       // of these
    std::int64_t datagrams = 0;  // likewise
    bool program = false, unit = false;
  };

  void hear(Sender& sender, std::span<const std::uint8_t> bytes, double now,
            std::deque<LiveEvent>& out);
  void give(TsEvent event, double now, std::deque<LiveEvent>& out);
  void consider(std::span<const std::uint8_t> bytes, const UdpAddress& from, double now,
                std::deque<LiveEvent>& out);
  static void keep(Sender& sender, std::vector<TsEvent> found);
  void leave();
  void measure(const TsPes& pes, double now);

  bool any_source_;
  std::optional<Sender> sender_;
  std::vector<Sender> candidates_;
  TsEvents parser_;
  bool over_ = false;    // the sender has ended its stream
  ReceiveStats before_;  // of earlier senders
  std::int64_t foreign_ = 0, sessions_ = 0;
  double jitter_ = 0, transit_ = 0;
};

}  // namespace animeme::media
