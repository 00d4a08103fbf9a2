// Commands among lines of text and pieces.
#include "tools/speech/talking/line_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/speech/talking/line_cutter_internal.h"

namespace animeme::speech {
namespace line_command_test {

using testing::HasSubstr;
using Do = LineCommand::Do;
using When = LineCommand::When;

LineCommand good(const std::string& line, bool json = false) {
  auto command = read_line(line, json);
  EXPECT_TRUE(command) << line << ": " << command.error().describe();
  return command ? std::move(*command) : LineCommand{};
}

TEST(LineCommand, ReadsAllOfThem) {
  EXPECT_EQ(good(R"({"do":"stop"})").what, Do::stop);
  EXPECT_EQ(good(R"({"do" : "drop"})").what, Do::drop);
  EXPECT_EQ(good(R"({"do":"end"})").what, Do::end);
  const LineCommand mark = good(R"({"id":"half","do":"mark"})");
  EXPECT_EQ(mark.what, Do::mark);
  EXPECT_EQ(mark.id, "half");
  const LineCommand say =
      good(R"({"do":"say","text":"Ja, b\u00fctte \"so\"","when":"next","id":7})");
  EXPECT_EQ(say.what, Do::say);
  EXPECT_EQ(say.when, When::next);
  EXPECT_EQ(say.id, "7");
  EXPECT_EQ(say.payload, "Ja, bütte \"so\"");
  EXPECT_EQ(good(R"({"do":"say","text":"x"})").when, When::last);
  EXPECT_EQ(good(R"({"do":"say","text":"x","when":"now","id":null})").when, When::now);
}

TEST(LineCommand, LanguagesAndMembersThatNobodyKnows) {
  EXPECT_EQ(good(R"({"do":"say","text":"Ja.","lang":"de"})").language, "de");
  EXPECT_EQ(good(R"({"do":"say","text":"Ja.","language":"de+f3"})").language, "de+f3");
  EXPECT_EQ(good(R"({"do":"say","text":"Yes."})").language, "");
  const auto unknown = read_line(R"({"do":"say","text":"x","volume":3})", false);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("\"volume\""));
  EXPECT_THAT(unknown.error().message, HasSubstr("text, when, lang"));
  EXPECT_FALSE(read_line(R"({"do":"stop","when":"now"})", false));
  EXPECT_FALSE(read_line(R"({"do":"look","target":"away","mood":"joy"})", true));
  // Among pieces, "say" has the members of services.
  EXPECT_EQ(good(R"({"do":"say","audio":"AAAA","status_code":206})", true).what, Do::say);
}

TEST(LineCommand, Moods) {
  const LineCommand mood = good(R"({"do":"mood","mood":"joy:0.6"})");
  EXPECT_EQ(mood.what, Do::mood);
  EXPECT_EQ(*mood.mood, (dam::Mood{"joy", 0.6}));
  EXPECT_EQ(*good(R"({"do":"mood","mood":"Cheerful","intensity":0.5})").mood,
            (dam::Mood{"joy", 0.4}));
  EXPECT_EQ(*good(R"({"do":"mood","mood":{"name":"fear","intensity":1}})").mood,
            (dam::Mood{"fear", 1}));
  EXPECT_TRUE(good(R"({"do":"mood","mood":"neutral"})").mood->neutral());
  EXPECT_EQ(good(R"({"do":"say","text":"x","mood":"sad"})").mood->name, "sadness");
  EXPECT_FALSE(good(R"({"do":"say","text":"x","mood":null})").mood);
  EXPECT_EQ(good(R"({"text":"x","mood":{"name":"bored"}})", true).mood->name, "bored");
  for (const bool json : {false, true}) {
    EXPECT_THAT(read_line(R"({"do":"mood","mood":"joi"})", json).error().message,
                HasSubstr("did you mean joy?"));
    for (const char* wrong :
         {R"({"do":"mood"})", R"({"do":"mood","mood":3})", R"({"do":"mood","mood":{}})",
          R"({"do":"mood","mood":"joy","intensity":"x"})",
          R"({"do":"mood","mood":"joy","intensity":-1})"}) {
      EXPECT_FALSE(read_line(wrong, json)) << wrong;
    }
  }
  EXPECT_FALSE(read_line(R"({"text":"x","mood":"joi"})", true));
}

TEST(LineCommand, Looks) {
  for (const bool json : {false, true}) {
    const LineCommand look = good(R"({"do":"look","target":"20,-5"})", json);
    EXPECT_EQ(look.what, Do::look);
    EXPECT_EQ(look.target.kind, dam::Look::Kind::direction);
    EXPECT_EQ(look.target.yaw, 20);
    EXPECT_EQ(good(R"({"do":"look","target":[20,-5]})", json).target, look.target);
    EXPECT_EQ(good(R"({"do":"look","target":[0.5,0,1]})", json).target.x, 0.5);
    EXPECT_EQ(good(R"({"do":"look","target":"away"})", json).target.kind, dam::Look::Kind::away);
    EXPECT_EQ(good(R"({"do":"listen"})", json).what, Do::listen);
    EXPECT_EQ(good(R"({"do":"think"})", json).what, Do::think);
    EXPECT_EQ(good(R"({"do":"idle"})", json).what, Do::idle);
    for (const char* wrong :
         {R"({"do":"look"})", R"({"do":"look","target":7})", R"({"do":"look","target":"up"})",
          R"({"do":"look","target":[]})", R"({"do":"look","target":["a",1]})",
          R"({"do":"look","target":[70,0]})", R"({"do":"look","target":{"yaw":3}})"}) {
      EXPECT_FALSE(read_line(wrong, json)) << wrong;
    }
  }
}

