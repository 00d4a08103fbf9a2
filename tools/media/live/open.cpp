#include "tools/media/live/open.h"

namespace animeme::media {
namespace {

bool has_scheme(const std::string& url, const char* scheme) {
  return url.rfind(std::string(scheme) + "://", 0) == 0;
}

Error no_such_scheme(const std::string& url) {
  return make_error(Code::invalid_argument,
                    "'" + url +
                        "' is no live address; write rtp://host:port, udp://host:port or "
                        "srt://host:port, or name a .sdp file to receive what it describes");
}

// Transport streams: make_ts_sink() and make_ts_source() of ts_live.h go here.
Error no_transport_stream() {
  return make_error(Code::unsupported, "transport streams over udp:// and srt:// are not built in");
}

}  // namespace

Result<std::unique_ptr<LiveSink>> open_sink(const std::string& url, const SinkOptions& options) {
  if (has_scheme(url, "rtp")) return make_rtp_sink(url, options.rtp);
  if (has_scheme(url, "udp") || has_scheme(url, "srt")) return no_transport_stream();
  return no_such_scheme(url);
}

Result<std::unique_ptr<LiveSource>> open_source(const std::string& where,
                                                const SourceOptions& options) {
  if (has_scheme(where, "udp") || has_scheme(where, "srt")) return no_transport_stream();
  if (has_scheme(where, "rtp") || where.ends_with(".sdp")) {
    return make_rtp_source(where, options.rtp);
  }
  return no_such_scheme(where);
}

}  // namespace animeme::media
