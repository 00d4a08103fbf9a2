// The two ways to have /faps small: ?binary, and permessage-deflate of its text (RFC 7692).
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "tests/live/web/http.h"
#include "tests/support/live_loop.h"
#include "tools/live/web/web.h"

namespace animeme::test {
namespace small_test {

using ::testing::HasSubstr;

struct Frame {
  bool text = false, deflated = false;
  std::string bytes;
};

/// Messages of a server, each in one frame of a WebSocket (RFC 6455, section 5.2); up to the
/// goodbye.
std::vector<Frame> frames_of(const std::string& bytes) {
  std::vector<Frame> frames;
  const auto at = [&](std::size_t i) { return std::uint8_t(bytes.at(i)); };
  for (std::size_t i = 0; i + 2 <= bytes.size();) {
    const int first = at(i), opcode = first & 15;
    std::size_t size = at(i + 1), begin = i + 2;
    EXPECT_TRUE((first & 0x80) != 0 && size < 128) << "whole, not masked";
    if (size == 126) {
      size = std::size_t(at(i + 2)) << 8 | at(i + 3);
      begin = i + 4;
    }
    if (opcode == 8) break;
    frames.push_back({opcode == 1, (first & 0x40) != 0, bytes.substr(begin, size)});
    i = begin + size;
  }
  return frames;
}

/// What a client has that keeps its window from message to message.
class Inflater {
 public:
  Inflater() { EXPECT_EQ(inflateInit2(&stream_, -15), Z_OK); }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  std::string read(std::string bytes) {
    bytes += std::string("\0\0\xFF\xFF", 4);
    std::string out(1 << 16, 0);
    stream_.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_in = uInt(bytes.size());
    stream_.next_out = reinterpret_cast<Bytef*>(out.data());
    stream_.avail_out = uInt(out.size());
    EXPECT_GE(inflate(&stream_, Z_SYNC_FLUSH), Z_OK);
    EXPECT_EQ(stream_.avail_in, 0u);
    out.resize(out.size() - stream_.avail_out);
    return out;
  }

 private:
  z_stream stream_{};
};

constexpr const char* kDeflate =
    "Sec-WebSocket-Extensions: permessage-deflate; client_max_window_bits\r\n";

class Small : public ::testing::Test {
 protected:
  void SetUp() override {
    add_sound(show_, aac_format());
    auto sink = web::make_web_sink("http://127.0.0.1:0/");
    ASSERT_TRUE(sink);
    ASSERT_TRUE((*sink)->start(show_.info));
    sink_ = std::move(*sink);
    port_ = port_of(sink_->address());
  }
  /// Answers to the upgrade.
  std::string open(const std::string& path, const std::string& headers = "") {
    sockets_.push_back(std::make_unique<Connection>(port_));
    sockets_.back()->send(upgrade(port_, path, headers));
    return sockets_.back()->read(
        [](const std::string& text) { return text.find("\r\n\r\n") != text.npos; });
  }
  /// Sends all and says goodbye.
  void send_all() {
    for (const media::LiveUnit& unit : show_.units) ASSERT_TRUE(sink_->send(unit));
    std::thread end([this] { EXPECT_TRUE(sink_->finish()); });
    for (auto& socket : sockets_) received_.push_back(socket->read_all(5));
    end.join();
  }

