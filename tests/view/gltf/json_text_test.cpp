// Text that grows without being spelled anew.
#include "tools/view/gltf/detail/json_text.h"

#include <gtest/gtest.h>

namespace animeme::gltf {
namespace json_text_test {

TEST(JsonText, GrowsWhereItIsToldTo) {
  const std::string text =
      "\xEF\xBB\xBF { \"a\" : [ 1.50, \"]\\\"[\" ,{\"a\":[]} ] ,\n \"\\u0062\":{}, \"c\": -1e2 } ";
  JsonText json(text);
  const auto a = json.member(json.root(), "a");
  const auto b = json.member(json.root(), "b");
  const auto c = json.member(json.root(), "c");
  ASSERT_TRUE(a && b && c);
  EXPECT_FALSE(json.member(json.root(), "d"));
  EXPECT_FALSE(json.member(*a, "a"));
  ASSERT_EQ(json.entries(*a).size(), 3u);
  const auto inner = json.member(json.entries(*a)[2], "a");
  ASSERT_TRUE(inner);
  json.append(*a, "2");
  json.append(*a, "3");
  json.append(*inner, "4");
  json.append(*inner, "5");
  json.append(*b, "\"x\":0");
  json.replace(*c, "7");
  json.append(json.root(), "\"d\":[]");
  EXPECT_EQ(json.changed(),
            "\xEF\xBB\xBF { \"a\" : [ 1.50, \"]\\\"[\" ,{\"a\":[4,5]},2,3 ] ,\n "
            "\"\\u0062\":{\"x\":0}, \"c\": 7,\"d\":[] } ");
}

TEST(JsonText, TakesTheLastOfEqualNamesAndDeepOnes) {
  std::string text = R"({"a":1,"a":2,"deep":)";
  text += std::string(100'000, '[') + std::string(100'000, ']') + "}";
  JsonText json(text);
  json.replace(*json.member(json.root(), "a"), "3");
  json.replace(*json.member_and_key(json.root(), "deep"), R"("flat":0)");
  EXPECT_EQ(json.changed(), R"({"a":1,"a":3,"flat":0})");
}

}  // namespace json_text_test
}  // namespace animeme::gltf
