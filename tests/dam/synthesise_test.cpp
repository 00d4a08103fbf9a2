#include "dam/speaking/synthesise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dam/signal/closure.h"
#include "dam/signal/fap_signal.h"
#include "dam/training/train.h"
#include "tests/support/shared.h"

namespace animeme::dam {
namespace synthesise_test {

using testing::HasSubstr;

/// Trained once for all tests on the sentences that ship.
class Synthesis : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto corpus = read_corpus(test::data_dir() / "grid_s1_sample");
    ASSERT_TRUE(corpus) << corpus.error().describe();
    sentences = new std::vector<Utterance>(corpus->utterances);
    TrainOptions options;
    options.method = Method::dam_paper;
    options.max_iterations = 2;
    options.animeme.reassign_rounds = 1;
    auto trained = train(*sentences, options);
    ASSERT_TRUE(trained) << trained.error().describe();
    model = new Model(std::move(*trained));
  }
  static void TearDownTestSuite() {
    delete sentences;
    delete model;
  }
  static std::vector<Utterance>* sentences;
  static Model* model;
};
std::vector<Utterance>* Synthesis::sentences = nullptr;
Model* Synthesis::model = nullptr;

Script shifted(Script script, double seconds) {
  for (Phone& p : script.phones) {
    if (p.start > 0) p.start += seconds;
    p.end += seconds;
  }
  return script;
}

TEST_F(Synthesis, ShiftingTheScriptShiftsTheSignal) {
  const Script& script = (*sentences)[3].script;
  const auto a = synthesise(*model, script), b = synthesise(*model, shifted(script, 0.4));
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->frames() + 10, b->frames());
  for (std::size_t i = 3; i < a->frames(); ++i)
    for (std::size_t c = 0; c < a->names.size(); ++c)
      EXPECT_NEAR(a->at(i, c), b->at(i + 10, c), 1e-6);
}

TEST_F(Synthesis, AnyFrameRateGivesTheSameCurve) {
  const Script& script = (*sentences)[5].script;
  SynthesisOptions options;
  options.closure = false;
  const auto slow = synthesise(*model, script, options);
  options.rate = {100, 1};
  const auto fast = synthesise(*model, script, options);
  ASSERT_TRUE(slow && fast);
  for (std::size_t i = 3; i + 5 < slow->frames(); ++i)
    EXPECT_NEAR(slow->at(i, 0), fast->at(4 * i, 0), 1e-6);
  options.rate = {30000, 1001};
  EXPECT_EQ(synthesise(*model, script, options)->frames(),
            std::size_t(std::ceil(script.duration() * 30000 / 1001)));
}

TEST_F(Synthesis, BeginsAndEndsAtRestWithClosedLips) {
  for (const bool short_pauses : {false, true}) {
    Script script = (*sentences)[2].script;
    if (short_pauses) {  // speech from the first to the last instant
      const double start = script.phones[1].start;
      script.phones.erase(script.phones.begin());
      script.phones.pop_back();
      for (Phone& p : script.phones) {
        p.start -= start;
        p.end -= start;
      }
    }
    const auto signal = synthesise(*model, script);
    ASSERT_TRUE(signal);
    const auto lips = inner_lip_channels(signal->names);
    ASSERT_TRUE(lips);
    for (const std::size_t frame : {std::size_t(0), signal->frames() - 1}) {
      EXPECT_LT(std::abs(inner_gap(*signal, frame, *lips)), 30);
      for (std::size_t c = 0; c < signal->names.size(); ++c)
        EXPECT_NEAR(signal->at(frame, c), model->controls[c].rest, 1e-9);
    }
  }
}

TEST_F(Synthesis, LongPausesRest) {
  Script script = {{{0, 0.5, "SIL", ""},
                    {0.5, 0.7, "AY", ""},
                    {0.7, 2.7, "SIL", ""},
                    {2.7, 2.9, "AY", ""},
                    {2.9, 3.4, "SIL", ""}}};
  const auto signal = synthesise(*model, script);
  ASSERT_TRUE(signal);
  for (std::size_t i = 26; i <= 59; ++i)
    EXPECT_NEAR(signal->at(i, 0), model->controls[0].rest, 1e-9);
  EXPECT_GT(std::abs(signal->at(15, 0) - model->controls[0].rest), 20);
}

TEST_F(Synthesis, SilenceAloneIsRest) {
  const auto signal = synthesise(*model, {{{0, 1, "SIL", ""}}});
  ASSERT_TRUE(signal);
  EXPECT_EQ(signal->frames(), 25u);
  for (std::size_t i = 0; i < signal->frames(); ++i)
    EXPECT_EQ(signal->at(i, 3), model->controls[3].rest);
}