TEST(LineCommand, HearsOfTheOther) {
  for (const bool json : {false, true}) {
    for (const bool voice : {false, true}) {
      const LineCommand hear =
          good(std::string(R"({"do":"hear","voice":)") + (voice ? "true}" : "false}"), json);
      EXPECT_EQ(hear.what, Do::hear);
      EXPECT_EQ(hear.voice, voice);
    }
    for (const char* wrong : {R"({"do":"hear"})", R"({"do":"hear","voice":1})",
                              R"({"do":"hear","voice":"yes"})", R"({"do":"hear","voice":null})"})
      EXPECT_FALSE(read_line(wrong, json)) << wrong;
  }
}

TEST(LineCommand, AllOtherLinesAreSaid) {
  for (const char* text :
       {"Hello.", "{ is a bracket", "{}", R"({"word": "no text"})", "[1]",
        "{\"what\" to \"do\" now?", "{a \"text\" in braces}", R"(say {"do":"stop"})"}) {
    const LineCommand command = good(text);
    EXPECT_EQ(command.what, Do::say) << text;
    EXPECT_EQ(command.payload, text);
    EXPECT_EQ(command.text, text);
    EXPECT_TRUE(command.id.empty());
  }
}

TEST(LineCommand, ATextIsSaidWithoutDo) {
  const LineCommand say = good(R"({"text":"Ja.","id":"7","lang":"de","when":"next","mood":"joy"})");
  EXPECT_EQ(say.what, Do::say);
  EXPECT_EQ(say.text, "Ja.");
  EXPECT_EQ(say.payload, "Ja.");
  EXPECT_EQ(say.id, "7");
  EXPECT_EQ(say.language, "de");
  EXPECT_EQ(say.when, When::next);
  EXPECT_EQ(say.mood->name, "joy");
  for (const char* wrong :
       {R"({"text":"x","volume":3})", R"({"text":""})", R"({"text":["x"]})", R"({"text": "x")"}) {
    EXPECT_FALSE(read_line(wrong, false)) << wrong;
  }
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(good(mark + R"({"text":"x"})").payload, "x");
  EXPECT_EQ(good(mark + R"({"do":"stop"})").what, Do::stop);
  EXPECT_EQ(good(mark + "Hello.").payload, "Hello.");
}

TEST(LineCommand, PiecesKeepTheirLine) {
  const std::string piece = R"({"id":"a","text":"Hi","words":[{"word":"do","start":0,"end":1}]})";
  const LineCommand said = good(piece, true);
  EXPECT_EQ(said.id, "a");
  EXPECT_EQ(said.text, "Hi");
  EXPECT_EQ(said.payload, piece);
  const std::string next = R"({"do":"say","when":"next","script":"0 1 AA"})";
  EXPECT_EQ(good(next, true).when, When::next);
  EXPECT_EQ(good(next, true).payload, next);
  // Who reads pieces says what is wrong with this one.
  EXPECT_EQ(good(R"({"do":)", true).payload, R"({"do":)");
}

TEST(LineCommand, SaysWhatIsWrong) {
  const auto said = [](const std::string& line) {
    const auto command = read_line(line, false);
    EXPECT_FALSE(command) << line;
    return command ? std::string() : command.error().describe();
  };
  EXPECT_THAT(said(R"({"do":"jump"})"), HasSubstr("say, stop, drop, mark, end"));
  EXPECT_THAT(said(R"({"do":"say","text":"x","when":"soon"})"), HasSubstr("now, next, last"));
  EXPECT_THAT(said(R"({"do":"say"})"), HasSubstr("nothing to say"));
  EXPECT_THAT(said(R"({"do":"say","text":"  "})"), HasSubstr("nothing to say"));
  EXPECT_THAT(said(R"({"do":"say","text":["x"]})"), HasSubstr("\"text\" has to be a text"));
  EXPECT_THAT(said(R"({"do":true})"), HasSubstr("\"do\" has to be a text"));
  EXPECT_THAT(said(R"({"do": "stop")"), HasSubstr("no JSON"));
  EXPECT_THAT(said(R"({"do":"stop","x":)" + std::string(100, '[')), HasSubstr("no JSON"));
}

TEST(LineCutter, KeepsACommandWhole) {
  LineCutter cutter(20, true);
  const std::string command = R"({"do":"say","text":"one two three four five six"})";
  auto lines = cutter.push("  " + command.substr(0, 9));
  EXPECT_TRUE(lines.empty());
  lines = cutter.push(command.substr(9) + "\none two three four five six\n");
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0], command);
  EXPECT_EQ(lines[1], "one two three four");
}

}  // namespace line_command_test
}  // namespace animeme::speech
