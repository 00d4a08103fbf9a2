#include "fap/rate_text.h"

#include <gtest/gtest.h>

namespace animeme::fap {
namespace rate_text_test {

Rate read(std::string_view text) {
  const Result<Rate> rate = parse_rate(text);
  EXPECT_TRUE(rate) << text;
  return rate ? *rate : Rate{0, 0};
}

TEST(RateText, ReadsIntegersDecimalsAndFractions) {
  EXPECT_EQ(read("25"), (Rate{25, 1}));
  EXPECT_EQ(read("12.5"), (Rate{25, 2}));
  EXPECT_EQ(read("25.0"), (Rate{25, 1}));
  EXPECT_EQ(read("25."), (Rate{25, 1}));
  EXPECT_EQ(read("33.33"), (Rate{3333, 100}));
  EXPECT_EQ(read("60000/1001"), (Rate{60000, 1001}));
  EXPECT_EQ(read("50/2"), (Rate{25, 1}));
  EXPECT_EQ(read("25.0625"), (Rate{401, 16}));
}

TEST(RateText, KnowsTheNtscRates) {
  EXPECT_EQ(read("29.97"), (Rate{30000, 1001}));
  EXPECT_EQ(read("29.970"), (Rate{30000, 1001}));
  EXPECT_EQ(read("29.97003"), (Rate{30000, 1001}));
  EXPECT_EQ(read("23.976"), (Rate{24000, 1001}));
  EXPECT_EQ(read("23.98"), (Rate{24000, 1001}));
  EXPECT_EQ(read("59.94"), (Rate{60000, 1001}));
  EXPECT_EQ(read("119.88"), (Rate{120000, 1001}));
  EXPECT_EQ(read("14.985"), (Rate{15000, 1001}));
  EXPECT_EQ(read("14.99"), (Rate{1499, 100}));
  EXPECT_EQ(read("29.96"), (Rate{749, 25}));
}

TEST(RateText, ManyDecimalsStandForTheSimplestFraction) {
  EXPECT_EQ(read("0.3333333"), (Rate{1, 3}));
  EXPECT_EQ(read("12.487512488"), (Rate{12500, 1001}));
  EXPECT_EQ(read("12.5000000"), (Rate{25, 2}));
}

TEST(RateText, ZeroIsReadAsInvalid) {
  EXPECT_FALSE(read("0").valid());
  EXPECT_FALSE(read("0.0").valid());
  EXPECT_FALSE(read("0.000000000").valid());
  EXPECT_EQ(format_rate({0, 1}), "0");
  EXPECT_EQ(format_rate({1, 0}), "0");
}

TEST(RateText, RefusesOtherTexts) {
  for (const char* text : {"", ".", ".5", "-25", "+25", "1e3", "25fps", "25 ", "12,5", "1/0", "/2",
                           "2/", "1/2/3", "nan", "1.0000000000", "1.-5"}) {
    const Result<Rate> rate = parse_rate(text);
    ASSERT_FALSE(rate) << text;
    EXPECT_EQ(rate.error().code, Code::syntax) << text;
  }
  for (const char* text : {"4294967296", "4294967296.5", "99999999999/7", "4000000000.5"}) {
    const Result<Rate> rate = parse_rate(text);
    ASSERT_FALSE(rate) << text;
    EXPECT_EQ(rate.error().code, Code::out_of_range) << text;
  }
}

TEST(RateText, WritesTheShortestForm) {
  EXPECT_EQ(format_rate({25, 1}), "25");
  EXPECT_EQ(format_rate({25, 2}), "12.5");
  EXPECT_EQ(format_rate({401, 16}), "25.0625");
  EXPECT_EQ(format_rate({30000, 1001}), "29.97");
  EXPECT_EQ(format_rate({24000, 1001}), "23.976");
  EXPECT_EQ(format_rate({48000, 1001}), "47.952");
  EXPECT_EQ(format_rate({2997, 100}), "29.97000");  // not the NTSC rate
  EXPECT_EQ(format_rate({1, 3}), "0.3333333");
}

TEST(RateText, ReadsBackWhatItWrites) {
  for (std::uint32_t den = 1; den <= 2100; den += 7) {
    for (std::uint32_t num = 1; num < 60000; num += 997) {
      const Rate rate = make_rate(num, den);
      ASSERT_EQ(read(format_rate(rate)), rate) << num << "/" << den;
    }
  }
  for (const Rate rate : {Rate{4294967295u, 4294967291u}, Rate{1, 4294967295u},
                          Rate{4294967295u, 1}, Rate{4294967295u, 2}}) {
    EXPECT_EQ(read(format_rate(rate)), rate) << format_rate(rate);
  }
}

}  // namespace rate_text_test
}  // namespace animeme::fap
