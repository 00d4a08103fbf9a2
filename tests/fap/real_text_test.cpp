// What stands in for std::from_chars and std::to_chars where these know no fractions, against them.
#include "fap/detail/real_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "fap/text.h"

namespace animeme::fap::real_text_test {
namespace {

using namespace detail;

#ifdef __cpp_lib_to_chars

// The value, how many characters it took and the error; the value is 7 where none was read.
template <typename T, typename Reader>
std::string told(Reader reader, const std::string& text) {
  T value = 7;
  const auto [end, code] = reader(text.data(), text.data() + text.size(), value);
  char shown[64];
  std::snprintf(shown, sizeof shown, "%a", double(value));
  return text + ": " + shown + " " + std::to_string(end - text.data()) + " " +
         std::to_string(int(code));
}

template <typename T>
void expect_the_same(const std::string& text) {
  const auto of_standard = [](auto a, auto b, T& value) { return std::from_chars(a, b, value); };
  const auto of_c = [](auto a, auto b, T& value) { return read_by_c_library(a, b, value); };
  EXPECT_EQ(told<T>(of_c, text), told<T>(of_standard, text));
}

const std::vector<std::string>& texts() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> out = {"",
                                    "-",
                                    "+1",
                                    " 1",
                                    ".",
                                    "-.",
                                    ".5",
                                    "5.",
                                    "-.5e1x",
                                    "1e",
                                    "1e+",
                                    "1e-x",
                                    "1e5",
                                    "1E+5",
                                    "0x10",
                                    "00012.50",
                                    "1,5",
                                    "1.5.5",
                                    "inf",
                                    "-INF",
                                    "infin",
                                    "INFinity",
                                    "nan",
                                    "-NaN",
                                    "nan(7)",
                                    "nan(7",
                                    "nan(a-b)",
                                    "in",
                                    "na",
                                    "e5",
                                    "1e400",
                                    "-1e400",
                                    "1e-400",
                                    "0e-400",
                                    "-0",
                                    "-0.0e400",
                                    "1e39",
                                    "1e-60",
                                    "4.9e-324",
                                    "1e-310",
                                    "2.2250738585072011e-308",
                                    "1.17549429e-38",
                                    "1e-42",
                                    "0.1",
                                    "9007199254740993",
                                    "123456789012345678901234567890",
                                    "0.30000000000000004",
                                    "17976931348623158079372897140530341507993413271003782693617377"
                                    "8980444968292764750946649017977587",
                                    "1.5\xC3\xA4",
                                    std::string("1\0005", 3),
                                    std::string(800, '1'),
                                    "0." + std::string(400, '0') + "1"};
    std::mt19937_64 random(1);
    const std::string alphabet = "0123456789..eE+-nif";
    for (int i = 0; i < 20000; ++i) {
      std::string text(1 + random() % 12, ' ');
      for (char& c : text) c = alphabet[random() % alphabet.size()];
      out.push_back(text);
    }
    return out;
  }();
  return all;
}

// A locale with a decimal comma, made here: fresh systems have none.
bool set_locale_with_comma() {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::path(testing::TempDir()) / ("comma" + std::to_string(std::random_device()()));
  fs::create_directory(folder);
  std::ofstream(folder / "source")
      << "LC_CTYPE\ncopy \"POSIX\"\nEND LC_CTYPE\n"
         "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \"\"\ngrouping -1\nEND LC_NUMERIC\n";
  const std::string at = folder.string();
  const std::string command =
      "localedef -c --no-archive -i " + at + "/source " + at + "/commas >" + at + "/log 2>&1";
  [[maybe_unused]] const int warned = std::system(command.c_str());
  setenv("LOCPATH", at.c_str(), 1);
  const bool set = std::setlocale(LC_ALL, "commas") != nullptr;
  unsetenv("LOCPATH");
  fs::remove_all(folder);
  return set && std::string(std::localeconv()->decimal_point) == ",";
}

class Locales : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (GetParam() && !set_locale_with_comma()) GTEST_SKIP() << "localedef is missing (libc-bin)";
  }
  void TearDown() override { std::setlocale(LC_ALL, "C"); }
};

TEST_P(Locales, ReadsAsFromCharsDoes) {
  for (const std::string& text : texts()) {
    expect_the_same<double>(text);
    expect_the_same<float>(text);
  }
}

template <typename T>
void expect_shortest(T value) {
  char buffer[64];
  const std::string expected(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  ASSERT_EQ(shortest_by_c_library(value), expected);
}

TEST_P(Locales, WritesAsToCharsDoes) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 5000; ++i) {
    const std::uint64_t bits = random();
    expect_shortest(std::bit_cast<double>(bits));
    expect_shortest(std::bit_cast<float>(std::uint32_t(bits)));
    // Of usual sizes and few digits.
    expect_shortest(double(std::int32_t(bits)) / std::pow(10.0, double(bits >> 60)));
    expect_shortest(float(std::int16_t(bits)) / 1024);
  }
  for (int e = -1074; e < 1024; ++e) expect_shortest(std::ldexp(1.0, e));
  for (int e = -149; e < 128; ++e) expect_shortest(std::ldexp(1.0f, e));
  for (int e = -30; e < 30; ++e) expect_shortest(std::pow(10.0, e));
  for (const double special : {0.0, -0.0, double(INFINITY), -double(INFINITY)})
    expect_shortest(special);
}

TEST_P(Locales, WritesDigitsAsToCharsDoes) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 5000; ++i) {
    const float value = float(std::int32_t(random())) / float(1 << (random() % 31));
    const int digits = int(1 + random() % 9);
    char buffer[64];
    const auto form = std::chars_format::general;
    const std::string expected(
        buffer, std::to_chars(buffer, buffer + sizeof buffer, value, form, digits).ptr);
    ASSERT_EQ(digits_by_c_library(value, digits), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Comma, Locales, testing::Bool());

#endif

// On every machine, whichever of the two it has.
TEST(RealText, NumbersOfFapFiles) {
  const auto clip = read_text("2.1 x 29.97 1\n0 0 0 1" + [] {
    std::string rest;
    for (int i = 4; i < 68; ++i) rest += " 0";
    return rest;
  }() + "\n0 -12.0e1\n");
  ASSERT_TRUE(clip) << clip.error().describe();
  EXPECT_EQ(clip->frames.at(0).value.at(4), -120);
  std::string text;
  append_shortest(text, 0.1f);
  append_shortest(text, -1e-7f);
  append_digits(text, 3.14159f, 3);
  EXPECT_EQ(text, "0.1-1e-073.14");
}

}  // namespace
}  // namespace animeme::fap::real_text_test
