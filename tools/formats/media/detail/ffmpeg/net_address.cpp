#include "tools/formats/media/detail/ffmpeg/net_address.h"

#include <algorithm>

#include "tools/formats/media/detail/ffmpeg/ffmpeg.h"
#include "tools/formats/media/detail/tracks/words_internal.h"

namespace animeme::media {
namespace {

bool has_protocol(const std::string& scheme, bool output) {
  void* state = nullptr;
  while (const char* name = avio_enum_protocols(&state, output ? 1 : 0)) {
    if (scheme == name) return true;
  }
  return false;
}

Error bad_address(const std::string& what) {
  return make_error(Code::invalid_argument,
                    what + "; give udp://HOST:PORT or srt://HOST:PORT?mode=caller (or listener)");
}

}  // namespace

std::string NetAddress::option(const std::string& name) const {
  std::string_view rest = query;
  for (take_until(rest, '?'); !rest.empty();) {
    std::string_view value = take_until(rest, '&');
    if (take_until(value, '=') == name) return std::string(value);
  }
  return {};
}

Result<NetAddress> parse_net_address(const std::string& url, bool for_reading) {
  NetAddress address;
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) return bad_address("not an address");
  address.scheme = url.substr(0, scheme);
  if (address.scheme != "udp" && address.scheme != "srt") {
    return bad_address("an address of " + address.scheme + " cannot be used here");
  }
  std::string place = url.substr(scheme + 3);
  address.query = place.substr(std::min(place.find('?'), place.size()));
  place.resize(std::min(place.find_first_of("?/"), place.size()));
  const std::size_t colon = place.rfind(':');
  if (colon == std::string::npos) return bad_address("the address has no port");
  address.host = place.substr(0, colon);
  if (address.host == "@") address.host.clear();
  address.port = int(to_number(place.substr(colon + 1), 65535).value_or(0));
  if (address.port < 1) return bad_address("the port is not a number from 1 to 65535");
  const std::string mode = address.option("mode");
  if (address.scheme == "srt" && !mode.empty() && mode != "caller" && mode != "listener") {
    return bad_address("the mode is neither caller nor listener");
  }
  address.listener = address.scheme == "srt" && mode == "listener";
  if (address.host.empty() && !address.listener && !(for_reading && address.scheme == "udp")) {
    return bad_address("the address has no host");
  }
  if (!has_protocol(address.scheme, !for_reading)) {
    return make_error(Code::unsupported, "this FFmpeg was built without " + address.scheme);
  }
  return address;
}

}  // namespace animeme::media
