/// @file
/// A face and its sound for browsers over UDP: WebRTC by GStreamer, in a module that is loaded when
/// it is asked for.
///
///     auto sink = make_webrtc_sink("webrtc://127.0.0.1:8080", options);  // WHEP: viewers come
///     auto other = make_whip_sink("whips://media.example/whip/ada");     // WHIP: a server takes
///     it
///
/// Packets of Opus go out as they are, as RTP whose clock is that of the web server: time 0 is
/// 48000. Access units and decoded values are messages of data channels that lose rather than wait.
/// What they look like, and what is said to whom: tools/live/webrtc/README.md. Nothing outside is
/// contacted unless a STUN or TURN server is named.
#pragma once

#include <memory>
#include <string>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/live/web/web.h"

/// Live transport by WebRTC.
namespace animeme::webrtc {

/// For all connections.
struct WebRtcOptions {
  std::string stun;  ///< "HOST:PORT" of a server that tells our address outside; empty: none
  std::string turn;  ///< "USER:PASSWORD@HOST:PORT" of a relay; empty: none
  /// Units that each message of `animeme.face` repeats from those before it, 0..30: so many
  /// messages in a row may be lost.
  int repeat = 5;
};

/// Is the module beside the program, or where it was installed? It is not loaded.
bool is_there();

/// Loads the module and looks for what it needs. Errors: unsupported (built without GStreamer, or
/// an element is missing; the message names the package).
Result<void> load();

/// For WebOptions::make_peers: `/whep` of a web server. `now`: its start() loads the module, else
/// the first offer does, and one that cannot be answered gets 501. Errors of start(): unsupported
/// (the sound is not Opus; those of load()).
std::unique_ptr<web::PeerConnections> make_peer_connections(const WebRtcOptions& options = {},
                                                            bool now = false);

/// Is this webrtc://...?
bool is_webrtc(const std::string& url);
/// Is this whip://... or whips://...?
bool is_whip(const std::string& url);

/// The http address of the server at a webrtc address; others as they are.
std::string page_of(const std::string& url);

/// webrtc://HOST:PORT is the web server at http://HOST:PORT with `/whep` for certain: as an http
/// address has it, but start() fails where there can be no WebRTC. Behind the port:
/// `?stun=HOST:PORT`, `turn=USER:PASSWORD@HOST:PORT`, `repeat=N`, `&` between them.
/// Errors: invalid_argument (address, options), those of make_web_sink(); those of start(): of
/// make_peers() and make_web_sink().
Result<std::unique_ptr<web::WebSink>> make_webrtc_sink(const std::string& url,
                                                       const web::WebOptions& options = {});

/// whip://HOST:PORT/PATH publishes to the WHIP server at http://HOST:PORT/PATH, whips:// to https.
/// `whip://TOKEN@HOST/PATH` or the environment's ANIMEME_WHIP_TOKEN is sent as bearer token.
/// Options as above, behind the path. start() waits for the answer, for 10 s at most; a server that
/// takes no data channel gets the sound alone. Errors: invalid_argument (address). Those of
/// start(): unsupported (as load(); the sound is not Opus; there is none and no face), io (the
/// server does not answer or refuses). Those of send(): io (the connection broke).
Result<std::unique_ptr<media::LiveSink>> make_whip_sink(const std::string& url);

}  // namespace animeme::webrtc
