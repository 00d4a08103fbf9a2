#include "tools/live/web/detail/address.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "tools/formats/media/detail/tracks/words_internal.h"

namespace animeme::web {
namespace {

Error bad(const std::string& what) {
  return make_error(Code::invalid_argument,
                    what + "; give http://HOST:PORT/ for a server, ws://HOST:PORT/ for a client");
}

bool is_plain_path(const std::string& path) {
  return std::all_of(path.begin(), path.end(), [](char c) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return letter || c == '/' || c == '-' || c == '_' || c == '.' || c == '~';
  });
}

bool is_plain_query(const std::string& query) {
  return query.size() <= 512 && std::all_of(query.begin(), query.end(), [](char c) {
           return c > ' ' && c <= '~' && c != '#' && c != '"' && c != '<' && c != '>';
         });
}

}  // namespace

Result<WebAddress> parse_web_address(const std::string& url, bool with_path) {
  const std::size_t scheme = url.find("://");
  const std::string name = url.substr(0, scheme);
  if (scheme != std::string::npos && (name == "https" || name == "wss")) {
    return make_error(Code::unsupported,
                      "encryption is left to a proxy in front of the server; use http:// or ws://");
  }
  if (scheme == std::string::npos || (name != "http" && name != "ws")) {
    return bad("not an address of a web server");
  }
  std::string place = url.substr(scheme + 3);
  WebAddress address;
  if (const std::size_t query = place.find('?'); with_path && query != std::string::npos) {
    address.query = place.substr(query + 1);
    place.resize(query);
    if (!is_plain_query(address.query)) return bad("the query has an invalid character");
  }
  const std::size_t path = place.find('/');
  if (path != std::string::npos && path + 1 != place.size()) {
    address.path = place.substr(path);
    if (!with_path) return bad("the address has a path");
    if (!is_plain_path(address.path)) return bad("the path has an invalid character");
    while (address.path.ends_with('/')) address.path.pop_back();
  }
  place = place.substr(0, path);
  const std::size_t bracket = place.rfind(']');
  const std::size_t colon = place.rfind(':');
  const bool has_port =
      colon != std::string::npos && (bracket == std::string::npos || colon > bracket);
  address.host = place.substr(0, has_port ? colon : std::string::npos);
  if (address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']') {
    address.host = address.host.substr(1, address.host.size() - 2);
  }
  if (address.host.empty() || address.host == "localhost") address.host = "127.0.0.1";
  for (const char c : address.host) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '.' || c == '-' || c == ':';
    if (!plain) return bad("the host has an invalid character");
  }
  if (!has_port) return address;
  const auto port = media::to_number(place.substr(colon + 1), 65535);
  if (!port) return bad("the port is not a number up to 65535");
  address.port = int(*port);
  return address;
}

// libwebsockets would say no more than that it failed, and lose some memory.
Result<void> check_listening(const WebAddress& address) {
  const auto failed = [&](const char* why) {
    return make_error(Code::io, "cannot listen at " + address.text() + ": " + why);
  };
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(address.port);
  const int status = getaddrinfo(address.host.c_str(), port.c_str(), &hints, &found);
  if (status != 0) return failed(gai_strerror(status));
  const int handle = socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(handle, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  const bool free =
      handle >= 0 && bind(handle, found->ai_addr, found->ai_addrlen) == 0 && listen(handle, 1) == 0;
  const int problem = errno;
  freeaddrinfo(found);
  if (handle >= 0) close(handle);
  if (free) return {};
  return failed(problem == EADDRINUSE ? "the port is in use" : std::strerror(problem));
}

}  // namespace animeme::web
