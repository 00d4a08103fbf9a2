#include "tools/live/sessions/address.h"

#include <initializer_list>
#include <string_view>

#include "fap/head/model.h"
#include "fap/head/rig.h"
#include "tools/live/webrtc/webrtc.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::live {

namespace {

bool begins(const std::string& url, std::initializer_list<std::string_view> schemes) {
  for (const std::string_view scheme : schemes) {
    if (url.starts_with(scheme)) return true;
  }
  return false;
}

bool is_web(const std::string& url) {
  return begins(url, {"http://", "https://", "ws://", "wss://"});
}

bool is_media(const std::string& url) { return begins(url, {"rtp://", "udp://", "srt://"}); }

}  // namespace

web::WebOptions with_head(web::WebOptions options) {
  if (!options.make_peer_connections)
    options.make_peer_connections = [] { return webrtc::make_peer_connections(); };
  if (!options.head_script.empty()) return options;
  options.head_script = viewer::head_script();
  options.make_head_model = []() -> std::vector<std::uint8_t> {
    const Result<head::Head> head = head::make_head();
    if (!head) return {};  // the page has a schematic face for that
    return viewer::pack_head(*head, head::make_rig(*head));
  };
  return options;
}

bool takes_opus_alone(const std::string& url) {
  return webrtc::is_webrtc(url) || webrtc::is_whip(url);
}

bool is_rtp(const std::string& url) { return begins(url, {"rtp://"}); }

Result<std::unique_ptr<media::LiveSink>> open_sink(const std::string& url,
                                                   const SinkOptions& options) {
  if (is_web(url) || webrtc::is_webrtc(url)) {
    auto sink = webrtc::is_webrtc(url) ? webrtc::make_webrtc_sink(url, with_head(options.web))
                                       : web::make_web_sink(url, with_head(options.web));
    if (!sink) return sink.error();
    return std::unique_ptr<media::LiveSink>(std::move(*sink));
  }
  if (webrtc::is_whip(url)) return webrtc::make_whip_sink(url);
  if (is_media(url)) return media::open_sink(url, options.media);
  if (engines::is_engine(url)) return engines::make_engine_sink(url, options.engines);
  return make_error(
      Code::invalid_argument,
      "'" + url +
          "' is no address to send to; write rtp://host:port, udp://host:port, "
          "srt://host:port, http://host:port, webrtc://host:port, whip://host:port/path, "
          "livelink://host:port, vmc://host:port or osc://host:port");
}

Result<std::unique_ptr<media::LiveSource>> open_source(const std::string& where,
                                                       const SourceOptions& options) {
  if (is_web(where)) return web::make_web_source(where, options.web);
  if (is_media(where) || where.ends_with(".sdp")) return media::open_source(where, options.media);
  if (engines::is_engine(where)) return engines::make_engine_source(where, options.engines);
  return make_error(
      Code::invalid_argument,
      "'" + where +
          "' is nothing to receive from; name a session description (.sdp) or write "
          "rtp://host:port, udp://host:port, srt://host:port, ws://host:port, livelink://:port, "
          "vmc://:port or osc://:port");
}

}  // namespace animeme::live
