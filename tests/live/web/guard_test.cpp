// What strangers may take of the server, and what it tells browsers to forbid them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "tests/live/web/http.h"
#include "tests/support/live_loop.h"
#include "tests/support/program.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace guard_test {

using ::testing::HasSubstr;
using ::testing::Not;

class Guard : public ::testing::Test {
 protected:
  void serve(const web::WebOptions& options = {}, const std::string& url = "http://127.0.0.1:0/") {
    sink_.reset();
    show_ = live_presentation(60, 20);
    add_sound(show_, aac_format());
    auto sink = web::make_web_sink(url, options);
    ASSERT_TRUE(sink) << sink.error().describe();
    const Result<void> started = (*sink)->start(show_.info);
    ASSERT_TRUE(started) << started.error().describe();
    sink_ = std::move(*sink);
    port_ = port_of(sink_->address());
  }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_) + "/"; }
  int asked_as(const std::string& host, const std::string& path = "/info.json") const {
    return status_of(ask(port_, "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n"));
  }

  Presentation show_;
  std::unique_ptr<web::WebSink> sink_;
  int port_ = 0;
};

// A page elsewhere has its name lead here (DNS rebinding): the browser takes both for one server.
TEST_F(Guard, NamesOfOthersAreRefused) {
  serve();
  const std::string port = ":" + std::to_string(port_);
  for (const std::string host : {"localhost", "127.0.0.1", "[::1]", "LocalHost"}) {
    EXPECT_EQ(asked_as(host), 200) << host;
    EXPECT_EQ(asked_as(host + port), 200) << host;
  }
  for (const std::string host : {"evil.example", "192.0.2.1", "localhost.evil.example", "[::2]",
                                 "127.0.0.1@evil.example", "localhost:80:80", "[::1]x"}) {
    EXPECT_EQ(asked_as(host), 421) << host;
    EXPECT_EQ(asked_as(host, "/"), 421) << host;
    EXPECT_EQ(asked_as(host, "/talk.mp4"), 421) << host;
  }
  EXPECT_EQ(status_of(ask(port_, "GET / HTTP/1.1\r\n")), 400) << "no host at all";
  const auto rebound = [&](const std::string& path) {
    Connection socket(port_);
    socket.send("GET " + path +
                " HTTP/1.1\r\nHost: evil.example\r\nOrigin: http://evil.example\r\n"
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    return status_of(socket.read_all());
  };
  for (const char* path : {"/faps", "/face", "/audio"}) EXPECT_EQ(rebound(path), 421) << path;
  serve({.host_names = {"talk.example"}});
  EXPECT_EQ(asked_as("talk.example"), 200);
  EXPECT_EQ(asked_as("Talk.Example.:8080"), 200);
  EXPECT_EQ(asked_as("evil.example"), 421);
  serve({.host_names = {"*"}});
  EXPECT_EQ(asked_as("evil.example"), 200);
}

// Who opens connections and asks nothing keeps nobody out, and is gone after some seconds.
TEST_F(Guard, HalfOpenRequestsKeepNobodyOut) {
  serve();
  std::vector<std::unique_ptr<Connection>> idlers;
  for (int i = 0; i < 400; ++i) {
    idlers.push_back(std::make_unique<Connection>(port_, 0, i % 2 == 0 ? nullptr : "127.0.0.2"));
    idlers.back()->send("GET / HTTP/1.1\r\nHost: local");
  }
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200);
  auto source = web::make_web_source(url());  // a viewer; it waits for five seconds at most
  ASSERT_TRUE(source) << source.error().describe();
  for (const media::LiveUnit& unit : show_.units) ASSERT_TRUE(sink_->send(unit));
  Received got;
  while (got.units.empty() && receive(**source, got, 20)) {
  }
  EXPECT_FALSE(got.units.empty());
  int closed = 0;
  for (const auto& idler : idlers) {
    idler->read_all(20);
    closed += idler->closed();
  }
  EXPECT_EQ(closed, 400) << "each of them is disconnected";
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200);
}

// A byte now and then is no request, either.
TEST_F(Guard, ARequestThatTricklesIsDisconnected) {
  serve();
  Connection slow(port_);
  slow.send("GET / HTTP/1.1\r\n");
  for (int i = 0; i < 300 && !slow.closed(); ++i) {
    slow.send("X: y\r\n");
    slow.read([](const std::string&) { return false; }, 0.1);
  }
  EXPECT_TRUE(slow.closed());
}

