// What headers of requests say, and whether it is granted. Texts only, no connections.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/live/web/detail/address.h"

namespace animeme::web {

/// The names and addresses that are ours. A page elsewhere can have the name of its server lead to
/// us (DNS rebinding), and the browser then takes us for that server; but it sends that name.
class OwnNames {
 public:
  /// Of a server at `address`: localhost and this machine's loopback addresses, `address` itself;
  /// unless it is for this machine alone, also the names and addresses of this machine. `more`:
  /// names by which a proxy or a name server calls us; "*": any.
  OwnNames(const WebAddress& address, const std::vector<std::string>& more);

  /// `host`: value of a Host header, with or without a port.
  bool contains(std::string_view host) const;

 private:
  void add(std::string_view name);

  std::set<std::string, std::less<>> names_;  // lower case, addresses without brackets
  bool any_ = false;
};

/// The name of a Host header: lower case, without port, brackets and a dot at its end. Empty: it is
/// none.
std::string host_name(std::string_view host);

/// May a page of `origin` use the server that it calls `host`? Its own pages may, and those of
/// `allowed` ("*": all).
bool origin_allowed(std::string_view origin, std::string_view host,
                    const std::vector<std::string>& allowed);

/// Accept-Encoding: does it take gzip?
bool takes_gzip(std::string_view accept_encoding);

/// If-None-Match: does the client have the version `etag` (with its quotes)?
bool has_version(std::string_view if_none_match, std::string_view etag);

/// Can other machines reach a server at this address?
bool listens_for_others(const WebAddress& address);

}  // namespace animeme::web
