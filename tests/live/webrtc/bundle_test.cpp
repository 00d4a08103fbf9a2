// Messages of `animeme.face`, read by code of the tests alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "tools/live/webrtc/detail/bundle.h"

namespace animeme::test {
namespace bundle_test {

using Bytes = std::vector<std::uint8_t>;
using webrtc::BundleWriter;

struct Bundle {
  std::uint32_t number = 0;
  Bytes hello;
  std::vector<Bytes> units;
};

/// As README.md says it.
std::optional<Bundle> read(const Bytes& message) {
  std::size_t at = 0;
  const auto number = [&](int size) {
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i) value = value << 8 | message.at(at++);
    return value;
  };
  const auto bytes = [&](std::size_t size) {
    at += size;
    return Bytes(message.begin() + std::ptrdiff_t(at - size), message.begin() + std::ptrdiff_t(at));
  };
  if (number(1) != 'B' || number(1) != 1) return std::nullopt;
  Bundle bundle;
  bundle.number = number(4);
  const std::uint32_t count = number(1);
  bundle.hello = bytes(number(2));
  for (std::uint32_t i = 0; i < count; ++i) bundle.units.push_back(bytes(number(2)));
  EXPECT_EQ(at, message.size());
  return bundle;
}

Bytes unit_of(std::uint32_t number, std::size_t size = 40) {
  Bytes unit(size, std::uint8_t(number));
  unit[0] = std::uint8_t(number >> 8);
  return unit;
}

TEST(Bundle, RepeatsWhatCameBefore) {
  BundleWriter writer({'A', 1, 2}, 2);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const bool intra = i % 8 == 0;
    const auto bundle = read(writer.push(unit_of(i), intra));
    ASSERT_TRUE(bundle);
    const std::uint32_t first = i < 2 ? 0 : i - 2;
    EXPECT_EQ(bundle->number, first);
    ASSERT_EQ(bundle->units.size(), i + 1 - first);
    for (std::uint32_t k = first; k <= i; ++k) EXPECT_EQ(bundle->units[k - first], unit_of(k));
    EXPECT_EQ(bundle->hello.empty(), i % 8 > 2) << "who begins knows what it is";
  }
  EXPECT_EQ(writer.repeated(), 0 + 1 + 2 * 18);
}

TEST(Bundle, StaysWithinAPacket) {
  BundleWriter writer(Bytes(25, 'A'), 30);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Bytes message = writer.push(unit_of(i, 1 + i * 37 % 400), i % 25 == 0);
    EXPECT_LE(message.size(), webrtc::kMostBundle);
    EXPECT_EQ(read(message)->units.back(), unit_of(i, 1 + i * 37 % 400));
  }
  // What is larger alone goes alone.
  const auto large = read(writer.push(unit_of(7, 5000), false));
  EXPECT_EQ(large->units.size(), 1u);
}

TEST(Bundle, NewcomersGetAllSinceTheIntraPlane) {
  BundleWriter writer({'A'}, 1);
  EXPECT_TRUE(writer.catch_up().empty());
  for (std::uint32_t i = 0; i < 70; ++i) writer.push(unit_of(i), i % 50 == 10);
  std::uint32_t next = 60;
  for (const Bytes& message : writer.catch_up()) {
    EXPECT_LE(message.size(), webrtc::kMostBundle);
    const auto bundle = read(message);
    ASSERT_TRUE(bundle);
    EXPECT_EQ(bundle->number, next);
    EXPECT_EQ(bundle->hello.empty(), next != 60);
    for (const Bytes& unit : bundle->units) EXPECT_EQ(unit, unit_of(next++));
  }
  EXPECT_EQ(next, 70u);
}

TEST(Bundle, AStreamWithoutIntraPlanesDoesNotGrow) {
  BundleWriter writer({'A'}, 1);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    EXPECT_EQ(read(writer.push(unit_of(i), false))->number, i == 0 ? 0 : i - 1);
  }
  std::size_t units = 0;
  for (const Bytes& message : writer.catch_up()) units += read(message)->units.size();
  EXPECT_EQ(units, 512u);
}

// 5 % of the messages are lost, each on its own: what arrives lacks nothing.
TEST(Bundle, SurvivesLoss) {
  BundleWriter writer({'A'}, 5);
  std::mt19937 random(3);
  std::uint32_t next = 0;
  int lost = 0;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    const auto bundle = read(writer.push(unit_of(i), i % 25 == 0));
    if (random() % 20 == 0) {
      ++lost;
      continue;
    }
    EXPECT_LE(bundle->number, next) << "a gap";
    next = i + 1;
  }
  EXPECT_GT(lost, 800);
  EXPECT_EQ(next, 20000u);
}

}  // namespace bundle_test
}  // namespace animeme::test
