// Receivers ask for intra planes, and get them within a frame.
#include <gtest/gtest.h>

#include <map>

#include "codec/decode/decoder.h"
#include "codec/encode/encode.h"
#include "tests/formats/media/live/intra_requests.h"
#include "tests/formats/media/live/rtp_support.h"

namespace animeme::media {
namespace intra_request_test {

using test::Bytes;
using test::LiveTalk;
using test::random_talk;

// Values that a decoder has which starts with the first of these units, by time; held where a plane
// does not code them.
std::map<std::int64_t, std::array<std::int32_t, fap::kFapCount + 1>> shown(
    const std::vector<LiveUnit>& units) {
  Bytes stream;
  for (const LiveUnit& unit : units) {
    stream.insert(stream.end(), unit.bytes.begin(), unit.bytes.end());
  }
  const auto end = fba::end_code();
  stream.insert(stream.end(), end.begin(), end.end());
  const auto decoded = fba::decode(stream);
  EXPECT_TRUE(decoded) << decoded.error().describe();
  std::map<std::int64_t, std::array<std::int32_t, fap::kFapCount + 1>> values;
  if (!decoded) return values;
  EXPECT_TRUE(decoded->warnings.empty());
  EXPECT_EQ(decoded->planes.size(), units.size());
  std::array<std::int32_t, fap::kFapCount + 1> held{};
  for (std::size_t i = 0; i < std::min(units.size(), decoded->planes.size()); ++i) {
    const fap::Frame& face = decoded->planes[i].face;
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (face.mask[fap]) held[fap] = face.value[fap];
    }
    values[units[i].time] = held;
  }
  return values;
}

std::vector<LiveUnit> from(const std::vector<LiveUnit>& units, std::size_t first) {
  return {units.begin() + std::ptrdiff_t(first), units.end()};
}

void expect_shown_from(const std::vector<LiveUnit>& units, std::size_t first,
                       const std::vector<LiveUnit>& source) {
  const auto want = shown(source);
  for (const auto& [time, values] : shown(from(units, first))) {
    ASSERT_EQ(values, want.at(time)) << "from " << first << " at " << time;
  }
}

TEST(IntraOnRequest, NothingChangesWithoutRequests) {
  const LiveTalk talk = random_talk(120, 40);
  fba::IntraOnRequest filter;
  for (const LiveUnit& unit : talk.units) EXPECT_EQ(test::passed(filter, unit, false), unit);
}

TEST(IntraOnRequest, ReceiversCanBeginThere) {
  const LiveTalk talk = random_talk(250, 100);
  for (const std::size_t wanted : {std::size_t(1), std::size_t(30), std::size_t(80)}) {
    fba::IntraOnRequest filter;
    std::vector<LiveUnit> units;
    std::size_t next = wanted + 6;  // intra plane of the source
    while (next < talk.units.size() && !talk.units[next].intra) ++next;
    ASSERT_LT(next, talk.units.size());
    for (std::size_t i = 0; i < talk.units.size(); ++i) {
      // Once more while planes are coded again.
      units.push_back(test::passed(filter, talk.units[i], i == wanted || i == wanted + 5));
    }
    EXPECT_TRUE(units[wanted].intra && units[wanted + 5].intra);
    for (std::size_t i = 0; i < units.size(); ++i) {
      EXPECT_EQ(units[i].time, talk.units[i].time);
      EXPECT_EQ(units[i].duration, talk.units[i].duration);
      if (i < wanted || i >= next) {
        EXPECT_EQ(units[i], talk.units[i]) << i;
      }
    }
    expect_shown_from(units, 0, talk.units);
    expect_shown_from(units, wanted, talk.units);
    expect_shown_from(units, next, talk.units);
  }
}

// Clips whose intra planes do not send all ranges, or code other FAPs than those before.
TEST(IntraOnRequest, OfAnyStream) {
  for (const std::uint64_t seed : {3U, 4U, 5U, 6U}) {
    const fap::Sequence clip = test::random_clip(seed, 90);
    fba::EncodeOptions options = fba::file_options();
    options.kept_ranges = seed % 2 == 0;
    const auto stream = fba::encode(clip, options);
    ASSERT_TRUE(stream);
    const auto units = fba::split_access_units(*stream);
    ASSERT_TRUE(units);
    const LiveTalk talk = test::talk_of(*units);
    fba::IntraOnRequest filter;
    std::vector<LiveUnit> passed;
    for (std::size_t i = 0; i < talk.units.size(); ++i) {
      passed.push_back(test::passed(filter, talk.units[i], i == 20 || i == 60));
    }
    EXPECT_TRUE(passed[20].intra && passed[60].intra);
    expect_shown_from(passed, 0, talk.units);
    expect_shown_from(passed, 20, talk.units);
    expect_shown_from(passed, 60, talk.units);
  }
}

TEST(IntraOnRequest, DamagedUnitsArePassedOn) {
  LiveTalk talk = random_talk(60, 25);
  talk.units[10].bytes = {1, 2, 3};
  fba::IntraOnRequest filter;
  for (std::size_t i = 0; i < 25; ++i)
    EXPECT_EQ(test::passed(filter, talk.units[i], i >= 10), talk.units[i]);
  for (std::size_t i = 25; i < 60; ++i) {
    EXPECT_TRUE(test::passed(filter, talk.units[i], i == 30).intra ==
                (i == 25 || i == 30 || i == 50))
        << i;
  }
}

std::vector<std::uint8_t> request(std::uint32_t media, std::optional<std::uint8_t> sequence) {
  RtcpMessage message;
  message.reports.push_back({7, std::nullopt, {}});
  message.requests.push_back({7, media, sequence});
  return write_rtcp(message);
}

TEST(IntraRequests, SendersTakeThem) {
  const LiveTalk talk = random_talk(3);
  RtpSender sender(talk.info, {}, "127.0.0.1", 5004, 1, 0);
  const std::uint32_t face = *sender.session().face->ssrc;
  EXPECT_FALSE(sender.intra_wanted(1));
  sender.rtcp(request(face + 1, {}), 1);  // somebody else's
  EXPECT_FALSE(sender.intra_wanted(1));
  sender.rtcp(request(face, {}), 1);
  EXPECT_TRUE(sender.intra_wanted(1));
  EXPECT_FALSE(sender.intra_wanted(1.01)) << "one answer";
  sender.rtcp(request(face, {}), 1.02);
  EXPECT_FALSE(sender.intra_wanted(1.03)) << "too soon";
  EXPECT_TRUE(sender.intra_wanted(1.11));
  sender.rtcp(request(face, 4), 2);
  EXPECT_TRUE(sender.intra_wanted(2));
  sender.rtcp(request(face, 4), 3);  // comes again
  EXPECT_FALSE(sender.intra_wanted(3));
  sender.rtcp(request(face, 5), 4);
  EXPECT_TRUE(sender.intra_wanted(4));
}

TEST(IntraRequests, EndFreezesSoon) {
  const LiveTalk talk = random_talk(3000, 600, {60, 1});
  const RecoveryStats without = test::run_asking(talk, false, {.loss = 2}, 5).recovery;
  const RecoveryStats with = test::run_asking(talk, true, {.loss = 2}, 5).recovery;
  EXPECT_GT(without.frozen_seconds, 20);
  EXPECT_LT(with.frozen_seconds, without.frozen_seconds / 3);
  EXPECT_GT(with.share(), 0.85);
  EXPECT_LT(with.longest_seconds, 1);
}

}  // namespace intra_request_test
}  // namespace animeme::media
