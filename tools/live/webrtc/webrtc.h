/// @file
/// WebRTC for browsers, with GStreamer, in a module that is loaded on demand.
///
///     auto sink = make_webrtc_sink("webrtc://127.0.0.1:8080", options);  // WHEP: for viewers
///     auto other = make_whip_sink("whips://media.example/whip/ada");     // WHIP: a server takes
///     it
///
/// Opus packets are sent unchanged as RTP on the clock of the web server: time 0 is 48000. Access
/// units and decoded values are messages of unreliable data channels. tools/live/webrtc/README.md
/// documents messages and signalling. No other host is contacted unless a STUN or TURN server is
/// given.
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
  std::string stun;  ///< "HOST:PORT" of a STUN server; empty: none
  std::string turn;  ///< "USER:PASSWORD@HOST:PORT" of a relay; empty: none
  /// Number of previous units repeated in each message of `animeme.face`, 0..30: as many
  /// consecutive messages may be lost.
  int repeat = 5;
  /// Number of previous packets of sound repeated with each (RFC 2198), 0..3; -1: by the loss that
  /// a receiver reports, none without loss. Only for receivers that know it, as Chromium does.
  int audio_repeat = -1;
};

/// Adds a server that helps to find a way, "stun:HOST:PORT" or "turn:USER:PASSWORD@HOST:PORT"; one
/// of each kind. Errors: invalid_argument (another form, a second one of a kind).
Result<void> add_ice_server(const std::string& text, WebRtcOptions& options);

/// Does the module exist next to the program or in the installation? Does not load it.
bool is_there();

/// Loads the module and checks its requirements. Errors: unsupported (built without GStreamer, or
/// an element is missing; the message names the package).
Result<void> load();

/// For WebOptions::make_peer_connections: `/whep` of a web server. `now`: start() loads the module;
/// otherwise the first offer does, with status 501 if that fails. Errors of start(): unsupported
/// (the sound is not Opus; those of load()).
std::unique_ptr<web::PeerConnections> make_peer_connections(const WebRtcOptions& options = {},
                                                            bool now = false);

/// Is this webrtc://...?
bool is_webrtc(const std::string& url);
/// Is this whip://... or whips://...?
bool is_whip(const std::string& url);

/// The http address for a webrtc address; others are unchanged.
std::string page_of(const std::string& url);

/// webrtc://HOST:PORT is the web server at http://HOST:PORT with mandatory `/whep`: start() fails
/// without WebRTC. After the port: `?stun=HOST:PORT`, `turn=USER:PASSWORD@HOST:PORT`, `repeat=N`,
/// `audio-repeat=N`, `&` between them.
/// Errors: invalid_argument (address, options), those of make_web_sink(); those of start(): of
/// make_peer_connections() and make_web_sink().
Result<std::unique_ptr<web::WebSink>> make_webrtc_sink(const std::string& url,
                                                       const web::WebOptions& options = {});

/// whip://HOST:PORT/PATH publishes to the WHIP server at http://HOST:PORT/PATH, whips:// to https.
/// `whip://TOKEN@HOST/PATH` or the environment's ANIMEME_WHIP_TOKEN is sent as bearer token.
/// Options as above, after the path. start() waits up to 10 s for the answer; a server without data
/// channels only gets the sound. Errors: invalid_argument (address). Those of start(): unsupported
/// (as load(); the sound is not Opus; neither sound nor face), io (the server does not answer or
/// rejects). Those of send(): io (the connection broke).
Result<std::unique_ptr<media::LiveSink>> make_whip_sink(const std::string& url);

}  // namespace animeme::webrtc
