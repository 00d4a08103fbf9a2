// Addresses of WebRTC, and the sink that waits for viewers.
#include <algorithm>
#include <charconv>
#include <string_view>

#include "tools/live/webrtc/detail/where.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {
namespace {

constexpr int kMostRepeat = 30;

Error unknown(const std::string& part) {
  return make_error(Code::invalid_argument,
                    "'" + part +
                        "' is not an option of a WebRTC address; options are stun=HOST:PORT, "
                        "turn=USER:PASSWORD@HOST:PORT and repeat=0..30");
}

}  // namespace

Result<Where> parse_where(const std::string& url) {
  const std::size_t query = url.find('?');
  Where where{url.substr(0, query), {}};
  for (std::size_t at = query; at < url.size();) {
    const std::size_t end = std::min(url.find('&', at + 1), url.size());
    const std::string part = url.substr(at + 1, end - at - 1);
    const std::size_t equals = part.find('=');
    const std::string name = part.substr(0, equals);
    const std::string value = equals == part.npos ? "" : part.substr(equals + 1);
    if (name == "stun" && !value.empty()) {
      where.options.stun = value;
    } else if (name == "turn" && value.find('@') != value.npos) {
      where.options.turn = value;
    } else if (name == "repeat") {
      const auto [rest, problem] =
          std::from_chars(value.data(), value.data() + value.size(), where.options.repeat);
      const bool whole = problem == std::errc() && rest == value.data() + value.size();
      if (!whole || where.options.repeat < 0 || where.options.repeat > kMostRepeat) {
        return unknown(part);
      }
    } else {
      return unknown(part);
    }
    at = end;
  }
  return where;
}

bool is_webrtc(const std::string& url) { return url.starts_with("webrtc://"); }

bool is_whip(const std::string& url) {
  return url.starts_with("whip://") || url.starts_with("whips://");
}

std::string page_of(const std::string& url) {
  if (!is_webrtc(url)) return url;
  const std::size_t begin = std::string_view("webrtc").size();
  return "http" + url.substr(begin, url.find('?') - begin);
}

Result<std::unique_ptr<web::WebSink>> make_webrtc_sink(const std::string& url,
                                                       const web::WebOptions& options) {
  Result<Where> where = parse_where(url);
  if (!where) return where.error();
  web::WebOptions own = options;
  own.must_have_peer_connections = true;
  own.make_peer_connections = [settings = where->options] {
    return make_peer_connections(settings, true);
  };
  return web::make_web_sink(page_of(url), own);
}

}  // namespace animeme::webrtc
