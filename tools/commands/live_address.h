/// @file
/// Every live transport by its address: those of tools/media and the web server.
///
/// | address | transport |
/// |---|---|
/// | rtp://host:port, NAME.sdp | RTP |
/// | udp://host:port, srt://host:port | MPEG transport stream |
/// | http://host:port | a web server with a page that shows the face; its clients use ws:// |
#pragma once

#include <memory>
#include <string>

#include "tools/media/live/open.h"
#include "tools/web/web.h"

namespace animeme::tools {

/// For senders, each transport its part.
struct LiveSinkOptions {
  media::SinkOptions media;  ///< RTP and transport streams
  web::WebOptions web;       ///< the web server
};
/// For receivers, each transport its part.
struct LiveSourceOptions {
  media::SourceOptions media;  ///< RTP and transport streams
  web::WebOptions web;         ///< the web client
};

/// Errors: invalid_argument (no address of ours; the message lists them), those of the transport.
Result<std::unique_ptr<media::LiveSink>> open_live_sink(const std::string& url,
                                                        const LiveSinkOptions& options);
/// `where`: a URL, or the path of a session description.
Result<std::unique_ptr<media::LiveSource>> open_live_source(const std::string& where,
                                                            const LiveSourceOptions& options);

/// True for an address whose receivers need a session description.
bool is_rtp(const std::string& url);

}  // namespace animeme::tools