TEST_F(Synthesis, BilabialsCloseTheLips) {
  SynthesisOptions options;
  std::size_t open_without = 0, constrained = 0;
  for (const Utterance& u : *sentences)
    for (const bool closure : {false, true}) {
      options.closure = closure;
      SynthesisReport report;
      const auto signal = synthesise(*model, u.script, options, &report);
      ASSERT_TRUE(signal);
      const auto lips = inner_lip_channels(signal->names);
      constrained += report.closures;
      for (const Phone& p : u.script.phones) {
        if (!is_bilabial(p.label)) continue;
        const FrameSpan span = frames_near(*signal, p, 0.04);
        double least = 1e9;
        for (std::size_t i = span.first; i < span.last; ++i)
          least = std::min(least, inner_gap(*signal, i, *lips));
        if (!closure) {
          open_without += least > model->closure_gap ? 1 : 0;
        } else {
          EXPECT_LE(least, model->closure_gap + 1e-6) << u.id << " " << p.label;
        }
      }
    }
  EXPECT_EQ(constrained, open_without);
}

TEST_F(Synthesis, ModesAreReported) {
  SynthesisReport report;
  ASSERT_TRUE(synthesise(*model, (*sentences)[0].script, {}, &report));
  EXPECT_EQ(report.modes.size(), report.phones);
  EXPECT_GT(report.phones, 10u);
}

TEST_F(Synthesis, UnknownPhonesAreSpokenByRelatives) {
  ASSERT_LT(model->find_phone("OY"), 0);
  ASSERT_LT(model->find_phone("HH"), 0);
  const Script script = {{{0, 0.4, "SIL", ""},
                          {0.4, 0.5, "HH", ""},
                          {0.5, 0.6, "EH", ""},
                          {0.6, 0.7, "L", ""},
                          {0.7, 1.0, "OY", ""},
                          {1.0, 1.4, "SIL", ""}}};
  SynthesisReport report;
  const auto signal = synthesise(*model, script, {}, &report);
  ASSERT_TRUE(signal) << signal.error().describe();
  EXPECT_EQ(report.replaced_phones, 2u);
  EXPECT_THAT(report.replaced, testing::Contains(testing::Pair("OY", "AO IH")));
  EXPECT_THAT(report.replaced, testing::Contains(testing::Pair("HH", "EH")));
}

TEST_F(Synthesis, PhonesWithoutRelativesAreAnError) {
  Model poor = *model;
  const auto silence = std::size_t(poor.find_phone("SIL"));
  auto& phones = std::get<AnimemeParameters>(poor.parameters).phones;
  phones = {phones[silence]};
  phones[0].contexts.clear();
  poor.phones = {poor.phones[silence]};
  ASSERT_TRUE(validate(poor));
  const auto signal = synthesise(poor, {{{0, 0.5, "SIL", ""}, {0.5, 0.7, "AY", ""}}});
  ASSERT_FALSE(signal);
  EXPECT_EQ(signal.error().code, Code::not_found);
  EXPECT_THAT(signal.error().message, HasSubstr("AY at 0.5"));
}

TEST_F(Synthesis, StyleScalesTheDeviationFromRest) {
  SynthesisOptions options;
  options.closure = false;
  const Script& script = (*sentences)[1].script;
  const auto plain = synthesise(*model, script, options);
  options.style = 0.4;
  const auto faint = synthesise(*model, script, options);
  options.style = 0;
  const auto still = synthesise(*model, script, options);
  ASSERT_TRUE(plain && faint && still);
  for (std::size_t i = 0; i < plain->frames(); ++i)
    for (std::size_t c = 0; c < plain->names.size(); ++c) {
      const double rest = model->controls[c].rest;
      EXPECT_NEAR(faint->at(i, c) - rest, 0.4 * (plain->at(i, c) - rest), 1e-9);
      EXPECT_EQ(still->at(i, c), rest);
    }
}

TEST_F(Synthesis, LipsCloseInEveryStyle) {
  const Script script{{{0, 0.5, "SIL", ""},
                       {0.5, 0.6, "AA", ""},
                       {0.6, 0.64, "B", ""},
                       {0.64, 0.8, "AA", ""},
                       {0.8, 1.2, "SIL", ""}}};
  SynthesisOptions options;
  for (const double style : {0.3, 1.0, 1.5}) {
    options.style = style;
    const auto signal = synthesise(*model, script, options);
    ASSERT_TRUE(signal);
    const auto lips = inner_lip_channels(signal->names);
    double least = 1e9;
    for (std::size_t i = 13; i < 18; ++i) least = std::min(least, inner_gap(*signal, i, *lips));
    EXPECT_LE(least, model->closure_gap + 1e-9) << style;
  }
}

