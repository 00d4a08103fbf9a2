// `/whep` of the web server as browsers and strangers ask it. Who answers is made up: neither
// GStreamer nor a browser is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "tests/live/web/http.h"
#include "tests/support/live_reference.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace whep_test {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// What the made-up one has seen.
struct Seen {
  std::string sdp, address;
  std::atomic<int> units = 0, values = 0, expected = 0, finished = 0;
  std::atomic<int> viewers = 0;
  bool answers = true, starts = true;
};

class Fake : public web::PeerConnections {
 public:
  explicit Fake(Seen& seen) : seen_(seen) {}
  ~Fake() override { finish(true); }
  Result<void> start(const media::LiveInfo&, int, int) override {
    if (!seen_.starts) return make_error(Code::unsupported, "not today");
    return {};
  }
  void expect() override { ++seen_.expected; }
  void offer(std::string sdp, std::string address,
             std::function<void(web::PeerAnswer)> answer) override {
    seen_.sdp = std::move(sdp);
    seen_.address = std::move(address);
    if (!seen_.answers) return;
    threads_.emplace_back([answer] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      answer({201, "abc", "v=0 answer"});
    });
  }
  bool end(const std::string& id) override { return id == "abc"; }
  void send(const media::LiveUnit&, std::string_view values) override {
    ++seen_.units;
    if (!values.empty()) ++seen_.values;
  }
  void finish(bool) override {
    for (std::thread& thread : std::exchange(threads_, {})) thread.join();
    ++seen_.finished;
  }
  int busy() const override { return seen_.viewers; }
  media::SendStats stats() const override { return {.packets = 7, .receivers = seen_.viewers}; }

 private:
  Seen& seen_;
  std::vector<std::thread> threads_;
};

class Whep : public ::testing::Test {
 protected:
  void serve(web::WebOptions options = {}) {
    options.make_peer_connections = [this] { return std::make_unique<Fake>(seen_); };
    auto sink = web::make_web_sink("http://127.0.0.1:0/", options);
    ASSERT_TRUE(sink);
    sink_ = std::move(*sink);
    ASSERT_TRUE(sink_->start(show_.info));
    port_ = port_of(sink_->address().substr(0, sink_->address().size() - 1));
  }
  /// `what`: "POST /whep"; `headers` with their line ends.
  std::string ask_for(const std::string& what, const std::string& headers = "",
                      const std::string& body = "") {
    Connection connection(port_);
    connection.send(
        what + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
        "\r\nConnection: close\r\n" + headers +
        (body.empty() ? "" : "Content-Length: " + std::to_string(body.size()) + "\r\n") + "\r\n" +
        body);
    return connection.read_all();
  }
  std::string post(const std::string& headers = "", const std::string& body = "v=0 offer") {
    return ask_for("POST /whep", "Content-Type: application/sdp\r\n" + headers, body);
  }

  Presentation show_ = live_presentation(10, 5);
  Seen seen_;
  std::unique_ptr<web::WebSink> sink_;
  int port_ = 0;
};

TEST_F(Whep, AnOfferIsAnswered) {
  serve();
  const std::string answer = post();
  EXPECT_EQ(status_of(answer), 201) << answer;
  EXPECT_EQ(header_of(answer, "content-type"), "application/sdp");
  EXPECT_EQ(header_of(answer, "location"), "/whep/abc");
  EXPECT_EQ(body_of(answer), "v=0 answer");
  EXPECT_EQ(seen_.sdp, "v=0 offer");
  EXPECT_EQ(seen_.address, std::string("\x7f\x00\x00\x01", 4));
  EXPECT_EQ(status_of(ask_for("DELETE /whep/abc")), 200);
  EXPECT_EQ(status_of(ask_for("DELETE /whep/abd")), 404);
  EXPECT_THAT(get(port_, "/info.json"), HasSubstr("\"webrtc\":true"));
  EXPECT_EQ(seen_.expected, 0);
  get(port_, "/");
  EXPECT_EQ(seen_.expected, 1) << "who looks at the page may come";
}

