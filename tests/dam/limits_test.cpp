#include "dam/signal/limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "dam/signal/arkit_signal.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "dam/training/train.h"
#include "tests/dam/dam_support.h"

namespace animeme::dam {
namespace limits_test {

using ::testing::HasSubstr;

Signal signal_of(std::vector<std::string> names, std::vector<double> values) {
  Signal signal;
  signal.rate = {25, 1};
  signal.names = std::move(names);
  signal.values = std::move(values);
  return signal;
}

TEST(Limits, NamesTellThoseOfArkit) {
  const auto limits = natural_limits(std::vector<std::string>{
      "JawOpen", "mouthSmile_L", "mouthFrown_L", "headYaw", "fap3_open_jaw", "snout", "jawLeft"});
  ASSERT_EQ(limits.size(), 7u);
  EXPECT_EQ(limits[0], (ControlLimit{0, 1, -1, 0}));
  EXPECT_EQ(limits[1], (ControlLimit{0, 1, 2, kSharedByShapes}));
  EXPECT_EQ(limits[2], (ControlLimit{0, 1, 1, kSharedByShapes}));
  for (const std::size_t angle_or_other : {3u, 4u, 5u}) EXPECT_TRUE(limits[angle_or_other].free());
  EXPECT_EQ(limits[6].opposite, -1) << "its opposite is not there";
  EXPECT_TRUE(settled(natural_limits(std::vector<std::string>{"fap3", "snout"})).empty());
}

TEST(Limits, ValuesAreWithinAndPairsDoNotFight) {
  Signal signal = signal_of({"a", "left", "right", "free"}, {-0.5, 0.3, 0.7, -9,    //
                                                             1.5, 0.7, 0.3, 9,      //
                                                             0.25, -0.2, 0.4, 0.5,  //
                                                             1, 0.12, 0.1, 0});
  const std::vector<ControlLimit> limits = {{0, 1, -1, 0}, {0, 1, 2, 0.1}, {0, 1, 1, 0.1}, {}};
  apply_limits(signal, limits);
  const std::vector<double> wanted = {0,    0.1, 0.5, -9,  1, 0.5,  0.1, 9,
                                      0.25, 0,   0.4, 0.5, 1, 0.12, 0.1, 0};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_NEAR(signal.values[i], wanted[i], 1e-12) << i;
  const Signal once = signal;
  apply_limits(signal, limits);
  EXPECT_EQ(signal.values, once.values);
  apply_limits(signal, {});
  EXPECT_EQ(signal.values, once.values);
}

TEST(Limits, TablesNameControls) {
  const std::vector<std::string> names = {"jawOpen", "snout",     "up",
                                          "down",    "mouthLeft", "mouthRight"};
  const auto limits = read_limits(
      "control\tlow\thigh\topposite\n"
      "snout\t-2\t\t\n"
      "up\t0\t10\tdown\n"
      "of another take\t0\t1\t\n"
      "mouthLeft\t\t0.5\t\n",
      names);
  ASSERT_TRUE(limits) << limits.error().describe();
  constexpr double kNone = std::numeric_limits<double>::infinity();
  EXPECT_EQ((*limits)[0], (ControlLimit{0, 1, -1, 0})) << "not in the table, but known";
  EXPECT_EQ((*limits)[1], (ControlLimit{-2, kNone, -1, 0}));
  EXPECT_EQ((*limits)[2], (ControlLimit{0, 10, 3, 0}));
  EXPECT_EQ((*limits)[3].opposite, 2);
  EXPECT_EQ((*limits)[4], (ControlLimit{-kNone, 0.5, -1, 0})) << "a row says it all";
  EXPECT_EQ((*limits)[5], (ControlLimit{0, 1, -1, 0}));
  const auto commas = read_limits("high,control\n3,snout\n", names);
  ASSERT_TRUE(commas);
  EXPECT_EQ((*commas)[1], (ControlLimit{-kNone, 3, -1, 0}));
}

TEST(Limits, TablesThatAreWrongSayWhere) {
  const std::vector<std::string> names = {"a", "b", "c"};
  const auto fails = [&](std::string_view text, Code code, std::int64_t line, const char* what) {
    const auto limits = read_limits(text, names);
    ASSERT_FALSE(limits) << text;
    EXPECT_EQ(limits.error().code, code) << text;
    EXPECT_EQ(limits.error().where.line, line) << text;
    EXPECT_THAT(limits.error().message, HasSubstr(what));
  };
  fails("", Code::truncated, 0, "empty");
  fails("name,low\na,1\n", Code::syntax, 1, "begins with the columns");
  fails("control\na\n", Code::syntax, 1, "begins with the columns");
  fails("control,low,high\na,1\n", Code::syntax, 2, "fields");
  fails("control,low\n\na,x\n", Code::syntax, 3, "no");
  fails("control,low\na,nan\n", Code::syntax, 2, "not a number");
  fails("control,low,high\na,2,1\n", Code::invalid_argument, 2, "above");
  fails("control,low\na,0\na,1\n", Code::invalid_argument, 3, "two rows");
  fails("control,opposite\na,a\n", Code::invalid_argument, 2, "opposites");
  fails("control,opposite\na,b\nb,c\n", Code::invalid_argument, 3, "opposites");
}

/// Sentences in which the lip of AA goes to `top`, its opposite stays at `other`.
std::vector<Utterance> sentences(const std::string& name, const std::string& opposite, double top,
                                 double other) {
  test::Uniform random(7);
  std::vector<Utterance> all;
  for (int i = 0; i < 20; ++i) {
    Utterance u;
    u.id = "s" + std::to_string(i);
    u.script = test::random_script(random, {"AA", "M", "T"}, 12);
    u.signal = signal_of({name, opposite}, {});
    u.signal.rate = {50, 1};
    for (int f = 0; f < int(u.script.duration() * 50); ++f) {
      double value = 0;
      for (const Phone& p : u.script.phones)
        if (p.label == "AA" && f / 50.0 >= p.start && f / 50.0 < p.end) value = top;
      u.signal.values.insert(u.signal.values.end(), {value, value > 0 ? other : other / 2});
    }
    all.push_back(std::move(u));
  }
  return all;
}

TEST(Limits, TrainingFindsThemAndSpeakingKeepsThem) {
  for (const Method method : {Method::dam, Method::dam_paper, Method::mmm, Method::triphone}) {
    TrainOptions options;
    options.method = method;
    const auto model = train(sentences("jawOpen", "rigChannel", 1, 0.5), options);
    ASSERT_TRUE(model) << model.error().describe();
    ASSERT_EQ(model->limits.size(), 2u);
    EXPECT_EQ(model->limits[0], (ControlLimit{0, 1, -1, 0}));
    EXPECT_EQ(model->limits[1], (ControlLimit{0, 1, -1, 0})) << "never left 0..1";
    SynthesisOptions loud;
    loud.style = 1.5;
    test::Uniform random(3);
    const Script script = test::random_script(random, {"AA", "M", "T"}, 40);
    const auto signal = synthesise(*model, script, loud);
    ASSERT_TRUE(signal);
    const auto [low, high] = std::minmax_element(signal->values.begin(), signal->values.end());
    EXPECT_GE(*low, 0);
    EXPECT_LE(*high, 1);
    Model free = *model;
    free.limits.clear();
    const auto wild = synthesise(free, script, loud);
    EXPECT_GT(*std::max_element(wild->values.begin(), wild->values.end()), 1)
        << "or nothing is tested";
    const auto read = read_model(write_model(*model));
    ASSERT_TRUE(read) << read.error().describe();
    EXPECT_EQ(*read, *model);
  }
}

TEST(Limits, OfDataAreNotThoseOfFapsNorOfLargeValues) {
  const auto model = train(sentences("fap3_open_jaw", "rig", 0.9, 1.5));
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->limits.empty());
}

TEST(Limits, PairsAreThoseThatAreApartInTheData) {
  const auto together = train(sentences("mouthLeft", "mouthRight", 0.8, 0.4));
  ASSERT_TRUE(together);
  EXPECT_EQ(together->limits[0].opposite, -1);
  const auto apart = train(sentences("mouthLeft", "mouthRight", 0.8, 0.001));
  ASSERT_TRUE(apart);
  EXPECT_EQ(apart->limits[0].opposite, 1);
}

TEST(Limits, ModelsWithImpossibleOnesAreRefused) {
  auto model = train(sentences("mouthLeft", "mouthRight", 0.8, 0.001));
  ASSERT_TRUE(model);
  const auto refused = [&](const auto& change) {
    Model bad = *model;
    change(bad.limits);
    EXPECT_FALSE(validate(bad));
    EXPECT_FALSE(read_model(write_model(bad)));
  };
  Model more = *model;
  more.limits.push_back({});
  EXPECT_FALSE(validate(more));
  EXPECT_TRUE(validate(*model));
  refused([](auto& limits) { limits[0].low = 2; });
  refused([](auto& limits) { limits[0].opposite = 0; });
  refused([](auto& limits) { limits[0].opposite = 5; });
  refused([](auto& limits) { limits[1].opposite = -1; });
  refused([](auto& limits) { limits[1].shared = 0.5; });
  refused([](auto& limits) { limits[0].high = std::numeric_limits<double>::quiet_NaN(); });
}

TEST(ArkitSignal, BecomesFaps) {
  const Signal signal =
      signal_of({"JawOpen", "other", "jawOpen", "EyeBlink_L"}, {0, 1, 1, 0, 0.5, 1, 1, 1});
  const auto layout = find_arkit_layout(signal.names);
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->has.count(), 2u);
  EXPECT_EQ(layout->channel[1], -1);
  EXPECT_EQ(layout->channel[2], -1) << "the first counts";
  const auto clip = to_sequence(signal);
  ASSERT_TRUE(clip) << clip.error().describe();
  ASSERT_EQ(clip->frames.size(), 2u);
  fap::ArkitFrame weights{};
  weights[std::size_t(*fap::find_arkit("jawOpen"))] = 0.5;
  weights[std::size_t(*fap::find_arkit("eyeBlinkLeft"))] = 1;
  EXPECT_EQ(clip->frames[1].value, fap::arkit_to_fap(weights, layout->has).value);
  EXPECT_EQ(clip->frames[0].value[3], 0);
  EXPECT_FALSE(find_arkit_layout(std::vector<std::string>{"a", "fap3_open_jaw"}));
  EXPECT_FALSE(to_sequence(signal_of({"a"}, {1})));
  EXPECT_EQ(
      to_sequence(signal_of({"jawOpen"}, {std::numeric_limits<double>::infinity()})).error().code,
      Code::invalid_argument);
  // A FAP beside it: shapes are left out, as all that is none.
  EXPECT_EQ(to_sequence(signal_of({"jawOpen", "fap4"}, {1, 7}))->frames[0].mask.count(), 1u);
}

TEST(ArkitSignal, NamesAreSpelledAsItsOwn) {
  const int blink = *fap::find_arkit("eyeBlinkLeft");
  EXPECT_EQ(arkit_spelling(blink, std::vector<std::string>{"jawOpen"}), "eyeBlinkLeft");
  EXPECT_EQ(arkit_spelling(blink, std::vector<std::string>{"JawOpen"}), "EyeBlinkLeft");
  EXPECT_EQ(arkit_spelling(blink, std::vector<std::string>{"jawOpen", "mouthSmile_R"}),
            "eyeBlink_L");
}

}  // namespace limits_test
}  // namespace animeme::dam
