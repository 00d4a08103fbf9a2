// What engines and phones send, as access units: round trips, whom a receiver hears, hostile
// packets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "fap/tables.h"
#include "tests/live/engines/engines_support.h"
#include "tools/formats/media/live/live_frames.h"
#include "tools/formats/media/live/recovery.h"
#include "tools/live/engines/detail/engine_input.h"
#include "tools/live/engines/detail/live_link.h"
#include "tools/live/engines/detail/osc.h"

namespace animeme {
namespace engine_inputs_test {

using engines::EngineInput;
using test::face_at;
using test::moving_face;
using test::MovingFace;
using test::Sent;
using test::sent_to;

media::UdpAddress machine(int number) {
  return *media::UdpAddress::resolve("127.0.0." + std::to_string(number), 5000);
}

EngineInput input_for(const std::string& url, engines::EngineSourceOptions options = {}) {
  return {*engines::parse_engine_address(url, true), options};
}

/// What came out, and the frames of it as a receiver shows them.
struct Received {
  std::deque<media::LiveEvent> events;
  std::vector<fap::Frame> frames;  ///< numbered by time
  std::optional<fap::Rate> rate;

  void decode() {
    media::LiveFrames live(media::GapRule::skip, fap::FillOptions{.complete = true});
    media::FaceRecovery recovery;
    std::uint32_t timescale = 25000;
    for (const media::LiveEvent& event : events) {
      if (const auto* info = std::get_if<media::LiveInfo>(&event)) timescale = info->timescale;
      if (auto unit = recovery.accept(event)) {
        for (fap::Frame& frame : live.push(*unit, timescale, false)) {
          frames.push_back(std::move(frame));
        }
        rate = live.rate();
      }
    }
  }
  template <class Kind>
  int count() const {
    int sum = 0;
    for (const auto& event : events) sum += std::holds_alternative<Kind>(event);
    return sum;
  }
};

/// Datagrams that arrive when they were sent, a little late each.
Received receive(EngineInput& input, const std::vector<Sent>& sent, double jitter = 0) {
  Received out;
  std::mt19937 random(1);
  double now = 100;
  for (const Sent& each : sent) {
    const double late = jitter * double(random() % 1000) / 1000;
    now = std::max(now, 100 + each.seconds + late);
    EXPECT_TRUE(input.tick(now, out.events));
    EXPECT_TRUE(input.push(each.bytes, machine(1), now, out.events));
  }
  EXPECT_TRUE(input.tick(now + 0.1, out.events));
  out.decode();
  return out;
}

// Off by half a step of the quantiser, and by one where rounding to 32 bits on the way moves a
// value across the border between two.
void expect_same(const fap::Frame& have, const fap::Frame& want) {
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const int most = fap::info(fap).quant_step / 2 + 1;
    ASSERT_NEAR(have.value[std::size_t(fap)], want.value[std::size_t(fap)], most) << fap;
  }
}

class RoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(RoundTrip, GivesTheWeightsBack) {
  const std::string scheme = GetParam();
  const MovingFace face = moving_face(60);
  const auto fit = test::fit_of(face);
  EngineInput input = input_for(scheme + "://");
  Received got = receive(input, sent_to(scheme + "://192.0.2.1", face));
  EXPECT_EQ(got.rate, (fap::Rate{25, 1}));
  ASSERT_NEAR(double(got.frames.size()), 1500, scheme == "osc" ? 3 : 0);
  EXPECT_EQ(got.count<media::LiveGap>(), 0);
  EXPECT_EQ(got.count<media::LiveInfo>(), 1);
  EXPECT_EQ(got.count<media::LiveEnd>(), scheme == "vmc" ? 1 : 0);
  int intra = 0;
  for (const auto& event : got.events) {
    const auto* unit = std::get_if<media::LiveUnit>(&event);
    intra += unit != nullptr && unit->intra;
  }
  EXPECT_GE(intra, 60);
  for (const fap::Frame& frame : got.frames) {
    const auto place = std::size_t(frame.number);
    ASSERT_LT(place, fit.size());
    expect_same(frame, fap::arkit_to_fap(fit[place], fap::kAllArkit));
  }
  const auto stats = input.stats();
  EXPECT_EQ(stats.foreign, 0);
  EXPECT_EQ(stats.sessions, 1);
}

INSTANTIATE_TEST_SUITE_P(Engines, RoundTrip, testing::Values("livelink", "vmc", "osc"),
                         [](const auto& one) { return one.param; });

TEST(EngineInputs, RatesAreFound) {
  const MovingFace face = moving_face(6);
  for (const char* scheme : {"livelink", "vmc", "osc"}) {
    for (const int rate : {15, 30, 60, 120}) {
      const std::string url = std::string(scheme) + "://192.0.2.1?rate=" + std::to_string(rate);
      EngineInput input = input_for(std::string(scheme) + "://");
      const Received got = receive(input, sent_to(url, face), 0.003);
      EXPECT_EQ(got.rate, fap::make_rate(std::uint32_t(rate))) << url;
      // Without times of the sender, frames that come at odd moments share a place now and then.
      EXPECT_NEAR(double(got.frames.size()), 6 * rate, std::string(scheme) == "osc" ? rate : 1)
          << url;
    }
  }
  EngineInput input = input_for("livelink://?rate=50");
  EXPECT_EQ(receive(input, sent_to("livelink://192.0.2.1", face)).rate, (fap::Rate{50, 1}));
}

TEST(EngineInputs, JitterAndLossesLeaveTimesOfThePhone) {
  const MovingFace face = moving_face(30);
  auto sent = sent_to("livelink://192.0.2.1?rate=60", face);
  std::mt19937 random(7);
  std::vector<Sent> some;
  for (const Sent& each : sent) {
    if (random() % 10 != 0) some.push_back(each);
  }
  for (std::size_t i = 5; i + 1 < some.size(); i += 50) std::swap(some[i].bytes, some[i + 1].bytes);
  EngineInput input = input_for("livelink://");
  const Received got = receive(input, some, 0.05);
  EXPECT_EQ(got.rate, (fap::Rate{60, 1}));
  EXPECT_EQ(got.count<media::LiveGap>(), 0);
  EXPECT_GT(input.stats().late, 20);  // those that were overtaken
  ASSERT_GT(got.frames.size(), 1780u);
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    ASSERT_EQ(got.frames[i].number,
              std::int64_t(i));  // what is missing lies between its neighbours
  }
  // Planes that came are where they were: the jaw of the phone's frame, not of the arrival.
  const auto first = engines::read_live_link(some.front().bytes);
  ASSERT_TRUE(first);
  const auto offset = std::int64_t(first->frame);
  const fap::Frame want =
      fap::arkit_to_fap(engines::read_live_link(some[200].bytes)->values, fap::kAllArkit);
  const auto place = std::size_t(engines::read_live_link(some[200].bytes)->frame - offset);
  EXPECT_NEAR(got.frames[place].value[3], want.value[3], 3);
}

