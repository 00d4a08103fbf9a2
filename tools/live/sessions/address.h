/// @file
/// Selects a live transport by its address: those of tools/formats/media, the web server and
/// engines.
///
/// | address | transport |
/// |---|---|
/// | rtp://host:port, NAME.sdp | RTP |
/// | udp://host:port, srt://host:port | MPEG transport stream |
/// | http://host:port | a web server with a page that shows the face; its clients use ws:// |
/// | webrtc://host:port | the same, with mandatory WebRTC (WHEP), tools/live/webrtc |
/// | whip://host:port/path, whips:// | WebRTC to a server of WHIP |
/// | livelink://, vmc://, osc://host:port | the face alone, for engines
/// (tools/live/engines/engines.h) |
#pragma once

#include <memory>
#include <string>

#include "tools/formats/media/live/open.h"
#include "tools/live/engines/engines.h"
#include "tools/live/web/web.h"

namespace animeme::live {

/// Options for sending, by transport.
struct SinkOptions {
  media::SinkOptions media;            ///< RTP, MPEG-TS
  web::WebOptions web;                 ///< the web server or client
  engines::EngineSinkOptions engines;  ///< Live Link, VMC, OSC
};
/// Options for receiving, by transport.
struct SourceOptions {
  media::SourceOptions media;            ///< RTP, MPEG-TS
  web::WebOptions web;                   ///< the web server or client
  engines::EngineSourceOptions engines;  ///< Live Link, VMC, OSC
};

/// Errors: invalid_argument (unknown kind of address; the message lists the known ones), those of
/// the transport.
Result<std::unique_ptr<media::LiveSink>> open_sink(const std::string& url,
                                                   const SinkOptions& options);
/// The same for a source.
Result<std::unique_ptr<media::LiveSource>> open_source(const std::string& where,
                                                       const SourceOptions& options);

/// Adds a built-in head to the page of a web server, unless it has one, and WebRTC for browsers
/// that support it.
web::WebOptions with_head(web::WebOptions options);

/// Whether an address is WebRTC, which only carries Opus sound.
bool takes_opus_alone(const std::string& url);
/// Whether receivers of an address need a session description.
bool is_rtp(const std::string& url);

}  // namespace animeme::live