TEST_F(Synthesis, DrawnOutSoundsHoldTheirMiddle) {
  const auto sung = [](double seconds) {
    return Script{{{0, 0.5, "SIL", ""},
                   {0.5, 0.6, "S", ""},
                   {0.6, 0.6 + seconds, "AY", ""},
                   {0.6 + seconds, 0.7 + seconds, "T", ""},
                   {0.7 + seconds, 1.2 + seconds, "SIL", ""}}};
  };
  const double longest = model->phones[std::size_t(model->find_phone("AY"))].longest;
  SynthesisOptions options;
  options.rate = {100, 1};
  const auto long_one = synthesise(*model, sung(longest + 3), options);
  ASSERT_TRUE(long_one);
  const std::size_t jaw = std::size_t(model->find_control("fap3_open_jaw"));
  // Far from both ends the mouth stands still, as open as in the middle of the sound.
  const auto at = [&](double time) {
    return long_one->at(std::size_t(std::lround(time * 100)), jaw);
  };
  const double middle = 0.6 + (longest + 3) / 2;
  EXPECT_NEAR(at(middle - 0.5), at(middle), 1e-6);
  EXPECT_NEAR(at(middle + 0.5), at(middle), 1e-6);
  // And the ends keep the pace of a sound of ordinary length.
  const auto shorter = synthesise(*model, sung(longest + 2), options);
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_NEAR(shorter->at(i, jaw), long_one->at(i, jaw), 1e-6);
}

TEST_F(Synthesis, HostileScriptsAndOptions) {
  const Script good = (*sentences)[0].script;
  EXPECT_FALSE(synthesise(*model, {}));
  EXPECT_FALSE(synthesise(*model, {{{0, std::nan(""), "AY", ""}}}));
  EXPECT_FALSE(synthesise(*model, {{{0.5, 0.4, "AY", ""}}}));
  EXPECT_FALSE(synthesise(*model, {{{0, 0.4, "xx", ""}}}));
  SynthesisOptions options;
  options.rate = {0, 1};
  EXPECT_FALSE(synthesise(*model, good, options));
  options.rate = {100000, 1};
  EXPECT_FALSE(synthesise(*model, good, options));
  options = {};
  options.frames = std::size_t(-1) >> 4;
  EXPECT_EQ(synthesise(*model, good, options).error().code, Code::out_of_range);
  options = {};
  options.context_weight = std::nan("");
  EXPECT_FALSE(synthesise(*model, good, options));
  for (const double sharpness : {-0.1, 3.1, std::nan("")}) {
    options = {};
    options.sharpness = sharpness;
    EXPECT_FALSE(synthesise(*model, good, options));
  }
  for (const double style : {-0.1, 1.6, std::nan("")}) {
    options = {};
    options.style = style;
    EXPECT_FALSE(synthesise(*model, good, options));
  }
  options = {};
  options.frames = 1;
  EXPECT_EQ(synthesise(*model, good, options)->frames(), 1u);
}

TEST(Closure, LastsAsLongAsItShouldAtAnyRate) {
  const Script script = {{{0, 0.4, "AE", ""}, {0.4, 0.5, "P", ""}, {0.5, 1, "AE", ""}}};
  for (const std::uint32_t fps : {25u, 60u, 100u, 240u}) {
    Signal signal;
    signal.rate = {fps, 1};
    signal.names = {"fap4_lower_t_midlip", "fap5_raise_b_midlip"};
    for (std::uint32_t i = 0; i < fps; ++i) {  // a V that is below 45 for 27 ms
      const double gap = 5 + 3000 * std::abs(double(i) / fps - 0.44);
      signal.values.insert(signal.values.end(), {-gap / 2, -gap / 2});
    }
    const auto lips = inner_lip_channels(signal.names);
    const auto shut_ms = [&] {
      const auto span = closed_span(signal, script.phones[1], *lips, 0.2);
      return span ? 1000 * span->frames() / fps : 0.0;
    };
    EXPECT_LT(shut_ms(), 32) << fps;
    ClosureOptions options;
    options.target = 10;
    apply_closure(signal, script, options);
    EXPECT_LT(shut_ms(), 45) << fps << ": no time was asked for";
    options.duration = ClosureDuration{0.05, 0.4};  // 90 ms
    apply_closure(signal, script, options);
    EXPECT_NEAR(shut_ms(), 90, fps == 25 ? 15 : 5) << fps;
    EXPECT_LT(inner_gap(signal, std::size_t(0.44 * fps), *lips), 45);
    EXPECT_NEAR(inner_gap(signal, 0, *lips), 5 + 3000 * 0.44, 1e-9);  // far away nothing happens
    const auto once = signal.values;
    apply_closure(signal, script, {.target = 10, .duration = ClosureDuration{0.03, 0.1}});
    EXPECT_EQ(signal.values, once) << "what is shut for longer stays";
  }
  EXPECT_EQ((ClosureDuration{-1, 0}.of(0.1)), 0);
  EXPECT_EQ((ClosureDuration{0, 10}.of(5)), kLongestClosure);
}