TEST(EngineInputs, AClockThatStandsStillIsNotBelieved) {
  const MovingFace face = moving_face(10);
  auto sent = sent_to("livelink://192.0.2.1", face);
  for (Sent& each : sent) {
    auto packet = *engines::read_live_link(each.bytes);
    packet.frame = 17;
    packet.part = 0;
    each.bytes = engines::write_live_link(packet);
  }
  EngineInput input = input_for("livelink://?rate=25");
  const Received got = receive(input, sent);
  EXPECT_GE(got.frames.size(), 240u);
  EXPECT_GE(got.frames.back().number, 240);
}

TEST(EngineInputs, TimesThatJumpCostNothing) {
  const MovingFace face = moving_face(10);
  auto sent = sent_to("livelink://192.0.2.1", face);
  for (std::size_t i = 100; i < sent.size(); ++i) {
    auto packet = *engines::read_live_link(sent[i].bytes);
    packet.frame += i % 2 == 0 ? 1'000'000'000 : -1'000'000'000;
    sent[i].bytes = engines::write_live_link(packet);
  }
  EngineInput input = input_for("livelink://");
  const Received got = receive(input, sent);
  EXPECT_LE(got.events.size(), 260u);
  EXPECT_NEAR(double(got.frames.back().number), 249, 2);
}

