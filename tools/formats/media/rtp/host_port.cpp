#include <string>

#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme::media {

Result<HostPort> read_host_port(const std::string& url, int standard_port) {
  const auto bad = [&url] {
    return make_error(Code::invalid_argument,
                      "'" + url + "' is not an address of the form scheme://host:port");
  };
  const std::size_t begin = url.find("://");
  if (begin == std::string::npos) return bad();
  std::string rest = url.substr(begin + 3);
  if (!rest.empty() && rest.back() == '/') rest.pop_back();
  HostPort result{"", standard_port};
  std::size_t colon = rest.rfind(':');
  if (!rest.empty() && rest.front() == '[') {
    const std::size_t end = rest.find(']');
    if (end == std::string::npos) return bad();
    result.host = rest.substr(1, end - 1);
    colon = end + 1 < rest.size() ? end + 1 : std::string::npos;
    if (colon != std::string::npos && rest[colon] != ':') return bad();
  } else {
    result.host = rest.substr(0, colon);
  }
  if (result.host.find_first_of(":/?#@ ") != std::string::npos && rest.front() != '[') return bad();
  if (colon == std::string::npos) return result;
  const std::string digits = rest.substr(colon + 1);
  if (digits.empty() || digits.size() > 5 ||
      digits.find_first_not_of("0123456789") != std::string::npos) {
    return bad();
  }
  result.port = std::stoi(digits);
  if (result.port > 65535) return bad();
  return result;
}

}  // namespace animeme::media