TEST_F(Guard, AnAddressHasItsShare) {
  serve({.max_clients = 100, .per_address = 6});
  std::vector<std::unique_ptr<Connection>> sockets;
  int open = 0;
  for (int i = 0; i < 12; ++i) {
    sockets.push_back(std::make_unique<Connection>(port_, 0, "127.0.0.3"));
    sockets.back()->send(upgrade(port_, i % 2 == 0 ? "/faps" : "/audio"));
    open += status_of(sockets.back()->read([](const std::string& text) { return text.size() > 12; },
                                           5)) == 101;
  }
  EXPECT_EQ(open, 6);
  EXPECT_EQ(sink_->stats().receivers, 3);
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200) << "others are served";
  serve({.max_clients = 100, .per_address = 0});
  sockets.clear();
  open = 0;
  for (int i = 0; i < 50; ++i) {
    sockets.push_back(std::make_unique<Connection>(port_, 0, "127.0.0.3"));
    sockets.back()->send(upgrade(port_, "/faps"));
    open += status_of(sockets.back()->read([](const std::string& text) { return text.size() > 12; },
                                           5)) == 101;
  }
  EXPECT_EQ(open, 50);
}

TEST_F(Guard, WhoAsksAllTheTimeIsPutOff) {
  serve();
  int refused = 0;
  for (int i = 0; i < 2000 && refused == 0; ++i) {
    const std::string request = "GET /info.json HTTP/1.1\r\nHost: localhost\r\n";
    refused += status_of(ask(port_, request, "127.0.0.4")) == 429;
  }
  EXPECT_EQ(refused, 1);
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200) << "others are served";
}

