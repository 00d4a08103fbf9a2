#include "dam/speaking/conversation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dam/script/timings.h"
#include "dam/script/turns.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/idle_motion.h"

namespace animeme::dam {
namespace conversation_test {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kUnitsOfDegree = 1745.329;  // of FAP angles

/// Words of a second from some times on, in a script of `seconds`.
Script saying(std::initializer_list<double> starts, double seconds,
              const std::string& word = "so") {
  Script script;
  double at = 0;
  const auto add = [&](double until, const char* label, const std::string& text) {
    if (until > at) script.phones.push_back({at, until, label, text});
    at = until;
  };
  for (const double start : starts) {
    add(start, "SIL", "");
    add(start + 0.3, "S", word);
    add(start + 1, "OW", word);
  }
  add(seconds, "SIL", "");
  return script;
}

std::vector<std::pair<double, double>> looks_of(const Attention& attention) {
  std::vector<std::pair<double, double>> all;
  for (const TimedLook& look : attention.looks) all.emplace_back(look.time, look.look.yaw);
  return all;
}

TEST(Conversation, TwoLookAtEachOther) {
  const std::vector<Script> people = {saying({1, 6}, 10), saying({3}, 10)};
  const auto attention = attention_of(people);
  ASSERT_EQ(attention.size(), 2u);
  EXPECT_EQ(looks_of(attention[0]), (std::vector{std::pair(0.0, 26.0)}));
  EXPECT_EQ(looks_of(attention[1]), (std::vector{std::pair(0.0, -26.0)}));
  ASSERT_EQ(attention[1].heard.size(), 2u);
  EXPECT_EQ(attention[1].heard[1].start, 6);
  EXPECT_EQ(attention[1].heard[1].end, 7);
  EXPECT_EQ(attention[0].heard.size(), 1u);
  const std::vector<Script> alone = {people[0]};
  EXPECT_TRUE(attention_of(alone)[0].looks.empty());
}

// In the middle sits who looks to both sides.
TEST(Conversation, WhoListensLooksAtWhoSpeaks) {
  const std::vector<Script> people = {saying({1}, 12), saying({5}, 12), saying({3}, 12)};
  const auto attention = attention_of(people);
  EXPECT_EQ(looks_of(attention[1]), (std::vector{std::pair(0.0, -26.0), std::pair(3.2, 26.0)}))
      << "it speaks to who spoke before";
  EXPECT_EQ(looks_of(attention[0]), (std::vector{std::pair(0.0, 33.0), std::pair(5.2, 26.0)}));
  EXPECT_EQ(looks_of(attention[2]), (std::vector{std::pair(0.0, -33.0), std::pair(5.2, -26.0)}));
}

double mean_of(const Signal& signal, const std::string& name, double from, double to) {
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    if (signal.names[c] != name) continue;
    double sum = 0;
    std::size_t count = 0;
    for (auto i = std::size_t(from * 50); i < std::size_t(to * 50); ++i, ++count)
      sum += signal.values[i * signal.names.size() + c];
    return sum / double(count);
  }
  ADD_FAILURE() << name;
  return 0;
}

/// Degrees to the left that eyes and head of the middle one of three look.
double looks_to(const Signal& signal, double from, double to) {
  return (mean_of(signal, fap_channel(23), from, to) + mean_of(signal, fap_channel(49), from, to)) /
         kUnitsOfDegree;
}

TEST(Conversation, EyesAndHeadTurn) {
  const std::vector<Script> people = {saying({1, 2.2, 3.4}, 14), saying({12.5}, 14),
                                      saying({6, 7.2, 8.4, 9.6}, 14)};
  const auto attention = attention_of(people);
  Signal signal{{50, 1}, 0, {"fap3_open_jaw"}, std::vector<double>(14 * 50, 0.0)};
  const auto moved = add_idle_motion(signal, people[1], {.attention = &attention[1]});
  ASSERT_TRUE(moved) << moved.error().describe();
  EXPECT_LT(looks_to(signal, 1.5, 4), -15);
  EXPECT_GT(looks_to(signal, 7.5, 10), 15);
  EXPECT_LT(mean_of(signal, fap_channel(49), 1.5, 4) / kUnitsOfDegree, -4) << "the head takes part";
  EXPECT_GT(mean_of(signal, fap_channel(49), 7.5, 10) / kUnitsOfDegree, 4);
  // Nothing is different for who is alone.
  Signal alone{{50, 1}, 0, {"fap3_open_jaw"}, std::vector<double>(14 * 50, 0.0)}, same = alone;
  const Attention nobody;
  ASSERT_TRUE(add_idle_motion(alone, people[1]));
  ASSERT_TRUE(add_idle_motion(same, people[1], {.attention = &nobody}));
  EXPECT_EQ(alone.values, same.values);
}

constexpr std::string_view kRttm =
    "SPKR-INFO talk 1 <NA> <NA> <NA> unknown Ann <NA> <NA>\n"
    "SPEAKER talk 1 0.50 2.00 <NA> <NA> Ann <NA> <NA>\n"
    "SPEAKER talk 1 4.00 1.00 <NA> <NA> Ann <NA> <NA>\n"
    "SPEAKER talk 1 2.20 2.80 <NA> <NA> Bob 0.9 <NA>\n";

TEST(Turns, ReadsRttm) {
  const auto turns = read_rttm(kRttm);
  ASSERT_TRUE(turns) << turns.error().describe();
  EXPECT_THAT(*turns, ElementsAre(SpokenTurn{0.5, 2.5, "Ann"}, SpokenTurn{2.2, 5, "Bob"},
                                  SpokenTurn{4, 5, "Ann"}));
  EXPECT_THAT(speakers_of(*turns), ElementsAre("Ann", "Bob"));
}

TEST(Turns, RefusesWhatIsNoRttm) {
  const auto code = [](std::string_view text) { return read_rttm(text).error().code; };
  EXPECT_EQ(code(""), Code::truncated);
  EXPECT_EQ(code("SPEAKER talk 1 0.5 2.0\n"), Code::syntax);
  EXPECT_EQ(code("SPEAKER talk 1 x 2.0 <NA> <NA> Ann <NA> <NA>\n"), Code::syntax);
  EXPECT_EQ(code("SPEAKER talk 1 1 -2.0 <NA> <NA> Ann <NA> <NA>\n"), Code::syntax);
  EXPECT_EQ(code("SPEAKER talk 1 1 90000 <NA> <NA> Ann <NA> <NA>\n"), Code::out_of_range);
  EXPECT_EQ(
      code("SPEAKER a 1 0 1 <NA> <NA> Ann <NA> <NA>\nSPEAKER b 1 0 1 <NA> <NA> Ann <NA> <NA>\n"),
      Code::unsupported);
}

TEST(Turns, PartsAScript) {
  const auto turns = *read_rttm(kRttm);
  const Script script{{{0, 0.6, "SIL", ""},
                       {0.6, 1, "S", "so"},
                       {1, 2.4, "OW", "so"},  // its middle is Ann's
                       {2.4, 2.6, "SIL", ""},
                       {2.6, 3, "AY", "I"},
                       {4.1, 4.4, "N", "no"},  // said by both
                       {4.4, 4.6, "OW", "no"},
                       {6, 6.5, "AH", ""}}};  // nearest to both
  std::string ann, bob;
  for (const Phone& phone : said_by(script, turns, "Ann").phones) ann += phone.label + " ";
  for (const Phone& phone : said_by(script, turns, "Bob").phones) bob += phone.label + " ";
  EXPECT_EQ(ann, "SIL S OW SIL N OW AH ");
  EXPECT_EQ(bob, "SIL AY N OW SIL ");
  EXPECT_EQ(said_by(script, turns, "Bob").duration(), 6.5);
}

TEST(Turns, TogetherTheyAreOneScript) {
  const std::vector<Script> people = {saying({1}, 6, "one"), saying({1.8, 3}, 5, "two")};
  const Script all = said_together(people);
  ASSERT_TRUE(check_script(all)) << check_script(all).error().describe();
  EXPECT_EQ(all.duration(), 6);
  std::string words;
  for (const Phone& phone : all.phones)
    words += phone.word.empty() ? "-" : phone.word[0] == 'o' ? "1" : "2";
  EXPECT_EQ(words, "-1122-22-");
}

Timings everyone(std::string_view text) {
  ScriptOptions options;
  options.everyone = true;
  auto timings = read_timings(text, options);
  EXPECT_TRUE(timings) << timings.error().describe();
  return timings ? *timings : Timings();
}

std::string speakers(const Timings& timings) {
  std::string all;
  for (const TimedLabel& label : timings.labels) {
    if (!label.label.empty()) all += label.speaker + ":" + label.label + " ";
  }
  return all;
}

std::string textgrid(const std::vector<std::pair<std::string, std::string>>& tiers) {
  std::string text = "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n0\n2\n<exists>\n" +
                     std::to_string(tiers.size()) + "\n";
  for (const auto& [name, said] : tiers) {
    text += "\"IntervalTier\" \"" + name + "\" 0 2 2 0 1 \"" + said + "\" 1 2 \"\"\n";
  }
  return text;
}

TEST(Turns, FilesTellWhoSpeaks) {
  EXPECT_EQ(speakers(everyone("WEBVTT\n\n00:00.000 --> 00:02.000\n<v Ann>Hello there\n\n"
                              "00:01.000 --> 00:03.000\n<v Bob>Good day\n")),
            "Ann:Hello there Bob:Good day ");
  EXPECT_EQ(speakers(everyone("talk A 0.5 0.5 hello\ntalk A 1.0 0.5 there\ntalk B 1.2 0.5 yes\n")),
            "A:hello A:there B:yes ");
  EXPECT_EQ(speakers(everyone("talk 1 0.5 0.5 hello\ntalk 1 1.0 0.5 there\n")), ":hello :there ")
      << "one channel is nobody";
  EXPECT_EQ(speakers(everyone(textgrid({{"Ann - words", "hello"}, {"Bob - words", "yes"}}))),
            "Ann:hello Bob:yes ");
  EXPECT_EQ(speakers(everyone(textgrid({{"Ann", "hello there"}, {"Bob", "yes please"}}))),
            "Ann:hello there Bob:yes please ");
  ScriptOptions bob;
  bob.speaker = "bob";
  const auto alone = read_timings(textgrid({{"Ann", "hello there"}, {"Bob", "yes please"}}), bob);
  ASSERT_TRUE(alone) << alone.error().describe();
  EXPECT_EQ(speakers(*alone), "bob:yes please ");
  bob.speaker = "A";
  const auto channel = read_timings("talk A 0.5 0.5 hello\ntalk B 1.2 0.5 yes\n", bob);
  ASSERT_TRUE(channel) << channel.error().describe();
  EXPECT_EQ(speakers(*channel), "A:hello ");
}

}  // namespace conversation_test
}  // namespace animeme::dam
