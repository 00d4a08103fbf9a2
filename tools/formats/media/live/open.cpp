#include "tools/formats/media/live/open.h"

namespace animeme::media {
namespace {

Error no_such_scheme(const std::string& url) {
  return make_error(Code::invalid_argument,
                    "'" + url +
                        "' is not a live address; write rtp://host:port, udp://host:port or "
                        "srt://host:port, or name a .sdp file to receive what it describes");
}

bool is_transport_stream(const std::string& url) {
  return url.starts_with("udp://") || url.starts_with("srt://");
}

}  // namespace

Result<std::unique_ptr<LiveSink>> open_sink(const std::string& url, const SinkOptions& options) {
  if (url.starts_with("rtp://")) return make_rtp_sink(url, options.rtp);
  if (is_transport_stream(url)) return make_ts_sink(url, options.ts);
  return no_such_scheme(url);
}

Result<std::unique_ptr<LiveSource>> open_source(const std::string& where,
                                                const SourceOptions& options) {
  if (is_transport_stream(where)) return make_ts_source(where, options.ts);
  if (where.starts_with("rtp://") || where.ends_with(".sdp")) {
    return make_rtp_source(where, options.rtp);
  }
  return no_such_scheme(where);
}

}  // namespace animeme::media
