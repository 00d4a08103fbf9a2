// Whom a receiver hears, and what it makes of that; knows neither sockets nor clocks.
// Source: tools/formats/media/live/receiving.md, section 1.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/formats/media/rtp/udp_socket.h"
#include "tools/live/engines/detail/face_clock.h"
#include "tools/live/engines/detail/face_coder.h"
#include "tools/live/engines/detail/packet_reader.h"
#include "tools/live/engines/engines.h"

namespace animeme::engines {

/// Hears the first sender with two packets of the protocol within a second: one address, and of
/// Live Link Face one phone. Another one that has sent so takes over when it is silent for a
/// second; LiveRestart tells.
class EngineInput {
 public:
  EngineInput(const EngineAddress& address, const EngineSourceOptions& options)
      : address_(address), options_(options), coder_(address.rate, options.intra_seconds) {}

  /// Takes a datagram and appends what follows from it. `now`: seconds of a steady clock. Errors:
  /// those of the encoder.
  Result<void> push(std::span<const std::uint8_t> bytes, const media::UdpAddress& from, double now,
                    std::deque<media::LiveEvent>& out);
  /// Time has passed.
  Result<void> tick(double now, std::deque<media::LiveEvent>& out);
  /// When tick() is wanted next, seconds from `now`; nothing: it need not be.
  std::optional<double> patience(double now) const;

  media::ReceiveStats stats() const;

 private:
  struct Sender {
    media::UdpAddress from;
    std::string name;
    PacketReader reader;
    double last = 0;
    int packets = 0;
    std::vector<ReceivedFace> faces;  // of its last packet, while it is not heard
  };

  Result<void> give(const std::vector<ReceivedFace>& faces, double now,
                    std::deque<media::LiveEvent>& out);
  Result<void> consider(std::span<const std::uint8_t> bytes, const media::UdpAddress& from,
                        const std::string& name, double now, std::deque<media::LiveEvent>& out);
  void look_for_end(std::deque<media::LiveEvent>& out);

  EngineAddress address_;
  EngineSourceOptions options_;
  FaceCoder coder_;
  FaceClock clock_;
  std::optional<Sender> sender_;
  std::vector<Sender> others_;
  media::ReceiveStats stats_;
  std::optional<double> transit_;
};

}  // namespace animeme::engines
