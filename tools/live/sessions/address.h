/// @file
/// Every live transport by its address: those of tools/formats/media, the web server and engines.
///
/// | address | transport |
/// |---|---|
/// | rtp://host:port, NAME.sdp | RTP |
/// | udp://host:port, srt://host:port | MPEG transport stream |
/// | http://host:port | a web server with a page that shows the face; its clients use ws:// |
/// | webrtc://host:port | the same, and for certain with WebRTC (WHEP), tools/live/webrtc |
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

/// What sending takes, by transport.
struct SinkOptions {
  media::SinkOptions media;            ///< RTP, MPEG-TS
  web::WebOptions web;                 ///< the web server or client
  engines::EngineSinkOptions engines;  ///< Live Link, VMC, OSC
};
/// What receiving takes, by transport.
struct SourceOptions {
  media::SourceOptions media;            ///< RTP, MPEG-TS
  web::WebOptions web;                   ///< the web server or client
  engines::EngineSourceOptions engines;  ///< Live Link, VMC, OSC
};

/// Errors: invalid_argument (no address of ours; the message lists them), those of the transport.
Result<std::unique_ptr<media::LiveSink>> open_sink(const std::string& url,
                                                   const SinkOptions& options);
/// The same of a source.
Result<std::unique_ptr<media::LiveSource>> open_source(const std::string& where,
                                                       const SourceOptions& options);

/// With a head of ours for the page of a web server, unless there is one; browsers come by WebRTC
/// where they can.
web::WebOptions with_head(web::WebOptions options);

/// True for an address of WebRTC, which carries no other sound than Opus.
bool takes_opus_alone(const std::string& url);
/// True for an address whose receivers need a session description.
bool is_rtp(const std::string& url);

}  // namespace animeme::live
