// Messages and bundles of Open Sound Control 1.0, as far as faces need them.
//
// Our own, beside Debian's liblo: that reads bundles in its server only, with a socket and a thread
// of its own, where here one socket is asked whom it heard; and faces would depend on an option.
// Source: opensoundcontrol.org, "The Open Sound Control 1.0 Specification".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace animeme::engines {

/// bool: true and false have types of their own; read_osc() gives them as numbers.
using OscValue = std::variant<std::int32_t, float, std::string, bool>;

struct OscMessage {
  std::string address;
  std::vector<OscValue> values;

  /// The float at `i`; nothing if there is none or it is not finite.
  std::optional<double> number(std::size_t i) const;
  /// The text at `i`; empty if there is none.
  std::string text(std::size_t i) const;
};

/// What a datagram holds at most: no router has to cut it up.
inline constexpr std::size_t kMostOscBytes = 1400;

/// Messages in bundles for now (time tag 1), in their order, as few as `most` allows.
std::vector<std::vector<std::uint8_t>> osc_bundles(std::span<const OscMessage> messages,
                                                   std::size_t most = kMostOscBytes);

/// The messages of a packet, those of bundles in bundles included; time tags are passed over.
/// Doubles and 64-bit numbers become floats, true and false 1 and 0; other values are left out, and
/// those behind an unknown one. Nothing: it is no OSC, or damaged.
std::optional<std::vector<OscMessage>> read_osc(std::span<const std::uint8_t> packet);

}  // namespace animeme::engines
