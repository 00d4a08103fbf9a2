// The server as browsers and strangers see it.
#include "tests/live/web/http.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "tests/support/live_loop.h"
#include "tools/formats/media/audio.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace http_test {

using ::testing::HasSubstr;
using ::testing::Not;

class Http : public ::testing::Test {
 protected:
  void serve(const web::WebOptions& options = {}, bool sound = true) {
    show_ = live_presentation(60, 20);
    if (sound) add_sound(show_, aac_format());
    auto sink = web::make_web_sink("http://127.0.0.1:0/", options);
    ASSERT_TRUE(sink);
    ASSERT_TRUE((*sink)->start(show_.info));
    sink_ = std::move(*sink);
    port_ = port_of(sink_->address());
  }
  void send_all() {
    for (const media::LiveUnit& unit : show_.units) ASSERT_TRUE(sink_->send(unit));
  }
  void expect_alive() { EXPECT_EQ(status_of(get(port_, "/info.json")), 200); }

  Presentation show_;
  std::unique_ptr<web::WebSink> sink_;
  int port_ = 0;
};

TEST_F(Http, ThePageIsSelfContained) {
  serve();
  const std::string page = get(port_, "/");
  EXPECT_EQ(status_of(page), 200);
  EXPECT_THAT(page, HasSubstr("text/html; charset=utf-8"));
  EXPECT_THAT(page, HasSubstr("x-content-type-options: nosniff"));
  EXPECT_THAT(page, HasSubstr("content-security-policy: default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("access-control-allow-origin")));
  const std::string body = body_of(page);
  EXPECT_THAT(body, HasSubstr("</html>")) << "whole";
  for (const char* path : {"/", "/live.css", "/live.js"}) {
    const std::string part = get(port_, path);
    EXPECT_EQ(status_of(part), 200) << path;
    EXPECT_THAT(body_of(part), Not(HasSubstr("https://"))) << path;
    EXPECT_THAT(body_of(part), Not(HasSubstr("src=\"http"))) << path;
  }
}

TEST_F(Http, InfoIsJson) {
  serve();
  send_all();
  const std::string response = get(port_, "/info.json");
  EXPECT_THAT(response, HasSubstr("application/json"));
  const auto info = nlohmann::json::parse(body_of(response));
  EXPECT_EQ(info["version"], 1);
  EXPECT_EQ(info["time_zero"], 1);
  EXPECT_EQ(info["face"]["timescale"], 25000);
  EXPECT_EQ(info["face"]["config"], "000001b061000001b58947");
  EXPECT_EQ(info["audio"]["mime"], "audio/mp4; codecs=\"mp4a.40.2\"");
  EXPECT_EQ(info["audio"]["sample_rate"], 48000);
}

TEST_F(Http, AHeadIsServedIfThereIsOne) {
  serve();
  EXPECT_EQ(status_of(get(port_, "/head.bin")), 404);
  EXPECT_THAT(body_of(get(port_, "/")), Not(HasSubstr("type=\"module\"")));
  sink_.reset();
  serve({.head_script = "class HeadView {}\n", .head_model = {1, 2, 3}});
  EXPECT_EQ(body_of(get(port_, "/head.bin")), std::string("\x01\x02\x03"));
  EXPECT_THAT(body_of(get(port_, "/")), HasSubstr("<script type=\"module\" src=\"head.js\">"));
  EXPECT_THAT(body_of(get(port_, "/head.js")), ::testing::StartsWith("class HeadView"));
  EXPECT_FALSE(web::make_web_sink("http://127.0.0.1:0/", {.head_script = "x"}));
}

TEST_F(Http, SeveralHeadsHaveNames) {
  serve({.head_script = "x", .head_model = {1}});
  EXPECT_FALSE(nlohmann::json::parse(body_of(get(port_, "/info.json"))).contains("heads"));
  EXPECT_EQ(status_of(get(port_, "/heads/1.bin")), 404);
  sink_.reset();
  const std::vector<web::WebHead> others{{"<b>\xFF", {2}}, {"child", {3, 4}}};
  serve({.head_script = "x", .head_model = {1}, .head_name = "me", .other_heads = others});
  const auto heads = nlohmann::json::parse(body_of(get(port_, "/info.json")))["heads"];
  EXPECT_EQ(heads, nlohmann::json({"me", "<b>\uFFFD", "child"}));
  EXPECT_EQ(body_of(get(port_, "/head.bin")), "\x01");
  EXPECT_EQ(body_of(get(port_, "/heads/1.bin")), "\x02");
  EXPECT_EQ(body_of(get(port_, "/heads/2.bin")), "\x03\x04");
  for (const char* path : {"/heads/0.bin", "/heads/3.bin", "/heads/", "/heads/1"}) {
    EXPECT_EQ(status_of(get(port_, path)), 404) << path;
  }
  EXPECT_FALSE(web::make_web_sink("http://127.0.0.1:0/", {.other_heads = others}));
  EXPECT_FALSE(
      web::make_web_sink("http://127.0.0.1:0/",
                         {.head_script = "x", .head_model = {1}, .other_heads = {{"none", {}}}}));
}

// Who may use the server may have its page in a frame; nobody else.
TEST_F(Http, FramesAreForThoseWhoMay) {
  const auto frames = [&] {
    const std::string policy = header_of(get(port_, "/"), "content-security-policy");
    return policy.substr(policy.find("frame-ancestors"));
  };
  serve();
  EXPECT_EQ(frames(), "frame-ancestors 'self'");
  sink_.reset();
  std::vector<std::string> origins;
  for (int i = 0; i < 200; ++i) origins.push_back("https://" + std::to_string(i) + ".example");
  serve({.allow_origins = origins});
  EXPECT_THAT(frames(), HasSubstr("'self' https://0.example https://1.example"));
  EXPECT_THAT(frames(), HasSubstr("https://199.example"));
  EXPECT_EQ(status_of(get(port_, "/nothing")), 404);
  sink_.reset();
  serve({.allow_origins = {"*"}});
  EXPECT_EQ(frames(), "frame-ancestors 'self' *");
}

TEST_F(Http, OnlyWhatIsListedExists) {
  serve();
  for (const char* path : {"/favicon.ico", "/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd",
                           "//etc/passwd", "/style.css", "/info.json/", "/face%00", "/Face", "*"}) {
    const int status = status_of(get(port_, path));
    EXPECT_TRUE(status == 404 || status == 403 || status == 400 || status == 0)
        << path << " " << status;
  }
  for (const char* path : {"/face", "/faps", "/audio"}) EXPECT_EQ(status_of(get(port_, path)), 426);
  expect_alive();
}

TEST_F(Http, WithoutSoundThereIsNone) {
  serve({}, false);
  EXPECT_EQ(status_of(get(port_, "/talk.mp4")), 404);
  Connection socket(port_);
  socket.send(upgrade(port_, "/audio"));
  EXPECT_EQ(status_of(socket.read_all(2)), 404);
  EXPECT_FALSE(nlohmann::json::parse(body_of(get(port_, "/info.json"))).contains("audio"));
}

TEST_F(Http, OnlyGetIsServed) {
  serve();
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "CONNECT", "BREW"}) {
    Connection connection(port_);
    connection.send(
        std::string(method) +
        " / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\nConnection: close\r\n\r\nhello");
    const std::string response = connection.read_all(2);
    EXPECT_THAT(response, Not(HasSubstr("</html>\n"))) << method;
    EXPECT_NE(status_of(response), 200) << method;
  }
  expect_alive();
}

