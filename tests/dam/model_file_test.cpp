#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dam/model.h"
#include "dam_support.h"

namespace animeme::dam {
namespace {

AnimemeParameters& animemes(Model& model) { return std::get<AnimemeParameters>(model.parameters); }

Model small_model() {
  Model model;
  model.attribution = "nobody";
  model.provenance = "made by hand";
  model.controls = {{"fap3_open_jaw", 1.5, 2.5, 3.5}, {"smile", 0, 0, 0}};
  model.lip_tooth_raise = 120;
  model.phones = {{"AA", 20, 8, 0.1, 0.4}, {"SIL", 9, 0, 0.3, 0.3}};
  AnimemeParameters parameters;
  parameters.order = 1;
  parameters.phones = {
      {{{0.5, {1, 2, 3, 4}}, {0.75, {5, 6, 7, 8}}}, {{1, -1, 0, 12}, {1, 1, 1, 8}}},
      {{{1.25, {0, 0, 0, 0.5}}}, {{-1, 0, 0, 9}}}};
  model.parameters = parameters;
  return model;
}

TEST(ModelFile, ReadsWhatItWrote) {
  Model model = small_model();
  EXPECT_TRUE(validate(model));
  const auto again = read_model(write_model(model));
  ASSERT_TRUE(again) << again.error().describe();
  EXPECT_EQ(*again, model);
  animemes(model).time_margin = std::numeric_limits<double>::infinity();
  EXPECT_EQ(*read_model(write_model(model)), model);
}

TEST(ModelFile, EveryDamagedByteIsFound) {
  const auto bytes = write_model(small_model());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const int flip : {0x01, 0x80, 0xFF}) {
      auto damaged = bytes;
      damaged[i] = std::uint8_t(damaged[i] ^ flip);
      EXPECT_FALSE(read_model(damaged)) << "byte " << i;
    }
}

TEST(ModelFile, EveryTruncationAndExtensionIsFound) {
  auto bytes = write_model(small_model());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(read_model(std::span(bytes).first(n))) << n << " bytes";
  bytes.push_back(0);
  EXPECT_FALSE(read_model(bytes));
}

TEST(ModelFile, SealedNonsenseIsRefusedWithoutHarm) {
  const auto good = write_model(small_model());
  int refused = 0;
  for (std::size_t i = 20; i + 4 < good.size(); ++i)
    for (const int value : {0x00, 0x7F, 0xFF}) {
      auto bytes = good;
      bytes[i] = std::uint8_t(value);
      test::seal(bytes);
      const auto model = read_model(bytes);
      if (model) {
        EXPECT_TRUE(validate(*model)) << "byte " << i;
      }
      refused += model ? 0 : 1;
    }
  EXPECT_GT(refused, 100);
}

TEST(ModelFile, HugeCountsAllocateNothing) {
  auto bytes = write_model(small_model());
  // The number of controls stands behind method, two reals, an optional one, rate and two texts.
  const std::size_t at = 20 + 1 + 16 + 9 + 8 + 4 + 6 + 4 + 12;
  ASSERT_EQ(bytes[at], 2);
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = 0xFF;
  test::seal(bytes);
  const auto model = read_model(bytes);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Code::syntax);
}

TEST(ModelFile, NewerVersions) {
  auto bytes = write_model(small_model());
  bytes[8] = 3;
  auto model = read_model(bytes);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Code::unsupported);
  EXPECT_THAT(model.error().message, testing::HasSubstr("version 3.0"));
  bytes[8] = 2;
  bytes[10] = 7;  // a newer minor version may have more behind what we know
  test::seal(bytes);
  EXPECT_TRUE(read_model(bytes));
}

TEST(ModelFile, InvalidModels) {
  const auto broken = [](auto change) {
    Model model = small_model();
    change(model);
    return !validate(model);
  };
  EXPECT_TRUE(broken([](Model& m) { m.controls.clear(); }));
  EXPECT_TRUE(broken([](Model& m) { m.phones.clear(); }));
  EXPECT_TRUE(broken([](Model& m) { animemes(m).phones[0].modes.clear(); }));
  EXPECT_TRUE(broken([](Model& m) { animemes(m).phones[0].modes[0].sigma = 0; }));
  EXPECT_TRUE(broken([](Model& m) { animemes(m).phones[0].modes[0].coefficients.pop_back(); }));
  EXPECT_TRUE(
      broken([](Model& m) { animemes(m).phones[0].modes[0].coefficients[0] = std::nan(""); }));
  EXPECT_TRUE(broken([](Model& m) { animemes(m).phones[0].contexts[0].left = 2; }));
  EXPECT_TRUE(broken([](Model& m) { animemes(m).phones[0].contexts[0].mode = 2; }));
  EXPECT_TRUE(broken([](Model& m) { std::swap(m.phones[0], m.phones[1]); }));
  EXPECT_TRUE(broken([](Model& m) { m.rate = {0, 1}; }));
  EXPECT_TRUE(broken([](Model& m) { animemes(m).order = 9; }));
}

TEST(ModelFile, OnDisk) {
  const auto path = std::filesystem::path(testing::TempDir()) / "animeme_model_file_test.dam";
  ASSERT_TRUE(save_model(small_model(), path));
  EXPECT_EQ(*load_model(path), small_model());
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
  std::filesystem::remove(path);
  EXPECT_EQ(load_model(path).error().code, Code::not_found);
  EXPECT_EQ(save_model(small_model(), path / "no" / "folder").error().code, Code::io);
}

}  // namespace
}  // namespace animeme::dam
