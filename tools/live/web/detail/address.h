// Addresses of web servers.
#pragma once

#include <string>

#include "fap/result.h"

namespace animeme::web {

struct WebAddress {
  std::string host;  ///< without the brackets of IPv6; never empty
  int port = 80;     ///< 0: any free one (servers)
  /// In front of the names of resources: "", or "/heads/anna" (clients).
  std::string path = {};
  std::string query = {};  ///< "ticket=..." of all of them; empty: none (clients)

  /// "http://HOST:PORT/"
  std::string text() const {
    const bool v6 = host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port) + "/";
  }
};

/// http://HOST:PORT/ or ws://HOST:PORT/; no host: this machine. `with_path`: a path and a query may
/// follow.
/// Errors: invalid_argument (another address, a path), unsupported (https, wss).
Result<WebAddress> parse_web_address(const std::string& url, bool with_path = false);

/// Can a server listen there? Errors: io, in the words of the system.
Result<void> check_listening(const WebAddress& address);

}  // namespace animeme::web
