// livelink://host:port?rate=60 and its like, taken apart.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fap/result.h"

namespace animeme::engines {

enum class Protocol : std::uint8_t { live_link, vmc, unified };

/// What shapes are called in VMC.
enum class ShapeNames : std::uint8_t { arkit, vrm0, vrm1 };

struct EngineAddress {
  Protocol protocol = Protocol::live_link;
  std::string host;  ///< empty: all addresses of this machine, for receiving alone
  int port = 0;
  std::optional<int> rate;             ///< frames a second
  std::optional<std::string> subject;  ///< Live Link
  bool time_of_day = false;            ///< Live Link: frames count from midnight
  ShapeNames names = ShapeNames::arkit;
  bool bones = true;
  std::string prefix = "v2";
  bool gaze = true;
  int binary = 0;  ///< bits of each parameter of an avatar, beside the float
};

/// Errors: invalid_argument.
Result<EngineAddress> parse_engine_address(const std::string& url, bool receiving);

}  // namespace animeme::engines