TEST_F(Whep, UnitsGoWithTheirValues) {
  serve();
  for (const media::LiveUnit& unit : show_.units) ASSERT_TRUE(sink_->send(unit));
  EXPECT_EQ(seen_.units, 10);
  EXPECT_EQ(seen_.values, 10);
  EXPECT_GE(sink_->stats().packets, 7);
  ASSERT_TRUE(sink_->finish());
  EXPECT_GE(seen_.finished, 1);
}

TEST_F(Whep, WhatIsNoOfferIsRefused) {
  serve();
  EXPECT_EQ(status_of(ask_for("POST /whep", "Content-Type: text/plain\r\n", "x")), 415);
  for (const char* what :
       {"GET /whep", "HEAD /whep", "PATCH /whep/abc", "DELETE /whep", "POST /whep/abc"}) {
    const std::string answer = ask_for(what);
    EXPECT_EQ(status_of(answer), 405) << what;
    EXPECT_EQ(header_of(answer, "allow"), "POST, DELETE, OPTIONS") << what;
  }
  EXPECT_EQ(status_of(post("", std::string(100000, 'x'))), 0) << "more than an offer can be";
  EXPECT_EQ(status_of(ask_for("POST /", "", "x")), 405);
  EXPECT_EQ(seen_.sdp, "");
}

TEST_F(Whep, PagesElsewhereNeedToBeAllowed) {
  serve({.allow_origins = {"https://good.example"}});
  EXPECT_EQ(status_of(post("Origin: https://bad.example\r\n")), 403);
  EXPECT_EQ(status_of(ask_for("OPTIONS /whep", "Origin: https://bad.example\r\n")), 403);
  const std::string before = ask_for("OPTIONS /whep", "Origin: https://good.example\r\n");
  EXPECT_EQ(status_of(before), 204);
  EXPECT_EQ(header_of(before, "access-control-allow-origin"), "https://good.example");
  EXPECT_THAT(header_of(before, "access-control-allow-methods"), HasSubstr("DELETE"));
  EXPECT_THAT(header_of(before, "access-control-allow-headers"), StartsWith("content-type"));
  const std::string answer = post("Origin: https://good.example\r\n");
  EXPECT_EQ(status_of(answer), 201);
  EXPECT_EQ(header_of(answer, "access-control-expose-headers"), "location");
}

TEST_F(Whep, PlacesAreLimited) {
  serve({.max_clients = 2});
  seen_.viewers = 2;
  EXPECT_EQ(status_of(post()), 503);
  seen_.viewers = 1;
  EXPECT_EQ(status_of(post()), 201);
  EXPECT_EQ(sink_->stats().receivers, 1);
}

TEST_F(Whep, WithoutAnAnswerTheServerStillEnds) {
  serve();
  seen_.answers = false;
  Connection connection(port_);
  connection.send("POST /whep HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) +
                  "\r\nContent-Type: application/sdp\r\nContent-Length: 1\r\n\r\nx");
  while (get(port_, "/info.json").empty() || seen_.sdp.empty()) {
  }
  EXPECT_TRUE(sink_->finish());
}

TEST_F(Whep, WithoutWebRtcThereIsNone) {
  seen_.starts = false;
  serve();
  EXPECT_EQ(status_of(post()), 405);
  EXPECT_EQ(status_of(ask_for("GET /whep")), 404);
  EXPECT_THAT(get(port_, "/info.json"), ::testing::Not(HasSubstr("webrtc")));
  web::WebOptions options;
  options.must_have_peer_connections = true;
  options.make_peer_connections = [this] { return std::make_unique<Fake>(seen_); };
  auto sink = web::make_web_sink("http://127.0.0.1:0/", options);
  ASSERT_TRUE(sink);
  const auto started = (*sink)->start(show_.info);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().message, "not today");
}

}  // namespace whep_test
}  // namespace animeme::test
