// What goes into data channels: those that lose nothing need no intra planes from time to time.
#include "tools/live/webrtc/detail/feed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>

#include "codec/decode/decoder.h"
#include "codec/encode/live.h"
#include "tests/support/random_clip.h"
#include "tools/live/web/detail/messages.h"

namespace animeme::test {
namespace feed_test {

using Bytes = std::vector<std::uint8_t>;

class FakePeer : public webrtc::Peer {
 public:
  explicit FakePeer(bool reliable) : reliable_(reliable) {}
  void answered(const std::string&) override {}
  State state() override { return State::connected; }
  std::string problem() override { return {}; }
  bool has_channel(const std::string& label) override { return label == webrtc::kFace; }
  bool is_reliable(const std::string&) override { return reliable_; }
  bool send(const std::string&, std::span<const std::uint8_t> message, bool) override {
    if (full) return false;
    messages.emplace_back(message.begin(), message.end());
    return true;
  }
  void send_sound(std::span<const std::uint8_t> packet, std::uint32_t, bool redundant) override {
    sounds.push_back({{packet.begin(), packet.end()}, redundant});
  }
  double reported_loss() override { return loss; }
  void goodbye() override {}

  bool full = false;
  std::vector<Bytes> messages;
  struct Sound {
    Bytes bytes;
    bool redundant = false;
  };
  std::vector<Sound> sounds;
  double loss = 0;

 private:
  bool reliable_;
};

std::uint32_t number_at(const Bytes& bytes, std::size_t at, int size) {
  std::uint32_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | bytes.at(at + std::size_t(i));
  return value;
}

// The only unit of a message.
struct Single {
  std::uint32_t number = 0;
  bool hello = false;
  web::UnitMessage unit;
};

Single single(const Bytes& message) {
  Single one;
  EXPECT_EQ(message.at(0), 'B');
  EXPECT_EQ(message.at(6), 1) << "units";
  one.number = number_at(message, 2, 4);
  const std::size_t hello = number_at(message, 7, 2);
  one.hello = hello > 0;
  const std::size_t at = 9 + hello;
  EXPECT_EQ(message.size(), at + 2 + number_at(message, at, 2));
  auto unit = web::read_unit(std::span(message).subspan(at + 2));
  EXPECT_TRUE(unit);
  if (unit) one.unit = *unit;
  return one;
}

// A face of 20 FAPs with an intra plane each second.
class FeedTest : public testing::Test {
 protected:
  void SetUp() override {
    media::LiveInfo info;
    info.timescale = 25000;
    info.face_config = {1, 2, 3};
    auto feed = webrtc::Feed::make(info, {.repeat = 5});
    ASSERT_TRUE(feed);
    feed_.emplace(std::move(*feed));
  }

  FakePeer& join(webrtc::Receiver& receiver, bool reliable) {
    receiver.peer = std::make_unique<FakePeer>(reliable);
    return static_cast<FakePeer&>(*receiver.peer);
  }

  void push() {
    const int i = int(values_.size());
    fap::Frame frame;
    for (int fap = 3; fap < 23; ++fap) {
      frame.set(fap, int(100 * std::sin(0.2 * i + fap)) + random_.range(-3, 3));
    }
    auto bytes = encoder_.write(frame);
    ASSERT_TRUE(bytes);
    values_.push_back(encoder_.reconstruction().value);
    media::LiveUnit unit;
    unit.track = media::LiveTrack::face;
    unit.time = std::int64_t(i) * 1000;
    unit.duration = 1000;
    unit.intra = encoder_.intra();
    unit.bytes = *bytes;
    feed_->push(unit, {});
  }

  // The values of all messages from one on.
  void expect_values(const FakePeer& peer, std::size_t from) {
    Bytes stream;
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = from; i < peer.messages.size(); ++i) {
      const Single one = single(peer.messages[i]);
      EXPECT_EQ(one.unit.time, (std::uint64_t(one.number) + 25) * 1000);
      stream.insert(stream.end(), one.unit.bytes.begin(), one.unit.bytes.end());
      numbers.push_back(one.number);
    }
    const auto decoded = fba::decode(stream);
    ASSERT_TRUE(decoded) << decoded.error().describe();
    ASSERT_EQ(decoded->planes.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      EXPECT_EQ(decoded->planes[i].face.value, values_[numbers[i]]) << numbers[i];
    }
  }

