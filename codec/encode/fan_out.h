/// @file
/// One live stream for many receivers that join when they like and lose nothing, as over TCP.
///
///     animeme::fba::FanOut face;
///     face.push(unit.bytes);                       // the next unit of the source
///     for (const Client& client : clients) client.send(face.unit_for(client.id).bytes);
///
/// The intra planes that a source sends from time to time, for those who join, cost up to half of
/// its bits. Here each receiver has an encoder instead: its stream begins with an intra plane,
/// wherever it joins, and goes on with predictive planes of the same values. Intra planes of the
/// source that change quantiser or masks stay, and so do those without which a value does not fit
/// the ranges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace animeme::fba {

/// Codes the units of a source again for its receivers. Those that joined between two units, or
/// that have come to the same intra plane, share an encoder. Movable, not copyable, not thread
/// safe.
class FanOut {
 public:
  using Receiver = std::uint64_t;  ///< a number of the caller's

  /// What a receiver gets for the newest unit of the source; valid until the next call of push().
  struct Unit {
    std::span<const std::uint8_t> bytes;  ///< as AccessUnit::bytes; equal ones have equal addresses
    bool intra = false;                   ///< a decoder can begin here
  };

  /// With more encoders than `most_encoders` (at least 1) the next intra plane of the source goes
  /// to all receivers, which share one from there on.
  explicit FanOut(std::size_t most_encoders = 32);
  FanOut(FanOut&&) noexcept;  ///< movable
  FanOut& operator=(FanOut&&) noexcept;
  ~FanOut();

  /// The next unit of the source: a plane behind a start code.
  void push(std::span<const std::uint8_t> unit);
  /// Whether the newest unit was decoded, and all that it builds on: unit_for() can give an intra
  /// plane.
  bool ready() const;
  /// The newest unit for a receiver: an intra plane, if the receiver is new or was forgotten; of a
  /// value that no intra plane reaches it has the nearest, until the next unit. The unit of the
  /// source while not ready().
  Unit unit_for(Receiver receiver);
  /// The receiver has left, or begins anew.
  void forget(Receiver receiver);
  /// How many encoders there are now.
  std::size_t encoders() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
