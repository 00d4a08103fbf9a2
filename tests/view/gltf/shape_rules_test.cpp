// Names of morph targets that only their user knows.
#include "tools/view/gltf/shape_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/view/gltf/shape_names.h"

namespace animeme::gltf {
namespace shape_rules_test {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::vector<ChosenShape> chosen(const std::vector<std::string>& names, const ShapeRules& rules,
                                std::vector<std::string>* notes = nullptr) {
  std::vector<std::string> own;
  return choose_shapes(names, MouthShapes::automatic, notes != nullptr ? *notes : own, rules);
}

const ChosenShape* find(const std::vector<ChosenShape>& shapes, std::string_view name) {
  for (const ChosenShape& shape : shapes) {
    if (shape.name == name) return &shape;
  }
  return nullptr;
}

TEST(ShapeRules, AreReadFromOptions) {
  const auto rule = parse_shape_rule(" Mund = auf = jawOpen ");
  ASSERT_TRUE(rule) << rule.error().message;
  EXPECT_EQ(rule->name, "Mund = auf");
  EXPECT_EQ(rule->meaning, "jawOpen");
  for (const char* wrong : {"", "jaw", "=jawOpen", "jaw="}) {
    const auto none = parse_shape_rule(wrong);
    ASSERT_FALSE(none) << wrong;
    EXPECT_EQ(none.error().code, Code::syntax) << wrong;
  }
  const auto unknown = parse_shape_rule("jaw=knackwurst");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, Code::invalid_argument);
  EXPECT_THAT(unknown.error().message, HasSubstr("knackwurst"));
}

TEST(ShapeRules, AreReadFromTables) {
  const auto rules = read_shape_rules(
      "\xEF\xBB\xBFShape,Meaning\r\n# mouth\r\n\r\nMund, gross,jawOpen\r\nRuhe;-\nPP\tviseme_PP");
  ASSERT_TRUE(rules) << rules.error().describe();
  ASSERT_EQ(rules->size(), 3u);
  EXPECT_EQ((*rules)[0].name, "Mund, gross");
  EXPECT_EQ((*rules)[0].meaning, "jawOpen");
  EXPECT_EQ((*rules)[1].meaning, "-");
  EXPECT_EQ((*rules)[2].meaning, "viseme_PP");
  const auto wrong = read_shape_rules("a,jawOpen\nb,knackwurst\n");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().where.line, 2);
  const auto empty = read_shape_rules("shape,meaning\n");
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, Code::truncated);
}

TEST(ShapeRules, SayWhatUnknownNamesMean) {
  std::vector<std::string> notes;
  const auto shapes =
      chosen({"k1", "k2", "k3", "k4", "k5"},
             {{"K1", "jawOpen"}, {"k2", "mouthSmile"}, {"k3", "viseme_PP"}, {"k4", "-"}}, &notes);
  ASSERT_EQ(shapes.size(), 3u);
  const ChosenShape* const jaw = find(shapes, "k1");
  ASSERT_NE(jaw, nullptr);
  EXPECT_EQ(jaw->meaning.faps, meaning_of("jawOpen")->faps);
  EXPECT_EQ(find(shapes, "k2")->meaning.parts.size(), 2u);
  EXPECT_EQ(find(shapes, "k3")->meaning.viseme, 1);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], HasSubstr("k5"));
  EXPECT_THAT(notes[0], Not(HasSubstr("k4")));
}

// What a user says of a file counts more than what its names say.
TEST(ShapeRules, GoBeforeWhatNamesSay) {
  const std::vector<std::string> names = {
      "jawOpen",   "mouthClose",      "mouthFunnel",    "mouthPucker", "mouthSmileLeft",
      "mouthLeft", "mouthSmileRight", "mouthFrownLeft", "real_jaw",    "grin"};
  const auto plain = chosen(names, {});
  EXPECT_NE(find(plain, "jawOpen"), nullptr);
  const auto ruled = chosen(names, {{"real_jaw", "jawOpen"}, {"grin", "mouthSmile"}});
  EXPECT_NE(find(ruled, "real_jaw"), nullptr);
  EXPECT_EQ(find(ruled, "jawOpen"), nullptr);
  EXPECT_NE(find(ruled, "grin"), nullptr);
  EXPECT_EQ(find(ruled, "mouthSmileLeft"), nullptr);
  EXPECT_NE(find(ruled, "mouthFunnel"), nullptr);
  const auto turned = chosen(names, {{"mouthPucker", "mouthFunnel"}, {"mouthFunnel", "-"}});
  ASSERT_NE(find(turned, "mouthPucker"), nullptr);
  EXPECT_EQ(find(turned, "mouthPucker")->meaning.faps, meaning_of("mouthFunnel")->faps);
  EXPECT_EQ(find(turned, "mouthFunnel"), nullptr);
}

TEST(ShapeRules, NamesThatAreNotThereAreAnsweredByThoseThatAre) {
  EXPECT_TRUE(check_rules({{"b ", "jawOpen"}}, {"a", "B"}));
  const auto missing = check_rules({{"a", "jawOpen"}, {"c", "jawOpen"}}, {"a", "B"});
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Code::not_found);
  EXPECT_THAT(missing.error().message, HasSubstr("\"c\""));
  EXPECT_THAT(missing.error().message, HasSubstr("a, B"));
}

}  // namespace shape_rules_test
}  // namespace animeme::gltf
