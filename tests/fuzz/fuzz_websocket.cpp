// libFuzzer entry: what web servers and their clients hear. The first byte says which:
//   'w'  frames of a WebSocket client behind its request; the second byte chooses the address
//   'h'  a whole connection to the server, from the request line on
//   'u'  values of Host, Origin, Accept-Encoding, If-None-Match, one a line
//   'm'  messages of a server, as a source reads them: a byte (bit 0: of the sound), two bytes of
//        size, the message
//   'v'  access units that are sent on as values: two bytes of size, the unit
// make_corpus_websocket.cpp writes seeds.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/require.h"
#include "tests/fuzz/web_presentation.h"
#include "tools/formats/media/live/audio_segments.h"
#include "tools/formats/media/live/recorder.h"
#include "tools/live/web/detail/headers.h"
#include "tools/live/web/detail/messages.h"
#include "tools/live/web/detail/values.h"
#include "tools/live/web/web.h"

using animeme::test::require;

namespace {

using namespace animeme;
using namespace animeme::web;
using Bytes = std::span<const std::uint8_t>;

/// A server with a face and a sound that has sent some of both.
class TestServer {
 public:
  TestServer() {
    auto sink = make_web_sink("http://127.0.0.1:0/", {.max_clients = 1000, .per_address = 0});
    require(bool(sink));
    sink_ = std::move(*sink);
    const fuzz::WebPresentation show = fuzz::web_presentation();
    require(bool(sink_->start(show.info)));
    for (const media::LiveUnit& unit : show.units) require(bool(sink_->send(unit)));
    const std::string address = sink_->address();
    port_ = std::stoi(address.substr(address.rfind(':') + 1));
  }

  /// Sends all of it and hears to the end of the connection, or until nothing comes for a moment:
  /// a sound may last for ever.
  std::string talk(std::string_view bytes, int patience) {
    const int handle = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    // Addresses take turns, since each may ask 20 times a second only.
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1 + turn_++ % 250);
    (void)bind(handle, reinterpret_cast<sockaddr*>(&address), sizeof address);
    address.sin_port = htons(std::uint16_t(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string answer;
    if (connect(handle, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
      (void)send(handle, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      shutdown(handle, SHUT_WR);
      std::array<char, 16384> block{};
      pollfd ready{handle, POLLIN, 0};
      while (answer.size() < (1 << 20) && poll(&ready, 1, patience) > 0) {
        const ssize_t count = recv(handle, block.data(), block.size(), 0);
        if (count <= 0) break;
        answer.append(block.data(), std::size_t(count));
      }
    }
    const linger at_once{1, 0};  // no port waits for what nobody sends any more
    setsockopt(handle, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    close(handle);
    return answer;
  }

 private:
  std::unique_ptr<WebSink> sink_;
  int port_ = 0;
  unsigned turn_ = 0;
};

TestServer& server() {
  static TestServer server;
  return server;
}

void talk(std::string_view bytes) {
  static int turns = 0;
  (void)server().talk(bytes, 4);
  if (++turns % 64 != 0) return;
  const std::string answer = server().talk(
      "GET /info.json HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n", 5000);
  require(answer.starts_with("HTTP/1.1 200") || answer.starts_with("HTTP/1.1 429"));
}

void send_frames(Bytes frames) {
  if (frames.empty()) return;
  static constexpr const char* kPaths[] = {"/face", "/faps", "/audio"};
  std::string bytes =
      std::string("GET ") + kPaths[frames[0] % 3] +
      " HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
      "dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  bytes.append(frames.begin() + 1, frames.end());
  talk(bytes);
}

void read_headers(std::string_view text) {
  std::array<std::string_view, 4> value;
  for (std::string_view& each : value) {
    const std::size_t end = text.find('\n');
    each = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  static const OwnNames names({"127.0.0.1", 80}, {"talk.example"});
  const std::string name = host_name(value[0]);
  require(host_name(name) == name || name.find(':') != std::string::npos || name.ends_with('.'));
  const bool known =
      name == "localhost" || name == "127.0.0.1" || name == "::1" || name == "talk.example";
  require(names.contains(value[0]) == known);
  const bool allowed = origin_allowed(value[1], value[0], {"https://a.example"});
  if (known && allowed && value[1] != "https://a.example") {
    require(value[1].size() >= value[0].size() + 7);  // http://HOST
  }
  (void)takes_gzip(value[2]);
  require(!has_version(value[3], "\"x\"") || value[3].find_first_of("x*") != std::string::npos);
}

/// Calls `each` with the records of an input: `head` bytes, two of size, the content.
template <class Each>
void for_each_record(Bytes input, std::size_t head, const Each& each) {
  while (input.size() >= head + 2) {
    const std::size_t size =
        std::min<std::size_t>(input[head] * 256u + input[head + 1], input.size() - head - 2);
    each(input.first(head), input.subspan(head + 2, size));
    input = input.subspan(head + 2 + size);
  }
}

/// What a source makes of messages, without the connection.
void hear_server(Bytes input) {
  std::optional<Hello> hello;
  std::optional<media::AudioFormat> format;
  media::Recorder recorder;
  const auto accept = [&](media::LiveEvent event) {
    (void)recorder.accept(std::move(event));
    for (const media::LiveUnit& unit : recorder.take_units()) require(!unit.bytes.empty());
  };
  for_each_record(input, 1, [&](Bytes head, Bytes message) {
    const bool sound = (head[0] & 1) != 0;
    if (sound && !format) {
      auto read = media::read_audio_init(message);
      if (read) format = std::move(*read);
      return;
    }
    if (sound) {
      const auto packets = media::read_audio_segment(message);
      if (!packets || !hello) return;
      for (const media::AudioPacket& packet : *packets) {
        require(!packet.bytes.empty() && packet.duration > 0);
        accept(media::LiveUnit{media::LiveTrack::audio, packet.bytes, false, packet.time,
                               packet.duration});
      }
      return;
    }
    if (!hello) {
      auto read = read_hello(message);
      if (!read) return;
      require(write_hello(*read).size() == message.size());
      hello = std::move(*read);
      accept(media::LiveInfo{hello->config, hello->timescale, hello->visual_profile, format});
      return;
    }
    const auto unit = read_unit(message);
    if (!unit) return;
    const auto again = write_unit(*unit);
    require(std::equal(again.begin(), again.end(), message.begin(), message.end()));
    if ((unit->flags & kMissed) != 0) accept(media::LiveGap{media::LiveTrack::face, 0});
    accept(media::LiveUnit{media::LiveTrack::face, unit->bytes, (unit->flags & kIntra) != 0,
                           std::int64_t(unit->time), unit->duration});
  });
  accept(media::LiveEnd{});
}

void send_values(Bytes input) {
  Values values;
  double time = 0;
  for_each_record(input, 0, [&](Bytes, Bytes unit) {
    const auto face = values.push(unit);
    if (!face) return;
    const std::string text = write_values({time += 0.04, 0.04, false, unit.size()}, *face);
    require(nlohmann::json::accept(text));
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2 || size > 20000) return 0;
  const Bytes rest(data + 1, size - 1);
  const std::string_view text(reinterpret_cast<const char*>(rest.data()), rest.size());
  switch (data[0]) {
    case 'w':
      send_frames(rest);
      break;
    case 'h':
      talk(text);
      break;
    case 'u':
      read_headers(text);
      break;
    case 'm':
      hear_server(rest);
      break;
    case 'v':
      send_values(rest);
      break;
    default:
      break;
  }
  return 0;
}
