// Datagrams of one sender as faces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/live/engines/detail/engine_address.h"
#include "tools/live/engines/detail/unified.h"
#include "tools/live/engines/detail/vmc.h"

namespace animeme::engines {

/// A face as it was received.
struct ReceivedFace {
  fap::ArkitFrame values{};
  fap::ArkitChannels channels;    ///< that the sender has
  std::optional<double> seconds;  ///< by the sender's clock, if it has one
  double arrival = 0;             ///< seconds of ours
};

class PacketReader {
 public:
  explicit PacketReader(Protocol protocol) : protocol_(protocol) {}

  /// Takes a datagram and appends the faces that it completes. false: it is none of the protocol.
  bool push(std::span<const std::uint8_t> bytes, double now, std::vector<ReceivedFace>& out);
  /// A face that nothing more has come for: Unified Expressions have no mark at the end of a frame.
  void tick(double now, std::vector<ReceivedFace>& out);
  /// The sender has said goodbye; told once.
  bool take_end();
  /// Seconds until tick() may have something; nothing: it does not wait.
  std::optional<double> patience(double now) const;

 private:
  bool push_osc(const OscMessage& message, double now, std::vector<ReceivedFace>& out);

  Protocol protocol_;
  VmcState vmc_;
  UnifiedState unified_;
  std::optional<double> begun_, latest_;  // arrival of the first and last packet of a frame
  bool end_ = false;
};

/// Who sends, beside the address: device and subject of Live Link Face. Nothing: it is none of the
/// protocol. `subject`: whose packets alone are wanted.
std::optional<std::string> sender_of(std::span<const std::uint8_t> bytes, Protocol protocol,
                                     const std::optional<std::string>& subject);

}  // namespace animeme::engines
