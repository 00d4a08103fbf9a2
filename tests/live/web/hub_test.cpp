// What waits for whom, without sockets.
#include "tools/live/web/detail/hub.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

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