TEST(Closure, MovesUpperAndLowerLipTowardsEachOther) {
  Signal signal;
  signal.rate = {100, 1};
  signal.names = {"fap4_lower_t_midlip",  "fap5_raise_b_midlip",    "fap8_lower_t_lip_lm",
                  "fap10_raise_b_lip_lm", "fap51_lower_t_midlip_o", "fap52_raise_b_midlip_o"};
  for (int i = 0; i < 100; ++i)
    signal.values.insert(signal.values.end(), {-50.0, -75.0, -10.0, -5.0, 0.0, 0.0});
  const Script script = {{{0, 0.4, "SIL", ""}, {0.4, 0.5, "P", ""}, {0.5, 1, "SIL", ""}}};
  Signal closed = signal;
  EXPECT_EQ(apply_closure(closed, script), 1u);
  const auto lips = inner_lip_channels(closed.names);
  double least = 1e9;
  std::size_t at = 0;
  for (std::size_t i = 0; i < 100; ++i)
    if (inner_gap(closed, i, *lips) < least) least = inner_gap(closed, at = i, *lips);
  EXPECT_NEAR(least, 25, 1e-9);
  EXPECT_NEAR(closed.at(at, 0), -50 + 30, 1e-9);  // 30 % and 70 % of 125 - 25
  EXPECT_NEAR(closed.at(at, 1), -75 + 70, 1e-9);
  EXPECT_EQ(closed.at(at, 2), -10);  // that side is closed already
  EXPECT_GT(closed.at(at, 4), 0);    // the outer contour follows, less than the inner one
  EXPECT_LT(closed.at(at, 4), 30);
  EXPECT_EQ(closed.at(20, 0), -50);  // far away nothing happens
  signal.names[0] = "other";
  EXPECT_EQ(apply_closure(signal, script), 0u);
}

TEST(Contact, LipsStopWhereTheyMeet) {
  Signal signal;
  signal.names = {"fap4_a", "fap5_b", "fap51_c", "fap52_d"};
  signal.values = {-50, -60, 1,  2,   // open by 110
                   40,  60,  10, 20,  // overlapping by 100
                   10,  5,   3,  4};  // pressed together by 15: allowed
  EXPECT_EQ(apply_contact(signal), 1u);
  const LipChannels lips{0, 1};
  EXPECT_DOUBLE_EQ(inner_gap(signal, 0, lips), 110);
  EXPECT_DOUBLE_EQ(inner_gap(signal, 1, lips), -15);
  EXPECT_DOUBLE_EQ(inner_gap(signal, 2, lips), -15);
  EXPECT_DOUBLE_EQ(signal.at(1, 0), 40 - 42.5);
  EXPECT_DOUBLE_EQ(signal.at(1, 1), 60 - 42.5);
  EXPECT_LT(signal.at(1, 2), 10);
  EXPECT_LT(signal.at(1, 3), 20);
  EXPECT_DOUBLE_EQ(signal.at(2, 2), 3);
}

TEST(FapSignal, ChannelNames) {
  EXPECT_EQ(fap_channel(3), "fap3_open_jaw");
  EXPECT_EQ(fap_of_channel("fap3_open_jaw"), 3);
  EXPECT_EQ(fap_of_channel("fap68"), 68);
  for (const char* name : {"fap", "fap0_x", "fap69_x", "fap3x", "jawOpen", "fap-3_x", ""})
    EXPECT_EQ(fap_of_channel(name), 0) << name;
}

