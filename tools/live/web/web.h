/// @file
/// A small web server as a live transport for browsers, and its client.
///
///     auto sink = make_web_sink("http://127.0.0.1:8080/");
///     (*sink)->start(info);                       // now http://127.0.0.1:8080/ shows the page
///     auto source = make_web_source("ws://127.0.0.1:8080/");
///
/// tools/live/web/protocol.md documents the protocol: the page `/`, `/face` (access units), `/faps`
/// (decoded values, as JSON or compact), `/audio` (segments for MediaSource), all three as
/// WebSockets, `/talk.mp4` (endless mp4 of the sound) and `/info.json`. Nothing is read from disk.
/// No encryption: use a proxy if necessary.
///
/// The clock that browsers see is that of the sound segments. It runs one second ahead of LiveUnit
/// times (kWebTimeZero), so that the priming of the sound has non-negative times; the source
/// subtracts it.
/// Source: tools/formats/media/containers.md, section 4.4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/live/live.h"
#include "tools/live/web/peer_connections.h"

/// A web server and its client as live transports.
namespace animeme::web {

/// Seconds on the clock of the segments at time 0.
inline constexpr int kWebTimeZero = 1;

/// A further head for the page.
struct WebHead {
  std::string name;                 ///< display name in the list; any text
  std::vector<std::uint8_t> model;  ///< bytes of viewer::pack_head()
};

/// For both directions.
struct WebOptions {
  /// Maximum number of viewers, 1..1000; further ones get 503. A viewer has a WebSocket for the
  /// face, one for the sound (or /talk.mp4), or both.
  int max_clients = 64;
  /// Maximum number of connections per address (IPv6: per network); 0: unlimited connections and
  /// requests, for use behind a proxy.
  int per_address = 32;
  /// Maximum queue of a client, bytes. On overflow the queue is dropped (SendStats::dropped), and
  /// the client continues with the next intra plane or segment.
  std::size_t client_bytes = std::size_t(1) << 20;
  /// A client that reads nothing for this many seconds while data is queued is disconnected.
  double stall_seconds = 20;
  /// New clients immediately get everything since the latest intra plane. False: they wait for the
  /// next one.
  bool catch_up = true;
  /// Packets of sound in a segment, 1..64. Less delay or less traffic: 4 of AAC are 85 ms.
  int packets_per_segment = 4;
  /// Origins of other sites that may use this server and embed its page in a frame
  /// ("https://example.org"; "*": all). Empty: only pages of this server, and programs other than
  /// browsers.
  std::vector<std::string> allow_origins;
  /// Additional names and addresses accepted in the Host header. By default these are localhost,
  /// the address it listens on and, if reachable from the network, the names and addresses of this
  /// machine. Others get 421, to prevent DNS rebinding. "*": any.
  std::vector<std::string> host_names;
  /// A head for the page instead of the schematic face: viewer::head_script() and the bytes of
  /// viewer::pack_head(), served as /head.bin. Both or none. Browsers without WebGL2 show the
  /// schematic face.
  std::string head_script;
  std::vector<std::uint8_t> head_model;  ///< see head_script
  /// In place of head_model, where making it takes long: called once, in a thread, when the server
  /// serves; who asks for the head until then waits for it. Empty bytes: there is none.
  std::function<std::vector<std::uint8_t>()> make_head_model;
  std::string head_name;  ///< of that head, for a list of several; any text
  /// Further heads, /heads/1.bin and so on, selected in a list or by ?head=NAME.
  std::vector<WebHead> other_heads;
  /// Creates the WebRTC implementation for `/whep`; empty: no WebRTC. If its start() fails, the
  /// server runs without, unless `must_have_peer_connections`.
  std::function<std::unique_ptr<PeerConnections>()> make_peer_connections;
  bool must_have_peer_connections = false;  ///< see make_peer_connections
  /// Source: maximum bytes queued for next(); then the network is not read.
  std::size_t queue_bytes = std::size_t(4) << 20;
};

/// Can other machines reach a server at this address ("http://0.0.0.0:8080/")? False for invalid
/// addresses.
bool is_open_to_others(const std::string& url);

/// A LiveSink with an address.
class WebSink : public media::LiveSink {
 public:
  /// "http://127.0.0.1:8080/" with the real port; empty before start().
  virtual std::string address() const = 0;
  /// As LiveSink::tell(), for the sockets of an Intake (web_server.h) alone.
  virtual Result<void> tell_owner(const std::string& json) = 0;
  /// Instead of finish(): viewers are told to come back (1001), as what they watch is made anew.
  virtual Result<void> leave() = 0;
};

/// A server at http://HOST:PORT/. HOST is the address to listen at: none, or localhost: this
/// machine only; 0.0.0.0: everywhere. PORT 0: any free one. It listens from start() to finish(), in
/// a separate thread; poll() does nothing.
/// Errors: invalid_argument (address, options), unsupported (built without libwebsockets).
/// Those of start(): io (port in use, no such address), invalid_argument (neither face nor sound).
/// Those of send(): invalid_argument (earlier than one second before time 0, no such track).
Result<std::unique_ptr<WebSink>> make_web_sink(const std::string& url,
                                               const WebOptions& options = {});

/// Receives from the server at ws://HOST:PORT/ (or http://), or one of many heads at
/// ws://HOST:PORT/heads/NAME/. Connects now, within 5 seconds. Units are received byte for byte,
/// with their times and durations; late joining depends on WebOptions::catch_up. If the server
/// drops units for this client, there is a LiveGap (`packets` 0: unknown). AudioFormat::priming is
/// that of the sender if the first packet was available, else 0, and OpusHead agrees with it.
/// Errors: invalid_argument (address), unsupported (wss; built without libwebsockets), io (no
/// server). Those of next(): io (the connection broke), syntax (another kind of server).
Result<std::unique_ptr<media::LiveSource>> make_web_source(const std::string& url,
                                                           const WebOptions& options = {});

}  // namespace animeme::web
