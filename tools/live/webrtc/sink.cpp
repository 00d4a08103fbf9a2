// Addresses of WebRTC, and the sink that waits for viewers.
#include <algorithm>
#include <charconv>
#include <string_view>

#include "tools/live/webrtc/detail/redundant_sound.h"
#include "tools/live/webrtc/detail/where.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::webrtc {
namespace {

constexpr int kMostRepeat = 30;

Error unknown(const std::string& part) {
  return make_error(Code::invalid_argument,
                    "'" + part +
                        "' is not an option of a WebRTC address; options are stun=HOST:PORT, "
                        "turn=USER:PASSWORD@HOST:PORT, repeat=0..30 and audio-repeat=0..3");
}

// "HOST:PORT", also "[::1]:3478".
bool is_place(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == text.npos || colon == 0 || colon + 1 == text.size()) return false;
  int port = 0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + colon + 1, end, port);
  if (read.ec != std::errc() || read.ptr != end || port < 1 || port > 65535) return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return c > ' ' && c <= '~' && c != '/' && c != '@' && c != '?';
  });
}

}  // namespace

Result<void> add_ice_server(const std::string& text, WebRtcOptions& options) {
  const auto bad = [](const std::string& what) { return make_error(Code::invalid_argument, what); };
  const bool stun = text.starts_with("stun:"), turn = text.starts_with("turn:");
  const std::string rest = stun || turn ? text.substr(5) : std::string();
  const std::size_t at = rest.rfind('@');
  const std::size_t colon = rest.find(':');
  const bool named = at != rest.npos && colon != rest.npos && colon > 0 && colon < at;
  if (!(stun && is_place(rest)) && !(turn && named && is_place(rest.substr(at + 1)))) {
    return bad("write it as stun:HOST:PORT or turn:USER:PASSWORD@HOST:PORT");
  }
  std::string& kept = stun ? options.stun : options.turn;
  if (!kept.empty()) return bad("there is one server of each kind");
  kept = rest;
  return {};
}

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
    } else if (name == "repeat" || name == "audio-repeat") {
      const bool face = name == "repeat";
      int& number = face ? where.options.repeat : where.options.audio_repeat;
      const auto [rest, problem] =
          std::from_chars(value.data(), value.data() + value.size(), number);
      const bool whole = problem == std::errc() && rest == value.data() + value.size();
      const int most = face ? kMostRepeat : RedundantSound::kMostRepeats;
      if (!whole || number < 0 || number > most) return unknown(part);
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
