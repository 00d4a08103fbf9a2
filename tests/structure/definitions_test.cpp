// One definition a name, over all files of the tree. The compiler's own word on it, with what is in
// the types, takes minutes: preset odr.
#include "tests/structure/definitions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/structure/tree.h"

namespace animeme::test {
namespace definitions_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(Structure, NoNameIsDefinedInTwoFiles) {
  std::vector<std::pair<std::string, std::string>> code;
  std::size_t names = 0;
  for (const SourceFile& file : tree()) {
    if (!is_code(file.path)) continue;
    code.emplace_back(file.path, file.text);
    names += definitions_in(file.text).size();
  }
  EXPECT_GT(names, 2000u);
  EXPECT_THAT(double_definitions(code), IsEmpty());
}

TEST(StructureRules, DefinitionsAreFound) {
  EXPECT_THAT(
      definitions_in(
          "namespace a::b {\nclass Later;\nstruct One { struct In {}; int f() { return 1; } };\n"
          "enum class Two : int { x = '}', y };\ntemplate <class T = int>\nunion Three { T t; };\n"
          "namespace { struct Own {}; void own() {} }\nstatic int alone() { return 0; }\n"
          "inline constexpr int kNumber = 1'000;\nconstexpr int kOwn{2};\n"
          "std::vector<std::pair<int, int>> pairs(const fap::Frame& frame, int n = 2);\n"
          "std::vector<std::pair<int, int>> pairs(const fap::Frame& frame, int n) { return {}; }\n"
          "bool operator<(One a, One b) { return \"{\" < R\"x({)x\"; }  // {\n"
          "One::One(int a) : a_{a}, b_{a} {}\nOne::~One() {}\n#define BRACE {\n"
          "template <> struct Three<int> {};\n}\nextern \"C\" {\nint c(void) { return 0; }\n}\n"),
      ElementsAre("a::b::One", "a::b::Two", "a::b::Three", "a::b::kNumber",
                  "a::b::pairs(const Frame&,int)", "a::b::operator<(One,One)", "a::b::Three<int>",
                  "c(void)"));
  EXPECT_THAT(definitions_in("namespace a {\nstruct B {};\n"), ElementsAre("a::B", "?"));
}

TEST(StructureRules, DoubleDefinitionsFire) {
  const std::string one = "namespace animeme {\nstruct Track { int a; };\n}\n";
  const std::string other = "namespace animeme {\nclass Track { long b; };\n}\n";
  const auto found = [&](const char* a, const char* b) {
    return double_definitions({{a, one}, {b, other}});
  };
  EXPECT_THAT(found("fap/a.h", "tools/formats/media/detail/b.cpp"),
              ElementsAre("animeme::Track: fap/a.h, tools/formats/media/detail/b.cpp"));
  EXPECT_THAT(found("fap/a.h", "tests/fap/b_test.cpp"), SizeIs(1));
  EXPECT_THAT(found("tests/support/a.h", "tests/fap/b_test.cpp"), SizeIs(1));
  EXPECT_THAT(found("tests/fap/a_test.cpp", "tests/fap/b_test.cpp"), SizeIs(1));
  EXPECT_THAT(found("tests/codec/a_test.cpp", "tests/fap/b_test.cpp"), IsEmpty());
  EXPECT_THAT(found("tests/fuzz/a.cpp", "tests/fuzz/b.cpp"), IsEmpty());
  EXPECT_THAT(found("tools/live/web/web.cpp", "tools/live/web/web_absent.cpp"), IsEmpty());
  EXPECT_THAT(double_definitions({{"a.cpp", "inline int f(int a) { return a; }"},
                                  {"b.cpp", "inline int f(int b) { return -b; }"}}),
              ElementsAre(HasSubstr("f(int): ")));
  EXPECT_THAT(double_definitions({{"a.cpp", "int f(int a) { return a; }"},
                                  {"b.cpp", "int f(long b) { return -b; }"}}),
              IsEmpty());
  EXPECT_THAT(double_definitions({{"a.cpp", "struct A {"}}), ElementsAre(HasSubstr("cannot read")));
}

}  // namespace definitions_test
}  // namespace animeme::test