  Presentation show_ = live_presentation(200, 25);
  std::unique_ptr<web::WebSink> sink_;
  int port_ = 0;
  std::vector<std::unique_ptr<Connection>> sockets_;
  std::vector<std::string> received_;
};

TEST_F(Small, OneTextInThreeForms) {
  std::vector<std::string> heads{open("/faps"), open("/faps", kDeflate), open("/faps?binary"),
                                 open("/faps?binary=0")};
  EXPECT_EQ(header_of(heads[0], "Sec-WebSocket-Extensions"), "");
  EXPECT_THAT(header_of(heads[1], "Sec-WebSocket-Extensions"), HasSubstr("permessage-deflate"));
  send_all();
  std::vector<std::vector<Frame>> frames;
  for (std::size_t i = 0; i < heads.size(); ++i) {
    frames.push_back(frames_of(body_of(heads[i]) + received_[i]));
    ASSERT_EQ(frames[i].size(), 201u) << i;
  }
  Inflater inflater;
  for (std::size_t k = 0; k < frames[0].size(); ++k) {
    const Frame &text = frames[0][k], &deflated = frames[1][k], &small = frames[2][k];
    ASSERT_TRUE(text.text && !text.deflated);
    ASSERT_TRUE(deflated.text && deflated.deflated);
    ASSERT_EQ(inflater.read(deflated.bytes), text.bytes) << k;
    ASSERT_EQ(small.text, k == 0) << "the first tells what there is";
    ASSERT_FALSE(small.deflated);
    ASSERT_EQ(frames[3][k].bytes, text.bytes);
  }
  EXPECT_EQ(frames[2][0].bytes, frames[0][0].bytes);
  EXPECT_EQ(nlohmann::json::parse(frames[0][0].bytes)["timescale"], 25000);
  std::vector<std::size_t> sizes;
  for (const auto& each : frames) {
    std::size_t sum = 0;
    for (std::size_t k = 1; k < each.size(); ++k) sum += each[k].bytes.size();
    sizes.push_back(sum);
  }
  EXPECT_LT(sizes[1], sizes[0] / 2);
  EXPECT_LT(sizes[2], sizes[0] / 3);
}

// What is small already takes no memory for it; and libwebsockets does not keep to what a client
// asks of the window of the server.
TEST_F(Small, OnlyTextIsDeflated) {
  const auto deflates = [&](const std::string& path, const std::string& offer) {
    const std::string head =
        open(path, "Sec-WebSocket-Extensions: permessage-deflate" + offer + "\r\n");
    EXPECT_EQ(status_of(head), 101) << path;
    return !header_of(head, "Sec-WebSocket-Extensions").empty();
  };
  EXPECT_TRUE(deflates("/faps", ""));
  for (const char* path : {"/face", "/audio", "/faps?binary"}) EXPECT_FALSE(deflates(path, ""));
  for (const char* offer : {"; server_no_context_takeover", "; server_max_window_bits=9"}) {
    EXPECT_FALSE(deflates("/faps", offer)) << offer;
  }
  open("/faps", "Sec-WebSocket-Extensions: x-unknown, permessage-deflate; nonsense=1\r\n");
  open("/faps", "Sec-WebSocket-Extensions: " + std::string(2000, 'x') + "\r\n");
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200);
}

// Clients have nothing to say; what they deflate is inflated by libwebsockets.
TEST_F(Small, DeflatedNonsenseEndsItsConnectionOnly) {
  open("/faps", kDeflate);
  sockets_.back()->send(std::string("\xC2\x85\0\0\0\0\xFF\xFF\xFF\xFF\xFF", 11));
  open("/faps", kDeflate);
  std::string bomb(100000, 0);  // of zeros, packed: 80 MB
  z_stream stream{};
  ASSERT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, -15, 9, Z_DEFAULT_STRATEGY), Z_OK);
  const std::string zeros(1 << 20, 0);
  stream.next_out = reinterpret_cast<Bytef*>(bomb.data());
  stream.avail_out = uInt(bomb.size());
  for (int i = 0; i < 80; ++i) {
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zeros.data()));
    stream.avail_in = uInt(zeros.size());
    deflate(&stream, i == 79 ? Z_SYNC_FLUSH : Z_NO_FLUSH);
  }
  bomb.resize(bomb.size() - stream.avail_out - 4);
  deflateEnd(&stream);
  const std::size_t size = bomb.size();
  ASSERT_GT(size, 65535u);
  std::string head("\xC2\xFF\0\0\0\0\0\0\0\0\0\0\0\0", 14);
  for (int i = 0; i < 8; ++i) head[std::size_t(2 + i)] = char(size >> 8 * (7 - i) & 255);
  sockets_.back()->send(head + bomb);
  sockets_.back()->read_all(2);
  EXPECT_TRUE(sockets_.back()->closed()) << "more than 64 kB from a client";
  EXPECT_EQ(status_of(get(port_, "/info.json")), 200);
}

}  // namespace small_test
}  // namespace animeme::test