TEST_F(Http, OriginsArePutInTheirPlace) {
  serve();
  const std::string own = "Origin: http://127.0.0.1:" + std::to_string(port_) + "\r\n";
  const auto opened = [&](const std::string& headers) {
    return status_of_socket(port_, "/face", headers);
  };
  EXPECT_EQ(opened(""), 101);
  EXPECT_EQ(opened(own), 101);
  EXPECT_EQ(opened("Origin: http://evil.example\r\n"), 403);
  EXPECT_EQ(opened("Origin: null\r\n"), 403);
  sink_.reset();
  serve({.allow_origins = {"https://good.example", "http://other.example:8000"}});
  for (const std::string good : {"https://good.example", "http://other.example:8000"}) {
    EXPECT_EQ(opened("Origin: " + good + "\r\n"), 101);
    const std::string info = get(port_, "/info.json", "Origin: " + good + "\r\n");
    EXPECT_EQ(header_of(info, "access-control-allow-origin"), good);
  }
  EXPECT_EQ(opened("Origin: http://evil.example\r\n"), 403);
  const std::string evil = get(port_, "/info.json", "Origin: http://evil.example\r\n");
  EXPECT_EQ(header_of(evil, "access-control-allow-origin"), "");
  EXPECT_EQ(header_of(evil, "cross-origin-resource-policy"), "same-origin");
  sink_.reset();
  serve({.allow_origins = {"*"}});
  EXPECT_EQ(opened("Origin: http://evil.example\r\n"), 101);
  const std::string all = get(port_, "/info.json", "Origin: http://evil.example\r\n");
  EXPECT_EQ(header_of(all, "access-control-allow-origin"), "*");
}

