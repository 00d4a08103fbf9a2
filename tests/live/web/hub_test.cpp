// What waits for whom, without sockets.
#include "tools/live/web/detail/hub.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "codec/decode/decoder.h"
#include "codec/encode/live.h"
#include "tests/support/random_clip.h"
#include "tools/live/web/detail/messages.h"

namespace animeme::test {
namespace hub_test {

using web::Channel;
using web::Hub;
using web::Message;

Message text(int number, bool entry) {
  const std::string json = "{\"time\":" + std::to_string(number) + "}";
  return {
      .bytes = {json.begin(), json.end()}, .text = true, .entry = entry, .time = double(number)};
}

std::string take(Hub& hub, web::ClientId client) {
  const auto message = hub.next(client);
  return message ? std::string(message->bytes.begin(), message->bytes.end()) : "";
}

TEST(Hub, NewcomersGetTheNewestIntraPlane) {
  Hub hub(1000, true);
  hub.set_hello(Channel::faps, {.bytes = {'h'}});
  for (int i = 0; i < 7; ++i) hub.publish(Channel::faps, text(i, i % 3 == 0));
  const auto client = hub.add(Channel::faps);
  EXPECT_EQ(take(hub, client), "h");
  EXPECT_EQ(take(hub, client), "{\"time\":6}");
  EXPECT_EQ(take(hub, client), "");
  hub.publish(Channel::faps, text(7, false));
  EXPECT_EQ(take(hub, client), "{\"time\":7}");
  hub.publish(Channel::face, text(8, true));
  EXPECT_EQ(take(hub, client), "") << "another channel";
}

TEST(Hub, OthersWaitForTheNextOne) {
  Hub hub(1000, false);
  hub.publish(Channel::faps, text(0, true));
  const auto client = hub.add(Channel::faps);
  hub.publish(Channel::faps, text(1, false));
  EXPECT_FALSE(hub.waiting(client));
  hub.publish(Channel::faps, text(2, true));
  EXPECT_EQ(take(hub, client), "{\"time\":2}");
  EXPECT_EQ(hub.dropped(), 0);
}

TEST(Hub, TheSlowLoseAllUpToTheNextIntraPlaneAndAreTold) {
  Hub hub(40, true);
  const auto slow = hub.add(Channel::faps);
  for (int i = 0; i < 6; ++i) hub.publish(Channel::faps, text(i, i == 0));
  EXPECT_EQ(hub.dropped(), 6) << "three that waited, and three more";
  EXPECT_FALSE(hub.waiting(slow));
  hub.publish(Channel::faps, text(6, true));
  const auto message = nlohmann::json::parse(take(hub, slow));
  EXPECT_EQ(message["missed"], true);
  EXPECT_EQ(message["time"], 6);
  hub.publish(Channel::faps, text(7, false));
  EXPECT_EQ(take(hub, slow), "{\"time\":7}") << "told once";
}

TEST(Hub, TheFaceHasAFlagForIt) {
  Hub hub(40, true);
  const auto slow = hub.add(Channel::face);
  const auto unit = [](bool intra) {
    return Message{.bytes = web::write_unit({1, 1, std::uint8_t(intra ? web::kIntra : 0), {0, 0}}),
                   .entry = intra};
  };
  for (int i = 0; i < 4; ++i) hub.publish(Channel::face, unit(i == 0));
  hub.publish(Channel::face, unit(true));
  EXPECT_EQ(web::read_unit(hub.next(slow)->bytes)->flags, web::kIntra | web::kMissed);
}

// Messages of a face with an intra plane every six units.
std::vector<Message> face_units(int count) {
  fap::Sequence clip = random_clip(11, count);
  fba::LiveOptions options;
  options.rate = {25, 1};
  options.intra_seconds = 6 / 25.0;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    fap::Frame& frame = clip.frames[i];
    frame.mask = clip.frames[0].mask;
    frame.value = clip.frames[i % 3].value;
    frame.viseme = clip.frames[0].viseme;
    frame.expression = clip.frames[0].expression;
  }
  options.ranges = fba::ranges_of(clip, 1);
  fba::LiveEncoder encoder(options);
  std::vector<Message> units;
  for (const fap::Frame& frame : clip.frames) {
    auto bytes = encoder.write(frame);
    EXPECT_TRUE(bytes) << bytes.error().describe();
    const std::uint8_t flags = encoder.intra() ? web::kIntra : 0;
    units.push_back({.bytes = web::write_unit({units.size(), 1, flags, *bytes}),
                     .entry = encoder.intra(),
                     .time = double(units.size())});
  }
  return units;
}

// Takes all that waits: how many units are intra planes, and the last one, decoded.
struct Taken {
  int units = 0, intra = 0;
  fba::Decoder decoder;
  fap::Frame face;