TEST_F(Guard, HeadIsGetWithoutABody) {
  serve({.head_script = "class HeadView {}\n", .head_model = {1, 2, 3}});
  for (const char* path : {"/", "/live.js", "/live.css", "/head.js", "/head.bin", "/info.json"}) {
    const std::string host = " HTTP/1.1\r\nHost: localhost\r\n";
    const std::string head = ask(port_, std::string("HEAD ") + path + host);
    const std::string whole = ask(port_, std::string("GET ") + path + host);
    EXPECT_EQ(status_of(head), 200) << path;
    EXPECT_EQ(body_of(head), "") << path;
    EXPECT_EQ(head.substr(0, head.find("\r\n\r\n")), whole.substr(0, whole.find("\r\n\r\n")))
        << path;
    EXPECT_EQ(std::to_string(body_of(whole).size()), header_of(whole, "content-length")) << path;
  }
  EXPECT_EQ(status_of(ask(port_, "HEAD /nothing HTTP/1.1\r\nHost: localhost\r\n")), 404);
  Connection kept(port_);  // the connection goes on behind an answer without a body
  kept.send("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  kept.read([](const std::string& text) { return text.find("\r\n\r\n") != text.npos; });
  kept.send("GET /head.bin HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const std::string second = kept.read(
      [](const std::string& text) { return text.find("\r\n\r\n\x01\x02\x03") != text.npos; });
  EXPECT_EQ(body_of(second), "\x01\x02\x03");
}

std::string unpack(const std::string& packed, std::size_t size) {
  std::string out(size + 1, 0);
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = uInt(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = uInt(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

TEST_F(Guard, TheHeadIsPackedAndKeptByBrowsers) {
  std::vector<std::uint8_t> model(100000);
  for (std::size_t i = 0; i < model.size(); ++i) model[i] = std::uint8_t(i / 100);
  serve({.head_script = "class HeadView {}\n", .head_model = model});
  const std::string plain = get(port_, "/head.bin");
  EXPECT_EQ(body_of(plain).size(), model.size());
  EXPECT_EQ(header_of(plain, "content-encoding"), "");
  EXPECT_EQ(header_of(plain, "cache-control"), "no-cache") << "kept, but asked for each time";
  EXPECT_THAT(header_of(plain, "vary"), HasSubstr("accept-encoding"));
  const std::string packed = get(port_, "/head.bin", "Accept-Encoding: deflate, gzip, br\r\n");
  EXPECT_EQ(header_of(packed, "content-encoding"), "gzip");
  EXPECT_LT(body_of(packed).size(), model.size() / 10);
  EXPECT_EQ(unpack(body_of(packed), model.size()), body_of(plain));
  EXPECT_EQ(body_of(get(port_, "/head.bin", "Accept-Encoding: gzip;q=0\r\n")), body_of(plain));
  const std::string tag = header_of(plain, "etag"), packed_tag = header_of(packed, "etag");
  EXPECT_NE(tag, packed_tag) << "two forms";
  const std::string same = get(port_, "/head.bin", "If-None-Match: \"x\", " + tag + "\r\n");
  EXPECT_EQ(status_of(same), 304);
  EXPECT_EQ(body_of(same), "");
  EXPECT_EQ(header_of(same, "etag"), tag);
  EXPECT_EQ(status_of(get(port_, "/head.bin", "If-None-Match: " + packed_tag + "\r\n")), 200);
  EXPECT_EQ(header_of(get(port_, "/info.json"), "cache-control"), "no-store");
  model[5] ^= 1;
  serve({.head_script = "class HeadView {}\n", .head_model = model});
  EXPECT_EQ(status_of(get(port_, "/head.bin", "If-None-Match: " + tag + "\r\n")), 200);
}

TEST_F(Guard, ThePolicyIsTight) {
  serve();
  for (const char* path : {"/", "/info.json", "/nothing"}) {
    const std::string answer = get(port_, path);
    const std::string policy = header_of(answer, "content-security-policy");
    EXPECT_THAT(policy, HasSubstr("default-src 'none'")) << path;
    EXPECT_THAT(policy, HasSubstr("connect-src 'self';")) << path;
    EXPECT_THAT(policy, HasSubstr("script-src 'self';")) << path;
    EXPECT_THAT(policy, Not(HasSubstr("unsafe"))) << path;
    EXPECT_EQ(header_of(answer, "x-content-type-options"), "nosniff") << path;
    EXPECT_EQ(header_of(answer, "referrer-policy"), "no-referrer") << path;
  }
}

// What moves a head is WebAssembly: allowed on the page that has one, nowhere else.
TEST_F(Guard, ThePolicyLetsAHeadMove) {
  serve({.head_script = "class HeadView {}\n", .head_model = {1, 2, 3}});
  for (const char* path : {"/", "/index.html", "/head.js", "/info.json", "/nothing"}) {
    const std::string policy = header_of(get(port_, path), "content-security-policy");
    const bool page = path == std::string("/") || path == std::string("/index.html");
    EXPECT_THAT(policy,
                HasSubstr(page ? "script-src 'self' 'wasm-unsafe-eval';" : "script-src 'self';"))
        << path;
    EXPECT_THAT(policy, Not(HasSubstr("'unsafe"))) << path;
  }
}

// A third party: what it asks for and understands.
TEST_F(Guard, CurlGetsTheHead) {
  if (std::system("curl --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs curl";
  const std::vector<std::uint8_t> model(100000, 'm');
  serve({.head_script = "class HeadView {}\n", .head_model = model});
  const TempDir dir;
  const std::string head = url() + "head.bin", tag = dir / "tag", got = dir / "got";
  const auto curl = [&](const std::string& options) {
    return std::system(("curl -sS --max-time 60 " + options + " >" + (dir / "out")).c_str());
  };
  EXPECT_EQ(curl("--fail --compressed --etag-save " + tag + " -o " + got + " " + head), 0);
  EXPECT_EQ(slurp(got).size(), model.size());
  EXPECT_EQ(curl("--fail --compressed --etag-compare " + tag + " -w '%{http_code}' " + head), 0);
  EXPECT_EQ(slurp(dir / "out"), "304");
  EXPECT_EQ(curl("--fail -I " + head), 0);
  EXPECT_THAT(slurp(dir / "out"), HasSubstr("content-length: 100000"));
  EXPECT_NE(curl("--fail -H 'Host: evil.example' " + head), 0);
  EXPECT_EQ(curl("-X DELETE -w '%{http_code}' -o /dev/null " + head), 0);
  EXPECT_EQ(slurp(dir / "out"), "405");
}

TEST_F(Guard, WhatOthersReachIsKnown) {
  EXPECT_TRUE(web::is_open_to_others("http://0.0.0.0:8080/"));
  EXPECT_TRUE(web::is_open_to_others("http://[::]:8080/"));
  EXPECT_TRUE(web::is_open_to_others("http://192.0.2.1:8080/"));
  for (const char* url : {"http://127.0.0.1:1/", "http://localhost:1/", "http://:1/",
                          "http://[::1]:1/", "http://127.1.2.3/", "rtp://0.0.0.0:5004", "x"}) {
    EXPECT_FALSE(web::is_open_to_others(url)) << url;
  }
}

TEST_F(Guard, OptionsAreChecked) {
  for (const char* origin : {"example.org", "https://example.org/", "https://a b", "",
                             "https://a;script-src", "https://a,b"}) {
    const auto sink = web::make_web_sink("http://127.0.0.1:0/", {.allow_origins = {origin}});
    ASSERT_FALSE(sink) << origin;
    EXPECT_EQ(sink.error().code, Code::invalid_argument);
    EXPECT_THAT(sink.error().message, HasSubstr("https://example.org"));
  }
  for (const char* name : {"", "a b", "http://example.org"}) {
    EXPECT_FALSE(web::make_web_sink("http://127.0.0.1:0/", {.host_names = {name}})) << name;
  }
  EXPECT_FALSE(web::make_web_sink("http://127.0.0.1:0/", {.per_address = -1}));
}

}  // namespace guard_test
}  // namespace animeme::test