// A page has two sockets and is one viewer.
TEST_F(Http, ViewersAreCounted) {
  serve({.max_clients = 2});
  std::vector<std::unique_ptr<Connection>> sockets;
  const auto open = [&](const std::string& path) {
    sockets.push_back(std::make_unique<Connection>(port_));
    sockets.back()->send(upgrade(port_, path));
    return status_of(
        sockets.back()->read([](const std::string& text) { return text.size() > 12; }, 5));
  };
  EXPECT_EQ(open("/faps"), 101);
  EXPECT_EQ(open("/audio"), 101);
  EXPECT_EQ(sink_->stats().receivers, 1);
  EXPECT_EQ(open("/face"), 101);
  EXPECT_EQ(open("/audio"), 101);
  EXPECT_EQ(sink_->stats().receivers, 2);
  EXPECT_EQ(open("/faps"), 503);
  EXPECT_EQ(open("/audio"), 503);
  EXPECT_EQ(status_of(get(port_, "/talk.mp4")), 503);
  EXPECT_EQ(sink_->stats().receivers, 2);
  sockets.clear();
  for (int i = 0; i < 500 && sink_->stats().receivers > 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(sink_->stats().receivers, 0) << "places become free";
  expect_alive();
}

TEST_F(Http, NonsenseIsSurvived) {
  serve();
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    Connection connection(port_);
    std::string bytes(1 + random() % 3000, ' ');
    for (char& c : bytes) c = char(random());
    if (i % 3 == 1) bytes = "GET / HTTP/1.1\r\n" + bytes;
    if (i % 3 == 2) bytes = "GET /" + std::string(random() % 9000, 'a') + " HTTP/1.1\r\n\r\n";
    connection.send(bytes + "\r\n\r\n");
    connection.read_all(0.01);
  }
  expect_alive();
  Connection flood(port_);
  flood.send("GET / HTTP/1.1\r\n");
  for (int i = 0; i < 500; ++i)
    flood.send("X-Header-" + std::to_string(i) + ": " + std::string(200, 'x') + "\r\n");
  flood.read_all(1);
  expect_alive();
}

