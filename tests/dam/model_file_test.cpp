#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include <filesystem>
#include <fstream>

#include "dam/model/model.h"
#include "dam/speaking/synthesise.h"
#include "tests/support/files.h"
#include "tests/support/sealed_model.h"
#include "tests/support/temp_dir.h"

namespace animeme::dam {
namespace model_file_test {

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

/// One model of each set of parameters.
std::vector<Model> small_models() {
  TrajectoryParameters trajectory;
  trajectory.states = 2;
  trajectory.smoothness = {0.03, 0.05};
  trajectory.mean = {1, 2, 3, 4, 5, 6, 7, -8};
  trajectory.variance = {1, 0.5, 1, 0.5, 1, 0.5, 1, 0.25};
  const VisemeParameters viseme{0.4, 0.2, {1, -2, 3, 4}};
  TriphoneParameters triphone;
  triphone.points = 2;
  triphone.reach = 0.25;
  triphone.curves = {{0, CurveLevel::phone, kAnyContext, kAnyContext, 20, {1, 2, 3, 4}},
                     {0, CurveLevel::left_class, 0, kAnyContext, 7, {0, 0.5, 0, -1}},
                     {1, CurveLevel::triphone, 0, kRestContext, 9, {5, 6, 7, 8}}};
  std::vector<Model> models = {small_model()};
  const auto add = [&](Method method, Parameters parameters) {
    models.push_back(small_model());
    models.back().method = method;
    models.back().parameters = std::move(parameters);
  };
  add(Method::mmm, trajectory);
  add(Method::mean, MeanParameters{});
  add(Method::viseme, viseme);
  add(Method::triphone, triphone);
  return models;
}

class ModelFiles : public testing::TestWithParam<Model> {};
INSTANTIATE_TEST_SUITE_P(Kinds, ModelFiles, testing::ValuesIn(small_models()),
                         [](const auto& model) {
                           std::string name(method_name(model.param.method));
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(ModelFiles, ReadsWhatItWrote) {
  EXPECT_TRUE(validate(GetParam()));
  const auto again = read_model(write_model(GetParam()));
  ASSERT_TRUE(again) << again.error().describe();
  EXPECT_EQ(*again, GetParam());
}

TEST(ModelFile, KeepsAnInfiniteTimeMargin) {
  Model model = small_model();
  animemes(model).time_margin = std::numeric_limits<double>::infinity();
  EXPECT_EQ(*read_model(write_model(model)), model);
}

TEST_P(ModelFiles, EveryDamagedByteIsFound) {
  const auto bytes = write_model(GetParam());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const int flip : {0x01, 0x80, 0xFF}) {
      auto damaged = bytes;
      damaged[i] = std::uint8_t(damaged[i] ^ flip);
      EXPECT_FALSE(read_model(damaged)) << "byte " << i;
    }
}

TEST_P(ModelFiles, EveryTruncationAndExtensionIsFound) {
  auto bytes = write_model(GetParam());
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_FALSE(read_model(std::span(bytes).first(n))) << n << " bytes";
  bytes.push_back(0);
  EXPECT_FALSE(read_model(bytes));
}

TEST_P(ModelFiles, SealedNonsenseIsRefusedWithoutHarm) {
  const auto good = write_model(GetParam());
  int refused = 0;
  for (std::size_t i = 20; i + 4 < good.size(); ++i)
    for (const int value : {0x00, 0x7F, 0xFF}) {
      auto bytes = good;
      bytes[i] = std::uint8_t(value);
      test::seal(bytes);
      const auto model = read_model(bytes);
      if (model) {
        EXPECT_TRUE(validate(*model)) << "byte " << i;
        (void)synthesise(*model, {{{0, 0.3, "SIL", ""}, {0.3, 0.5, "AA", ""}}});
      }
      refused += model ? 0 : 1;
    }
  EXPECT_GT(refused, 80);
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
  EXPECT_THAT(model.error().message, testing::HasSubstr("version 3.2"));
  bytes[8] = 2;
  bytes[10] = 7;  // a newer minor version may have more behind what we know
  test::seal(bytes);
  EXPECT_TRUE(read_model(bytes));
}

TEST(ModelFile, OlderVersionsAreRead) {
  Model model = small_model();
  model.closure_duration = ClosureDuration{0.07, 0.25};
  auto bytes = write_model(model);
  const auto same = read_model(bytes);
  ASSERT_TRUE(same);
  EXPECT_EQ(*same, model);
  // 2.0 ended with the parameters of the method: without the flag and two numbers, and without
  // limits.
  const std::size_t more = 1 + 8 + 8 + 4;
  bytes.erase(bytes.end() - 4 - std::ptrdiff_t(more), bytes.end() - 4);
  bytes[10] = 0;
  std::uint64_t size = 0;
  std::memcpy(&size, &bytes[12], 8);
  size -= more;
  std::memcpy(&bytes[12], &size, 8);
  test::seal(bytes);
  const auto old = read_model(bytes);
  ASSERT_TRUE(old) << old.error().describe();
  EXPECT_FALSE(old->closure_duration);
  model.closure_duration.reset();
  EXPECT_EQ(*old, model);
}

TEST(ModelFile, InvalidModels) {
  const auto broken = [](auto change) {
    Model model = small_model();
    change(model);
    return !validate(model);
  };
  EXPECT_TRUE(broken([](Model& m) { m.controls.clear(); }));
  EXPECT_TRUE(broken([](Model& m) { m.phones.clear(); }));
  EXPECT_TRUE(broken([](Model& m) { m.closure_duration = ClosureDuration{std::nan(""), 0}; }));
  EXPECT_TRUE(broken([](Model& m) { m.closure_duration = ClosureDuration{0, 101}; }));
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

TEST(ModelFile, InvalidParametersOfTheBaselines) {
  const auto broken = [](Method method, auto change) {
    for (Model model : small_models()) {
      if (model.method != method) continue;
      change(model.parameters);
      return !validate(model);
    }
    return false;
  };
  const auto trajectory = [&](auto change) {
    return broken(Method::mmm, [&](Parameters& p) { change(std::get<TrajectoryParameters>(p)); });
  };
  EXPECT_FALSE(trajectory([](TrajectoryParameters&) {}));
  EXPECT_TRUE(trajectory([](TrajectoryParameters& p) { p.states = 0; }));
  EXPECT_TRUE(trajectory([](TrajectoryParameters& p) { p.states = 3; }));
  EXPECT_TRUE(trajectory([](TrajectoryParameters& p) { p.order = 5; }));
  EXPECT_TRUE(trajectory([](TrajectoryParameters& p) { p.smoothness[0] = 0; }));
  EXPECT_TRUE(trajectory([](TrajectoryParameters& p) { p.variance[1] = 0; }));
  EXPECT_TRUE(trajectory([](TrajectoryParameters& p) { p.mean[1] = std::nan(""); }));
  const auto viseme = [&](auto change) {
    return broken(Method::viseme, [&](Parameters& p) { change(std::get<VisemeParameters>(p)); });
  };
  EXPECT_FALSE(viseme([](VisemeParameters&) {}));
  EXPECT_TRUE(viseme([](VisemeParameters& p) { p.place = 1.5; }));
  EXPECT_TRUE(viseme([](VisemeParameters& p) { p.plateau = std::nan(""); }));
  EXPECT_TRUE(viseme([](VisemeParameters& p) { p.poses.pop_back(); }));
  const auto triphone = [&](auto change) {
    return broken(Method::triphone,
                  [&](Parameters& p) { change(std::get<TriphoneParameters>(p)); });
  };
  EXPECT_FALSE(triphone([](TriphoneParameters&) {}));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { p.points = 1; }));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { p.reach = 0.6; }));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { p.curves[0].phone = 2; }));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { p.curves[0].level = CurveLevel(7); }));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { p.curves[0].count = 0; }));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { p.curves[1].values.clear(); }));
  EXPECT_TRUE(triphone([](TriphoneParameters& p) { std::swap(p.curves[0], p.curves[1]); }));
  for (const Model& model : small_models()) {
    EXPECT_TRUE(broken(Method::mean, [&](Parameters& p) { p = model.parameters; }) ||
                model.method == Method::mean);
    Model other = model;
    other.parameters = model.method == Method::mean ? Parameters(AnimemeParameters{})
                                                    : Parameters(MeanParameters{});
    EXPECT_FALSE(validate(other));
  }
}

TEST(ModelFile, OnDisk) {
  const test::TempDir dir;
  const std::filesystem::path path = dir / "a.dam";
  std::vector<std::uint8_t> bytes = write_model(small_model());
  test::write_bytes(path, bytes);
  EXPECT_EQ(*load_model(path), small_model());
  std::filesystem::resize_file(path, std::uintmax_t(1) << 36);  // a hole that nobody has to read
  EXPECT_EQ(load_model(path).error().code, Code::syntax);
  std::filesystem::remove(path);
  EXPECT_EQ(load_model(path).error().code, Code::not_found);
  EXPECT_EQ(load_model(dir.path()).error().code, Code::io);
  EXPECT_EQ(load_model("/dev/zero").error().code, Code::io);
}

}  // namespace model_file_test
}  // namespace animeme::dam