TEST(FapSignal, ThereAndBack) {
  Signal signal;
  signal.rate = {30, 1};
  signal.names = {"fap3_open_jaw", "smile", "fap52_raise_b_midlip_o"};
  signal.values = {1.5, 9, -2.4, 1e9, 9, -2.5};
  const auto clip = to_sequence(signal);
  ASSERT_TRUE(clip);
  EXPECT_EQ(clip->frames[0].value[3], 2);
  EXPECT_EQ(clip->frames[0].value[52], -2);
  EXPECT_EQ(clip->frames[1].value[52], -3);
  EXPECT_EQ(clip->frames[1].value[3], 1080 * 4);  // clipped to what can be coded
  EXPECT_EQ(clip->frames[1].number, 1);
  EXPECT_FALSE(clip->frames[0].mask[4]);
  const auto back = to_signal(*clip);
  ASSERT_TRUE(back);
  EXPECT_THAT(back->names, testing::ElementsAre("fap3_open_jaw", "fap52_raise_b_midlip_o"));
  EXPECT_EQ(back->at(1, 1), -3);
  signal.names = {"a", "b", "c"};
  EXPECT_EQ(to_sequence(signal).error().code, Code::not_found);
  signal.names = {"fap3_open_jaw", "fap3", "c"};
  EXPECT_FALSE(to_sequence(signal));
}

TEST(FapSignal, AbsentFapsAndSkippedFramesKeepTheirValue) {
  fap::Sequence clip;
  clip.frames.resize(2);
  clip.frames[0].number = 0;
  clip.frames[0].set(3, 5);
  clip.frames[1].number = 3;
  clip.frames[1].set(4, 7);
  const auto signal = to_signal(clip);
  ASSERT_TRUE(signal);
  EXPECT_THAT(signal->values, testing::ElementsAre(5, 0, 5, 0, 5, 0, 5, 7));
  EXPECT_THAT(signal->measured, testing::ElementsAre(true, false, false, true));
  clip.frames[1].number = std::int64_t(1) << 60;
  EXPECT_EQ(to_signal(clip).error().code, Code::out_of_range);
}

TEST(LipTooth, RaisesTheLowerLipButKeepsTheLipsApart) {
  Signal signal;
  signal.rate = {100, 1};
  signal.names = {"fap4_lower_t_midlip", "fap5_raise_b_midlip", "fap52_raise_b_midlip_o"};
  for (int i = 0; i < 60; ++i) signal.values.insert(signal.values.end(), {-100, -200, -180});
  const Script script{{{0, 0.2, "SIL", ""}, {0.2, 0.3, "F", ""}, {0.3, 0.6, "AA", ""}}};
  Signal moved = signal;
  EXPECT_EQ(apply_lip_tooth_contact(moved, script, -60), 1u);
  double highest = -1e9;
  for (std::size_t i = 0; i < 60; ++i) highest = std::max(highest, moved.at(i, 1));
  EXPECT_NEAR(highest, -60, 1);
  EXPECT_EQ(moved.at(50, 1), -200);                            // far from the phone nothing moves
  EXPECT_GT(moved.at(25, 2), -180);                            // the outer contour follows
  EXPECT_EQ(moved.at(25, 0), -100);                            // the upper lip does not
  EXPECT_EQ(apply_lip_tooth_contact(moved, script, -70), 0u);  // is there already
  Signal far = signal;
  EXPECT_EQ(apply_lip_tooth_contact(far, script, 300), 1u);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_GE(-(far.at(i, 0) + far.at(i, 1)), kLeastOpen - 1e-9);
}

TEST(Synthesise, ModelsWithoutSilenceRestInPauses) {
  // Of method dam, whose curves look at the phones beside: a pause that is not there must not be
  // looked at.
  Model model;
  model.method = Method::dam;
  model.controls = {{"a", 0, 0, 1}};
  model.phones = {{"AA", 20, 8, 0.1, 0.4}};
  RefinedParameters parameters;
  parameters.dominance = {{}};
  for (const RefinedTerm term : {RefinedTerm::phone, RefinedTerm::class_left_2})
    parameters.tables.push_back({term, 1, {0}, {1.0F}});
  model.parameters = parameters;
  ASSERT_TRUE(validate(model));
  const Script script{
      {{0, 0.3, "SIL", ""}, {0.3, 0.4, "AA", ""}, {0.4, 0.8, "SIL", ""}, {0.8, 1, "AA", ""}}};
  const auto signal = synthesise(model, script);
  ASSERT_TRUE(signal) << signal.error().describe();
  for (const double value : signal->values) EXPECT_LE(std::abs(value), 2);
}

}  // namespace synthesise_test
}  // namespace animeme::dam