  void all(Hub& hub, web::ClientId client) {
    while (const auto message = hub.next(client)) {
      const auto unit = web::read_unit(message->bytes);
      ASSERT_TRUE(unit);
      ++units;
      intra += unit->flags & web::kIntra;
      decoder.push(unit->bytes);
    }
    fba::Decoder copy = decoder;
    copy.finish();
    for (auto event = copy.next(); event; event = copy.next()) {
      if (event->kind == fba::Event::Kind::plane) face = event->plane.face;
    }
  }
};

TEST(Hub, EachClientOfTheFaceHasOneIntraPlane) {
  Hub hub(100000, true);
  const auto units = face_units(60);
  const auto first = hub.add(Channel::face);
  const auto as_sent = hub.add(Channel::sent);
  for (int i = 0; i < 40; ++i) hub.publish(Channel::face, units[std::size_t(i)]);
  const auto late = hub.add(Channel::face);
  ASSERT_TRUE(hub.waiting(late)) << "it begins at once";
  for (int i = 40; i < 60; ++i) hub.publish(Channel::face, units[std::size_t(i)]);
  Taken of_first, of_sent, of_late;
  of_first.all(hub, first);
  of_sent.all(hub, as_sent);
  of_late.all(hub, late);
  EXPECT_EQ(of_first.units, 60);
  EXPECT_LE(of_first.intra, 2) << "the ranges of the first may be too small";
  EXPECT_EQ(of_sent.units, 60);
  EXPECT_GE(of_sent.intra, 10);
  EXPECT_EQ(of_late.units, 21);
  EXPECT_EQ(of_late.intra, 1);
  EXPECT_EQ(of_first.face.value, of_sent.face.value);
  EXPECT_EQ(of_late.face.value, of_sent.face.value);
}

TEST(Hub, WhoLosesUnitsOfTheFaceBeginsAnewAtOnce) {
  Hub hub(3000, true);
  const auto units = face_units(200);
  const auto slow = hub.add(Channel::face);
  std::size_t i = 0;
  while (hub.dropped() == 0 && i < units.size()) hub.publish(Channel::face, units[i++]);
  ASSERT_LT(i, units.size());
  ASSERT_FALSE(hub.waiting(slow));
  hub.publish(Channel::face, units[i]);
  const auto message = hub.next(slow);
  ASSERT_NE(message, nullptr) << "whatever the source sends";
  const auto unit = web::read_unit(message->bytes);
  EXPECT_EQ(unit->flags, web::kIntra | web::kMissed);
  EXPECT_EQ(unit->time, i);
}

TEST(Hub, ALongTimeWithoutAnIntraPlaneTakesNoMemory) {
  Hub hub(1000, true);
  Message large = text(0, true);
  large.bytes.resize(300000);
  for (int i = 0; i < 10; ++i) {
    hub.publish(Channel::faps, large);
    large.entry = false;
  }
  const auto client = hub.add(Channel::faps);
  EXPECT_FALSE(hub.waiting(client)) << "too much to send at once: it waits for the next";
}

TEST(Hub, SegmentsAreKeptUpToATime) {
  Hub hub(1000, true);
  for (int i = 0; i < 9; ++i) hub.publish(Channel::audio, text(i, true));
  hub.forget_before(Channel::audio, 6.5);
  const auto client = hub.add(Channel::audio);
  EXPECT_EQ(take(hub, client), "{\"time\":6}") << "the one that reaches over it";
}

TEST(Hub, TheStalledAreFound) {
  Hub hub(40, true);
  const auto client = hub.add(Channel::faps);
  const auto late = Hub::Clock::now() + std::chrono::seconds(1);
  EXPECT_FALSE(hub.stalled(client, late)) << "nothing waits";
  hub.publish(Channel::faps, text(0, true));
  EXPECT_TRUE(hub.stalled(client, late));
  EXPECT_FALSE(hub.stalled(client, Hub::Clock::now() - std::chrono::seconds(1)));
  hub.remove(client);
  EXPECT_FALSE(hub.stalled(client, late));
  EXPECT_EQ(hub.clients(), 0u);
}

// The small form has a bit for it, and words among bytes tell it as words do.
TEST(Hub, PlanesHaveABitAndWordsAWord) {
  Hub hub(40, true);
  const auto slow = hub.add(Channel::planes);
  const auto plane = [](bool intra) {
    return Message{.bytes = std::vector<std::uint8_t>(15), .entry = intra};
  };
  for (int i = 0; i < 4; ++i) hub.publish(Channel::planes, plane(i == 0));
  hub.publish(Channel::planes, plane(true));
  EXPECT_EQ(hub.next(slow)->bytes[0], web::kMissed);
  for (int i = 0; i < 4; ++i) hub.publish(Channel::planes, plane(i == 0));
  hub.publish(Channel::planes, text(9, true));
  EXPECT_EQ(nlohmann::json::parse(take(hub, slow)),
            (nlohmann::json{{"missed", true}, {"time", 9}}));
}

}  // namespace hub_test
}  // namespace animeme::test
