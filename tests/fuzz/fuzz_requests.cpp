// Requests to serve, as bytes of a connection: the server answers the next client whatever came.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "tests/fuzz/require.h"
#include "tools/live/serve/server.h"

using animeme::test::require;

namespace {

using namespace animeme;

constexpr int kMostHeads = 3, kHealthEvery = 8;

// A voice that says nothing.
Result<speech::LineMaker> silent_voice(const voice::VoiceOptions& options) {
  if (options.language == "none") return make_error(Code::not_found, "no such voice");
  speech::LineMaker maker;
  maker.make = [](std::string line, const speech::Wanted&) -> Result<speech::SpokenLine> {
    speech::SpokenLine spoken;
    spoken.text = std::move(line);
    return spoken;
  };
  maker.most_bytes = 100;
  maker.cut = false;
  return maker;
}

std::unique_ptr<serve::HeadServer> start() {
  serve::ServerOptions options;
  options.url = "http://127.0.0.1:0/";
  options.most_heads = kMostHeads;
  options.make_on_say = true;
  options.threads = 1;
  options.voices = silent_voice;
  auto server = serve::HeadServer::open(options, {{"a", {}}});
  require(server.has_value());
  return std::move(*server);
}

struct Connection {
  int handle = -1;
  explicit Connection(int port) : handle(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    require(::connect(handle, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::close(handle); }

  void wait(int milliseconds) const {
    const timeval time{milliseconds / 1000, milliseconds % 1000 * 1000};
    ::setsockopt(handle, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
  }
  /// What comes until the end, the time or 64 kB.
  std::string ask(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(handle, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) break;
      bytes.remove_prefix(std::size_t(sent));
    }
    ::shutdown(handle, SHUT_WR);
    std::string answer;
    char buffer[4096];
    while (answer.size() < 65536) {
      const ssize_t count = ::recv(handle, buffer, sizeof buffer, 0);
      if (count <= 0) break;
      answer.append(buffer, std::size_t(count));
    }
    return answer;
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::unique_ptr<serve::HeadServer> server = start();
  static const int port = [] {
    std::string address = server->address();
    if (address.ends_with('/')) address.pop_back();
    return std::atoi(address.c_str() + address.rfind(':') + 1);
  }();
  static int count = 0;
  if (size > 100000) return 0;
  {
    const Connection client(port);
    client.wait(20);
    (void)client.ask({reinterpret_cast<const char*>(data), size});
  }
  if (++count % kHealthEvery != 0) return 0;
  const Connection client(port);
  client.wait(300000);  // the machine may be busy
  const std::string answer =
      client.ask("GET /health HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
  require(answer.starts_with("HTTP/1.1 200"));
  const tools::Json figures = server->figures();
  require(figures.find("count") != nullptr);
  for (const tools::Json& head : *figures.find("heads")) {
    const tools::Json* const name = head.find("name");
    if (name != nullptr && name->text() != "a") server->remove(name->text());
  }
  return 0;
}