TEST(EngineInputs, APauseOfThePhoneIsAGap) {
  const MovingFace face = moving_face(10);
  auto sent = sent_to("livelink://192.0.2.1", face);
  sent.erase(sent.begin() + 100, sent.begin() + 200);  // 4 s
  EngineInput input = input_for("livelink://");
  const Received got = receive(input, sent);
  EXPECT_EQ(got.count<media::LiveGap>(), 1);
  EXPECT_EQ(got.frames.size(), 150u);
  EXPECT_EQ(got.frames[99].number, 99);
  EXPECT_EQ(got.frames[100].number, 200);
  // The object begins once; each further unit is a plane behind its start code.
  bool first = true;
  for (const media::LiveEvent& event : got.events) {
    const auto* unit = std::get_if<media::LiveUnit>(&event);
    if (unit == nullptr) continue;
    ASSERT_GT(unit->bytes.size(), 4u);
    EXPECT_EQ(unit->bytes[2], 1);
    EXPECT_EQ(unit->bytes[3], first ? 0xBA : 0xBB);
    first = false;
  }
}

TEST(EngineInputs, OfTwoPhonesTheFirstIsHeard) {
  const MovingFace face = moving_face(10);
  const auto first = sent_to("livelink://192.0.2.1?subject=One", face);
  const auto second = sent_to("livelink://192.0.2.1?subject=Two", face);
  for (const bool same_machine : {false, true}) {
    EngineInput input = input_for("livelink://");
    Received got;
    for (std::size_t i = 0; i < first.size(); ++i) {
      const double now = 50 + first[i].seconds;
      // The first one stops after six seconds.
      if (i < 150) {
        EXPECT_TRUE(input.push(first[i].bytes, machine(1), now, got.events));
      }
      if (i < 10) continue;
      const int from = same_machine ? 1 : 2;
      EXPECT_TRUE(input.push(second[i].bytes, machine(from), now + 0.01, got.events));
    }
    got.decode();
    EXPECT_EQ(input.stats().sessions, 2);
    EXPECT_EQ(got.count<media::LiveRestart>(), 1);
    EXPECT_NEAR(double(input.stats().foreign), 140 + 26, 3);
    EXPECT_NEAR(double(got.frames.size()), 150 + 74, 3);
  }
  EngineInput input = input_for("livelink://?subject=Two");
  Received got;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_TRUE(input.push(first[i].bytes, machine(1), first[i].seconds, got.events));
    EXPECT_TRUE(input.push(second[i].bytes, machine(2), first[i].seconds, got.events));
  }
  EXPECT_EQ(input.stats().sessions, 1);
  EXPECT_EQ(input.stats().foreign, 250);
}

TEST(EngineInputs, AnySourceTakesOneSenderFromManyAddresses) {
  const auto sent = sent_to("vmc://192.0.2.1", moving_face(4));
  EngineInput input = input_for("vmc://", {.any_source = true});
  Received got;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_TRUE(input.push(sent[i].bytes, machine(1 + int(i % 3)), sent[i].seconds, got.events));
  }
  got.decode();
  EXPECT_EQ(input.stats().foreign, 0);
  EXPECT_EQ(got.frames.size(), 100u);
}

TEST(EngineInputs, APhoneThatSeesNobodyIsNotForeign) {
  auto sent = sent_to("livelink://192.0.2.1", moving_face(4));
  for (std::size_t i = 50; i < 60; ++i) {
    auto packet = *engines::read_live_link(sent[i].bytes);
    packet.face = false;
    sent[i].bytes = engines::write_live_link(packet);
  }
  EngineInput input = input_for("livelink://");
  const Received got = receive(input, sent);
  EXPECT_EQ(input.stats().foreign, 0);
  EXPECT_EQ(got.frames.size(), 100u);
}