  std::optional<webrtc::Feed> feed_;
  fba::LiveEncoder encoder_{{.intra_seconds = 1}};
  Random random_{5};
  std::vector<std::array<std::int32_t, fap::kFapCount + 1>> values_;
};

TEST_F(FeedTest, ReliableChannelsHaveAnEncoderOfTheirOwn) {
  webrtc::Receiver lossy, reliable;
  const FakePeer& first = join(lossy, false);
  const FakePeer& second = join(reliable, true);
  for (int i = 0; i < 260; ++i) {
    push();
    feed_->give(lossy);
    if (i >= 10) feed_->give(reliable);
  }
  ASSERT_EQ(second.messages.size(), 250u);
  std::size_t bytes = 0, source = 0, intra_planes = 0;
  for (std::size_t i = 0; i < second.messages.size(); ++i) {
    const Single one = single(second.messages[i]);
    EXPECT_EQ(one.number, i + 10);
    const bool intra = (one.unit.flags & web::kIntra) != 0;
    EXPECT_TRUE(intra || i > 0);
    EXPECT_EQ(one.hello, intra);
    intra_planes += intra ? 1 : 0;
    bytes += second.messages[i].size();
  }
  for (const Bytes& message : first.messages) source += message.size();
  expect_values(second, 0);
  std::printf("kbit/s: %.1f where messages get lost, %.1f where they do not\n",
              double(source) * 8 / 260 * 25 / 1000, double(bytes) * 8 / 250 * 25 / 1000);
  EXPECT_LT(bytes, source / 2);
  EXPECT_LE(intra_planes, 3u) << "the first, and where values do not fit the ranges; not 11";
}

TEST_F(FeedTest, WhereTooMuchWaitsAReliableChannelBeginsAnew) {
  webrtc::Receiver reliable, other;
  FakePeer& peer = join(reliable, true);
  const FakePeer& later = join(other, true);
  for (int i = 0; i < 60; ++i) {
    push();
    peer.full = i >= 20 && i < 30;
    feed_->give(reliable);
    if (i >= 40) feed_->give(other);
    if (i == 50) feed_->forget(other);
  }
  ASSERT_EQ(peer.messages.size(), 50u);
  const Single again = single(peer.messages[20]);
  EXPECT_EQ(again.number, 30u);
  EXPECT_TRUE(again.hello);
  EXPECT_TRUE(again.unit.flags & web::kIntra);
  expect_values(peer, 20);
  EXPECT_TRUE(single(later.messages[0]).unit.flags & web::kIntra);
  EXPECT_TRUE(single(later.messages[11]).unit.flags & web::kIntra) << "it was forgotten";
}

// Packets of sound for one receiver that knows RFC 2198 and one that does not.
TEST(FeedSound, GoesAgainWhereItIsLost) {
  media::LiveInfo info;
  info.timescale = 25000;
  info.face_config = {1, 2, 3};
  info.audio = media::AudioFormat{media::AudioCodec::opus, 48000, 1, 960, 312, {}};
  for (const int repeat : {-1, 0, 1}) {
    auto feed = webrtc::Feed::make(info, {.audio_repeat = repeat});
    ASSERT_TRUE(feed);
    webrtc::Receiver knows, other;
    knows.types = {111, 63, true};
    other.types = {96, -1, true};
    knows.peer = std::make_unique<FakePeer>(false);
    other.peer = std::make_unique<FakePeer>(false);
    auto& first = static_cast<FakePeer&>(*knows.peer);
    auto& second = static_cast<FakePeer&>(*other.peer);
    for (int i = 0; i < 40; ++i) {
      first.loss = second.loss = i < 20 ? 0 : 0.1;
      media::LiveUnit unit;
      unit.track = media::LiveTrack::audio;
      unit.time = std::int64_t(i) * 960;
      unit.duration = 960;
      unit.bytes = Bytes(100, std::uint8_t(i));
      feed->push(unit, {});
      feed->give(knows);
      feed->give(other);
    }
    ASSERT_EQ(first.sounds.size(), 40u);
    for (std::size_t i = 1; i < 40; ++i) {
      const int wanted = repeat >= 0 ? repeat : i < 20 ? 0 : 2;
      EXPECT_EQ(first.sounds[i].redundant, wanted > 0) << i;
      EXPECT_EQ(first.sounds[i].bytes.size(),
                wanted == 0 ? 100u : 1 + 100 + std::size_t(wanted) * 104);
      EXPECT_EQ(second.sounds[i].bytes, Bytes(100, std::uint8_t(i)));
      EXPECT_FALSE(second.sounds[i].redundant);
    }
    // FEC is for those to whom nothing else helps, and who say that they decode it.
    EXPECT_EQ(feed->needs_fec(knows), repeat == 0 ? 0.1 : 0);
    EXPECT_EQ(feed->needs_fec(other), 0.1);
    other.types.fec = false;
    EXPECT_EQ(feed->needs_fec(other), 0);
  }
}

}  // namespace feed_test
}  // namespace animeme::test
