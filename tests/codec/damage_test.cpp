// The reference streams, cut and with bits flipped: every one ends in planes or in an error that
// says what and where. A sample by default; ANIMEME_EXHAUSTIVE=1 in the environment cuts at every
// byte and flips every bit of the first 200 bytes.
#include <gtest/gtest.h>

#include <cstdlib>

#include "codec/decode/decoder.h"
#include "tests/support/reference_streams.h"

namespace animeme {
namespace damage_test {

constexpr std::size_t kFlippedBytes = 200;

// Step through `count` cases: 1 if exhaustive, else such that about `sample` are taken, and others
// for other streams.
std::size_t step_of(std::size_t count, std::size_t sample) {
  const char* exhaustive = std::getenv("ANIMEME_EXHAUSTIVE");
  if (exhaustive != nullptr && std::string(exhaustive) == "1") return 1;
  return std::max<std::size_t>(1, count / sample) | 1;
}

// What comes out until the decoder wants more or has ended.
struct Outcome {
  std::size_t planes = 0;
  std::size_t errors = 0;
  bool ended = false;
};

class Damage : public testing::TestWithParam<std::filesystem::path> {
 protected:
  void SetUp() override { stream_ = test::read_bytes(test::with(GetParam(), ".fba")); }

  void pull(fba::Decoder& decoder, std::size_t pushed, Outcome& outcome) {
    // An event takes a bit at least.
    for (std::size_t i = 0; i < pushed * 8 + 100; ++i) {
      const auto event = decoder.next();
      if (event) {
        outcome.planes += event->kind == fba::Event::Kind::plane ? 1 : 0;
        continue;
      }
      const Error& error = event.error();
      if (error.code == Code::need_data) return;
      EXPECT_NE(error.code, Code::internal) << error.describe();
      EXPECT_FALSE(error.message.empty());
      EXPECT_GE(error.where.bit, 0) << error.message;
      EXPECT_LE(error.where.bit, std::int64_t(pushed) * 8) << error.message;
      if (error.code == Code::end_of_stream) {
        outcome.ended = true;
        return;
      }
      ++outcome.errors;
    }
    ADD_FAILURE() << "the decoder does not come to an end";
  }

  std::vector<std::uint8_t> stream_;
};

TEST_P(Damage, EveryCutIsNoticed) {
  // One decoder goes through the stream; a copy of it is told at each cut that this was all.
  fba::Decoder decoder;
  Outcome until_here;
  const std::size_t step = step_of(stream_.size(), 100);
  for (std::size_t size = 0; size < stream_.size(); ++size) {
    if (size > 0) decoder.push(std::span(stream_).subspan(size - 1, 1));
    pull(decoder, size, until_here);
    ASSERT_EQ(until_here.errors, 0U);
    if (until_here.ended) {
      ASSERT_GT(until_here.planes, 0U);
      break;  // the rest lies behind the end code
    }
    if (size % step != 0 && stream_.size() - size > 8) continue;
    fba::Decoder cut = decoder;
    cut.finish();
    Outcome outcome = until_here;
    pull(cut, size, outcome);
    ASSERT_TRUE(outcome.ended) << "cut at byte " << size;
    // What is complete behind a plane start code, or lacks only bytes of the end code, passes.
    if (outcome.errors == 0) {
      ASSERT_GT(outcome.planes, 0U) << "cut at byte " << size;
    }
  }
}

TEST_P(Damage, EveryFlippedBitEndsInPlanesOrErrors) {
  const std::size_t bits = std::min(stream_.size(), kFlippedBytes) * 8;
  const std::size_t step = step_of(bits, 30);
  std::size_t noticed = 0;
  for (std::size_t bit = 0; bit < bits; bit += step) {
    const std::uint8_t mask = std::uint8_t(0x80 >> (bit % 8));
    stream_[bit / 8] ^= mask;
    fba::Decoder decoder;
    decoder.push(stream_);
    decoder.finish();
    Outcome outcome;
    pull(decoder, stream_.size(), outcome);
    ASSERT_TRUE(outcome.ended) << "bit " << bit;
    ASSERT_GT(outcome.planes + outcome.errors, 0U) << "bit " << bit;
    noticed += outcome.errors > 0 ? 1 : 0;
    stream_[bit / 8] ^= mask;
  }
  EXPECT_GT(noticed, 0U) << "not a single flip was an error";
}

INSTANTIATE_TEST_SUITE_P(Streams, Damage, testing::ValuesIn(test::reference_streams()),
                         [](const auto& param_info) {
                           return param_info.param.filename().string();
                         });

}  // namespace damage_test
}  // namespace animeme
