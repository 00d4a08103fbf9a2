/// @file
/// A face and its sound for browsers: a small web server as a live transport, and a client of it.
///
///     auto sink = make_web_sink("http://127.0.0.1:8080/");
///     (*sink)->start(info);                       // now http://127.0.0.1:8080/ shows the page
///     auto source = make_web_source("ws://127.0.0.1:8080/");
///
/// What the server offers, and each byte of it, stands in tools/live/web/protocol.md: the page `/`,
/// `/face` (access units), `/faps` (decoded values, as JSON or small), `/audio` (segments for
/// MediaSource), all three as WebSockets, `/talk.mp4` (endless mp4 of the sound) and `/info.json`.
/// Nothing is read from disk. No encryption: put a proxy in front of it where that is wanted.
///
/// The clock that browsers see is that of the sound segments. It runs one second ahead of LiveUnit
/// times (kWebTimeZero), so that the priming of the sound has a place; the source takes it off.
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

/// Another head for the page.
struct WebHead {
  std::string name;                 ///< what people choose; any text
  std::vector<std::uint8_t> model;  ///< bytes of viewer::pack_head()
};

/// For both directions.
struct WebOptions {
  /// Viewers at the same time, 1..1000; whoever comes then gets 503. A viewer has a WebSocket for
  /// the face, one for the sound (or /talk.mp4), or both.
  int max_clients = 64;
  /// Connections of one address (of IPv6: of one network) at the same time; 0: any number, also of
  /// requests, as a proxy in front of the server wants it.
  int per_address = 32;
  /// Bytes that may wait for one client. When it has more, they are thrown away
  /// (SendStats::dropped), and it goes on with the next intra plane or segment.
  std::size_t client_bytes = std::size_t(1) << 20;
  /// A client that takes nothing for so many seconds while something waits is disconnected.
  double stall_seconds = 20;
  /// New clients get at once what was sent since the newest intra plane, so that they can begin.
  /// False: they wait for the next one.
  bool catch_up = true;
  /// Packets of sound in a segment, 1..64. Less delay or less traffic: 4 of AAC are 85 ms.
  int packets_per_segment = 4;
  /// Origins of pages elsewhere that may use this server and show its page in a frame
  /// ("https://example.org"; "*": all). None: only pages of this server and programs that are no
  /// browsers.
  std::vector<std::string> allow_origins;
  /// Names and addresses by which this server may be called in the Host header of a request,
  /// besides its own: localhost, the address at which it listens and, if that is open to others,
  /// the names and addresses of this machine. Others get 421, since a page elsewhere could call
  /// itself so (DNS rebinding). "*": any.
  std::vector<std::string> host_names;
  /// A head for the page, in place of its schematic face: viewer::head_script() and the bytes of
  /// viewer::pack_head(), which the server then has as /head.bin. Both or none. Browsers without
  /// WebGL2 keep the schematic face.
  std::string head_script;
  std::vector<std::uint8_t> head_model;  ///< see head_script
  std::string head_name;                 ///< of that head, for a list of several; any text
  /// Further heads, /heads/1.bin and so on: people choose one, or the address does (?head=NAME).
  std::vector<WebHead> other_heads;
  /// Makes what answers WebRTC, which the server then offers at `/whep`; none: no WebRTC. If its
  /// start() fails the server goes on without, unless `must_have_peers`.
  std::function<std::unique_ptr<PeerConnections>()> make_peer_connections;
  bool must_have_peer_connections = false;  ///< see make_peers
  /// Source: bytes that may wait for next(); the network waits when they are full.
  std::size_t queue_bytes = std::size_t(4) << 20;
};

/// Can other machines reach a server at this address ("http://0.0.0.0:8080/")? False for what is no
/// such address.
bool is_open_to_others(const std::string& url);

/// A LiveSink that can tell where it is.
class WebSink : public media::LiveSink {
 public:
  /// "http://127.0.0.1:8080/" with the real port; empty before start().
  virtual std::string address() const = 0;
};

/// A server at http://HOST:PORT/. HOST is the address to listen at: none, or localhost: this
/// machine only; 0.0.0.0: everywhere. PORT 0: any free one. It listens from start() to finish(), in
/// a thread of its own; poll() has nothing to do.
/// Errors: invalid_argument (address, options), unsupported (built without libwebsockets).
/// Those of start(): io (port in use, no such address), invalid_argument (neither face nor sound).
/// Those of send(): invalid_argument (earlier than one second before time 0, no such track).
Result<std::unique_ptr<WebSink>> make_web_sink(const std::string& url,
                                               const WebOptions& options = {});

/// Receives from the server at ws://HOST:PORT/ (or http://), of one of many heads at
/// ws://HOST:PORT/heads/NAME/. Connects now, for 5 seconds at most.
/// Units come back byte for byte, with their times and durations; a late joiner begins as
/// WebOptions::catch_up says. LiveGap stands where the server had to drop units for this client
/// (`packets` 0: not known). AudioFormat::priming is that of the sender if the first packet was at
/// hand, else 0, and that of OpusHead agrees with it.
/// Errors: invalid_argument (address), unsupported (wss; built without libwebsockets), io (nobody
/// there). Those of next(): io (the connection broke), syntax (not one of our servers).
Result<std::unique_ptr<media::LiveSource>> make_web_source(const std::string& url,
                                                           const WebOptions& options = {});

}  // namespace animeme::web