TEST_F(Http, BrokenFramesEndTheirConnectionOnly) {
  serve();
  const std::vector<std::string> frames = {
      std::string("\x82\x05hello", 7),                              // not masked
      std::string("\xF3\x80\0\0\0\0", 6),                           // reserved bits
      std::string("\x82\xFF\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF", 10),  // a huge one
      std::string("\x89\xFE\x01\x00", 4) + std::string(300, 'p'),   // a long ping
      std::string("\x88\x80\0\0\0\0", 6),                           // goodbye
      std::string("\x80\x85\0\0\0\0hello", 11)};                    // goes on with nothing
  std::mt19937 random(4);
  for (int i = 0; i < 40; ++i) {
    Connection socket(port_);
    socket.send(upgrade(port_, i % 2 == 0 ? "/face" : "/faps"));
    socket.read([](const std::string& text) { return text.find("\r\n\r\n") != text.npos; }, 2);
    std::string bytes = frames[std::size_t(i) % frames.size()];
    if (i >= 20) {
      for (int k = 0; k < 400; ++k) bytes.push_back(char(random()));
    }
    socket.send(bytes);
    socket.read_all(0.01);
  }
  send_all();
  expect_alive();
  auto source = web::make_web_source(sink_->address());
  ASSERT_TRUE(source);
  Received got;
  while (got.units.empty() && receive(**source, got, 5)) {
  }
  EXPECT_FALSE(got.units.empty());
}

TEST_F(Http, WhoTakesNothingIsDisconnected) {
  serve({.client_bytes = 4096, .stall_seconds = 0.2}, false);
  Connection lazy(port_, 2048);
  lazy.send(upgrade(port_, "/face"));
  lazy.read([](const std::string& text) { return text.find("\r\n\r\n") != text.npos; }, 2);
  media::LiveUnit unit = show_.units[0];
  unit.bytes.resize(100000, 0x55);
  for (int i = 0; i < 400 && sink_->stats().receivers > 0; ++i) {
    unit.time += 1000;
    ASSERT_TRUE(sink_->send(unit));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  EXPECT_EQ(sink_->stats().receivers, 0);
  EXPECT_GT(sink_->stats().dropped, 0);
  expect_alive();
}

// A player that knows nothing of WebSockets: the sound from the moment it joined, at time 0.
TEST_F(Http, TheTalkIsAnMp4) {
  media::Pcm tone{16000, std::vector<float>(48000)};
  for (std::size_t i = 0; i < tone.samples.size(); ++i) {
    tone.samples[i] = 0.5f * float(std::sin(2 * 3.14159265 * 440 * double(i) / 16000));
  }
  for (const auto codec : {media::AudioCodec::aac, media::AudioCodec::opus}) {
    const auto sound = media::encode_audio(tone, {.codec = codec});
    ASSERT_TRUE(sound) << sound.error().describe();
    auto sink = web::make_web_sink("http://127.0.0.1:0/");
    ASSERT_TRUE((*sink)->start({.audio = sound->format}));
    const int port = port_of((*sink)->address());
    const auto send = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto& packet = sound->packets[i];
        ASSERT_TRUE((*sink)->send(
            {media::LiveTrack::audio, packet.bytes, false, packet.time, packet.duration}));
      }
    };
    const std::size_t middle = sound->packets.size() / 2;
    send(0, middle);
    Connection player(port);
    player.send("GET /talk.mp4 HTTP/1.1\r\nHost: localhost\r\n\r\n");
    std::string response = player.read([](const std::string& text) { return text.size() > 900; });
    EXPECT_THAT(response, HasSubstr("audio/mp4"));
    send(middle, sound->packets.size());
    ASSERT_TRUE((*sink)->finish());
    response += player.read_all();
    const std::string file = body_of(response);
    ASSERT_EQ(file.substr(4, 8), "ftypiso5");
    const auto heard = media::read_audio(
        std::span(reinterpret_cast<const std::uint8_t*>(file.data()), file.size()));
    ASSERT_TRUE(heard) << heard.error().describe();
    EXPECT_GT(heard->duration(), 1.4);
    EXPECT_LT(heard->duration(), 3.2);
    double energy = 0;
    for (const float value : heard->samples) energy += double(value) * double(value);
    EXPECT_NEAR(std::sqrt(energy / double(heard->samples.size())), 0.35, 0.06);
  }
}

}  // namespace http_test
}  // namespace animeme::test
