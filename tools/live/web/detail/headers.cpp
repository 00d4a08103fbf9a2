#include "tools/live/web/detail/headers.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "fap/detail/text_scanner.h"

namespace animeme::web {
namespace {

using fap::detail::lower_case;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Calls `each` with the parts between commas, trimmed, until it is true.
template <class Each>
bool any_of_list(std::string_view list, const Each& each) {
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    if (each(trimmed(list.substr(0, comma)))) return true;
    list = comma == std::string_view::npos ? std::string_view() : list.substr(comma + 1);
  }
  return false;
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

/// Addresses of this machine, as they stand in a Host header.
std::vector<std::string> own_addresses() {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr) continue;
    const int family = each->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    std::array<char, NI_MAXHOST> text{};
    const socklen_t size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    const int status = getnameinfo(each->ifa_addr, size, text.data(), socklen_t(text.size()),
                                   nullptr, 0, NI_NUMERICHOST);
    if (status == 0) found.emplace_back(text.data());
  }
  freeifaddrs(list);
  return found;
}

}  // namespace

bool listens_for_others(const WebAddress& address) { return !is_loopback(address.host); }

OwnNames::OwnNames(const WebAddress& address, const std::vector<std::string>& more) {
  for (const char* name : {"localhost", "127.0.0.1", "::1"}) add(name);
  add(address.host);
  if (listens_for_others(address)) {
    for (const std::string& own : own_addresses()) add(own.substr(0, own.find('%')));
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) == 0 && name[0] != 0) {
      const std::string whole(name.data()), first = whole.substr(0, whole.find('.'));
      add(whole);
      add(first);
      add(first + ".local");  // its mDNS name
    }
  }
  for (const std::string& name : more) {
    any_ = any_ || name == "*";
    add(name);
  }
}

void OwnNames::add(std::string_view name) {
  const bool v6 = name.find(':') != std::string_view::npos && name.front() != '[';
  std::string own = v6 ? lower_case(name) : host_name(name);
  if (!own.empty()) names_.insert(std::move(own));
}

bool OwnNames::contains(std::string_view host) const {
  const std::string name = host_name(host);
  return !name.empty() && (any_ || names_.contains(name));
}

std::string host_name(std::string_view host) {
  host = trimmed(host);
  std::string_view name = host, port;
  if (!host.empty() && host.front() == '[') {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return {};
    name = host.substr(1, end - 1);
    port = host.substr(end + 1);
    if (!port.empty() && port.front() != ':') return {};
  } else if (std::count(host.begin(), host.end(), ':') == 1) {  // more: an address of IPv6
    name = host.substr(0, host.find(':'));
    port = host.substr(host.find(':'));
  }
  for (const char c : port.substr(std::min<std::size_t>(1, port.size()))) {
    if (c < '0' || c > '9') return {};
  }
  if (!name.empty() && name.back() == '.') name.remove_suffix(1);
  const auto is_none = [](char c) { return (c >= 0 && c <= ' ') || c == 127; };
  if (std::any_of(name.begin(), name.end(), is_none)) return {};
  return lower_case(name);
}

bool origin_allowed(std::string_view origin, std::string_view host,
                    const std::vector<std::string>& allowed) {
  if (origin.empty()) return false;
  for (const std::string& each : allowed) {
    if (each == "*" || each == origin) return true;
  }
  const std::string own = lower_case(host);
  return !own.empty() &&
         (lower_case(origin) == "http://" + own || lower_case(origin) == "https://" + own);
}

bool takes_gzip(std::string_view accept_encoding) {
  return any_of_list(accept_encoding, [](std::string_view part) {
    const std::size_t semicolon = part.find(';');
    const std::string coding = lower_case(trimmed(part.substr(0, semicolon)));
    if (coding != "gzip" && coding != "x-gzip" && coding != "*") return false;
    if (semicolon == std::string_view::npos) return true;
    std::string_view quality = trimmed(part.substr(semicolon + 1));
    if (!quality.starts_with("q=") && !quality.starts_with("Q=")) return true;
    quality.remove_prefix(2);
    return quality.find_first_of("123456789") != std::string_view::npos;  // "0", "0.000": no
  });
}

bool has_version(std::string_view if_none_match, std::string_view etag) {
  return any_of_list(if_none_match, [&](std::string_view part) {
    if (part.starts_with("W/")) part.remove_prefix(2);
    return part == "*" || part == etag;
  });
}

}  // namespace animeme::web