TEST(EngineInputs, DamagedPacketsAreCountedAndNothingElse) {
  std::mt19937 random(3);
  for (const std::string scheme : {"livelink", "vmc", "osc"}) {
    const auto sent = sent_to(scheme + "://192.0.2.1", moving_face(2));
    EngineInput input = input_for(scheme + "://");
    std::deque<media::LiveEvent> events;
    double now = 0;
    std::int64_t packets = 0;
    for (int round = 0; round < 4000; ++round) {
      std::vector<std::uint8_t> bytes = sent[random() % sent.size()].bytes;
      bytes.resize(random() % (bytes.size() + 1));
      for (int flips = int(random() % 4); flips > 0 && !bytes.empty(); --flips) {
        bytes[random() % bytes.size()] = std::uint8_t(random());
      }
      now += 0.001;
      ++packets;
      ASSERT_TRUE(input.push(bytes, machine(1 + int(random() % 3)), now, events));
      ASSERT_TRUE(input.tick(now, events));
    }
    EXPECT_EQ(input.stats().packets, packets);
    EXPECT_GT(input.stats().foreign, scheme == "livelink" ? 1000 : 500) << scheme;
    EXPECT_LT(events.size(), 20'000u);
  }
}

// What other programs send: names in any case, presets alone, no time, messages one by one.
TEST(EngineInputs, PresetsOfVrmMoveAFace) {
  EngineInput input = input_for("vmc://?rate=30");
  Received got;
  for (int i = 0; i < 90; ++i) {
    const float open = i < 30 ? 0.0f : 1.0f;
    for (const engines::OscMessage& message : std::vector<engines::OscMessage>{
             {"/VMC/Ext/OK", {1}},
             {"/VMC/Ext/Root/Pos", {std::string("root"), 0.f, 0.f, 0.f, 0.f, 0.f, 0.f, 1.f}},
             {"/VMC/Ext/Blend/Val", {std::string("BlendShape.a"), open}},
             {"/VMC/Ext/Blend/Val", {std::string("BLINK"), open}},
             {"/VMC/Ext/Blend/Apply", {}}}) {
      auto bytes = engines::osc_bundles({&message, 1})[0];
      bytes.erase(bytes.begin(), bytes.begin() + 20);  // no bundle
      EXPECT_TRUE(input.push(bytes, machine(1), i / 30.0, got.events));
    }
  }
  got.decode();
  ASSERT_GE(got.frames.size(), 88u);
  EXPECT_EQ(got.frames.front().value[3], 0);
  EXPECT_GT(got.frames.back().value[3], 400);   // the jaw
  EXPECT_GT(got.frames.back().value[19], 800);  // a lid
  EXPECT_EQ(got.frames.back().value[19], got.frames.back().value[20]);
}

TEST(EngineInputs, CombinedParametersOfAnAvatarMoveAFace) {
  EngineInput input = input_for("osc://?rate=30");
  Received got;
  for (int i = 0; i < 60; ++i) {
    const std::vector<engines::OscMessage> messages{
        {"/avatar/parameters/FT/v2/JawX", {-0.5f}},  // to the left
        {"/avatar/parameters/FT/v2/JawOpen", {0.4f}},
        {"/avatar/parameters/FT/v2/SmileFrownLeft", {0.6f}},
        {"/avatar/parameters/FT/v2/EyeLidLeft", {0.0f}},
        {"/avatar/parameters/VelocityZ", {3.0f}},
        {"/tracking/eye/LeftRightPitchYaw", {10.f, 20.f, 10.f, 20.f}}};
    for (const auto& bytes : engines::osc_bundles(messages)) {
      EXPECT_TRUE(input.push(bytes, machine(1), i / 30.0, got.events));
    }
    EXPECT_TRUE(input.tick(i / 30.0 + 0.01, got.events));
  }
  got.decode();
  ASSERT_GE(got.frames.size(), 58u);
  fap::ArkitFrame want{};
  fap::ArkitChannels channels;
  const auto set = [&](const char* name, double value) {
    const auto channel = std::size_t(*fap::find_arkit(name));
    want[channel] = value;
    channels.set(channel);
  };
  set("jawLeft", 0.5);
  set("jawOpen", 0.4);
  set("mouthSmileLeft", 0.6);
  set("eyeBlinkLeft", 1);
  for (const char* eye : {"left", "right"}) {
    set((std::string(eye) + "EyePitch").c_str(), 10 * std::numbers::pi / 180);
    set((std::string(eye) + "EyeYaw").c_str(), 20 * std::numbers::pi / 180);
  }
  expect_same(got.frames.back(), fap::arkit_to_fap(want, channels));
}

}  // namespace engine_inputs_test
}  // namespace animeme
