// Addresses of the udp and srt protocols.
#pragma once

#include <string>

#include "fap/result.h"

namespace animeme::media {

/// udp://HOST:PORT?... or srt://HOST:PORT?...
struct NetAddress {
  std::string scheme;  ///< "udp" or "srt"
  std::string host;    ///< may be empty: all addresses of this machine
  int port = 0;
  std::string query;      ///< with the question mark; may be empty
  bool listener = false;  ///< srt: mode=listener

  /// Without the query, which may hold a passphrase.
  std::string text() const { return scheme + "://" + host + ":" + std::to_string(port); }
  /// Value of an option in the query, empty: not there.
  std::string option(const std::string& name) const;
};

/// Errors: invalid_argument (not such an address), unsupported (this FFmpeg lacks the protocol).
Result<NetAddress> parse_net_address(const std::string& url, bool for_reading);

}  // namespace animeme::media
