// Recorded packets of iFacialMocap.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/capture_table.h"
#include "tools/formats/exchange/curves.h"
#include "tools/formats/exchange/file_kind.h"
#include "tools/formats/exchange/motion.h"

namespace animeme::exchange {
namespace face_packets_test {

using testing::Contains;
using testing::HasSubstr;

std::size_t channel(std::string_view name) {
  return std::size_t(fap::find_arkit(name).value_or(0));
}

// A packet of version 1, or of version 2.
std::string packet(int jaw, double yaw, char mark = '-') {
  const std::string m(1, mark);
  return "mouthSmile_R" + m + "0|eyeLookOut_L" + m + "3|jawOpen" + m + std::to_string(jaw) +
         "|trackingStatus" + m + "1|mouthSmile_L" + m + "100|=head#-10," + std::to_string(yaw) +
         ",5,-0.03,-0.1,-0.65|rightEye#6,2,0|leftEye#6,-1,0|";
}

ArkitCurves weights(const std::string& text, const ArkitOptions& options,
                    std::vector<std::string>* warnings = nullptr) {
  EXPECT_EQ(kind_of({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}),
            FileKind::curves);
  auto table = capture_table(text);
  EXPECT_TRUE(table) << table.error().describe();
  if (!table) return {};
  EXPECT_EQ(table->kind, CaptureKind::arkit);
  if (warnings != nullptr) *warnings = table->warnings;
  auto read = read_arkit_weights(table->table, options);
  EXPECT_TRUE(read) << read.error().describe();
  return read ? *read : ArkitCurves{};
}

TEST(FacePackets, OneALine) {
  for (const char mark : {'-', '&'}) {
    std::string text;
    // A face at rest: what is percent is known, not guessed from large values.
    for (int i = 0; i < 20; ++i) text += packet(i % 3, -12, mark) + "\r\n";
    std::vector<std::string> warnings;
    const ArkitCurves curves = weights(text, {.rate = fap::Rate{60, 1}}, &warnings);
    ASSERT_EQ(curves.frames.size(), 20u);
    const fap::ArkitFrame& frame = curves.frames[5];
    EXPECT_NEAR(frame[channel("jawOpen")], 0.02, 1e-9);
    EXPECT_NEAR(frame[channel("mouthSmileLeft")], 1, 1e-9);
    EXPECT_NEAR(frame[channel("eyeLookOutLeft")], 0.03, 1e-9);
    const double degree = std::numbers::pi / 180;
    EXPECT_NEAR(frame[channel("headPitch")], -10 * degree, 1e-5);
    EXPECT_NEAR(frame[channel("headYaw")], 12 * degree, 1e-5);
    EXPECT_NEAR(frame[channel("headRoll")], -5 * degree, 1e-5);
    EXPECT_NEAR(frame[channel("leftEyeYaw")], degree, 1e-5);
    EXPECT_THAT(warnings, Contains(HasSubstr("trackingStatus")));
  }
}

TEST(FacePackets, WithTimesInFront) {
  for (const char* between : {"|", ",", " ", "\t"}) {
    std::string text;
    for (int i = 0; i < 30; ++i) {
      text += std::to_string(1700000000 + i / 30.0) + between + packet(i, 0) + "\n";
    }
    const ArkitCurves curves = weights(text, {});
    ASSERT_EQ(curves.frames.size(), 30u);
    EXPECT_NEAR(curves.rate.frames_per_second(), 30, 0.01);
    EXPECT_NEAR(curves.frames[29][channel("jawOpen")], 0.29, 1e-9);
  }
}

// As they come over TCP, stopped in the middle of one.
TEST(FacePackets, OneBehindTheOther) {
  std::string text;
  for (int i = 0; i < 10; ++i) text += packet(i, 0) + "___iFacialMocap";
  text += packet(50, 0).substr(0, 5);
  std::vector<std::string> warnings;
  const ArkitCurves curves = weights(text, {.rate = fap::Rate{60, 1}}, &warnings);
  EXPECT_EQ(curves.frames.size(), 10u);
  EXPECT_THAT(warnings, Contains(HasSubstr("cut off")));
}

TEST(FacePackets, MistakesAreNamed) {
  const auto error_of = [](const std::string& text) {
    const auto table = capture_table(text);
    EXPECT_FALSE(table);
    return table ? std::string() : table.error().describe();
  };
  const std::string good = packet(1, 0) + "\n";
  EXPECT_THAT(error_of(good + "mouthSmile_L-x|jawOpen-1|a-1|\n" + good), HasSubstr("2"));
  EXPECT_THAT(error_of(good + "=head#a,2,3|jawOpen-1|\n" + good), HasSubstr("not a number"));
  EXPECT_THAT(error_of("0.5|" + good + good), HasSubstr("time"));
  // Without times a rate is wanted.
  const auto table = capture_table(good + good);
  ASSERT_TRUE(table);
  const auto read = read_arkit_table(table->table);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("--rate"));
  EXPECT_FALSE(read_any_table("a|b|c\n1|2|3\n"));
}

}  // namespace face_packets_test
}  // namespace animeme::exchange
