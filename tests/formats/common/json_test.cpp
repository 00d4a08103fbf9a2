// Json against the JSON library: the same values as text, and the same text as values.
#include "tools/formats/common/json.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

namespace animeme::tools {
namespace json_test {

using Theirs = nlohmann::ordered_json;

std::string dump(const Json& json, int indent, bool ascii) { return json.dump(indent, ascii); }
std::string dump(const Theirs& json, int indent, bool ascii) {
  return json.dump(indent, ' ', ascii, Theirs::error_handler_t::replace);
}

/// `make` builds a value of the type of its argument, by the same expressions.
template <class Make>
void expect_same(Make make) {
  Json ours;
  Theirs theirs;
  make(ours);
  make(theirs);
  for (const int indent : {-1, 0, 2, 3}) {
    for (const bool ascii : {false, true}) {
      EXPECT_EQ(dump(ours, indent, ascii), dump(theirs, indent, ascii));
    }
  }
  EXPECT_EQ(pretty(ours), dump(theirs, 2, false));
  // And back: of text the library reads what it wrote.
  const Result<Json> read = Json::parse(ours.dump());
  ASSERT_TRUE(read) << read.error().describe();
  EXPECT_EQ(read->dump(2), Theirs::parse(dump(theirs, -1, false)).dump(2));
}

TEST(Json, BuildsObjectsAndArraysFromBraces) {
  expect_same([](auto& json) {
    using J = std::decay_t<decltype(json)>;
    json = {{"a", 1}, {"b", {1, 2, 3}}, {"c", {{"x", 1.0}, {"y", nullptr}}}};
    json["pair"] = {"p", "q"};
    json["pairs"] = {{"p", "q"}, {"r", "s"}};
    json["no_pairs"] = {{"p", "q"}, {1, "s"}};
    json["one"] = {1};
    json["nothing"] = {};
    json["empty"] = J::array();
    json["empty_object"] = J::object();
    json["deep"] = {{{{"k", {{{"l", J::array({J::array()})}}}}}}};
    json["list"] = J::array({J::array({"a", 1}), "b"});
    json["again"] = {{"same", 1}, {"same", 2}};
  });
}

TEST(Json, GrowsMemberByMember) {
  expect_same([](auto& json) {
    using J = std::decay_t<decltype(json)>;
    json["z"]["y"]["x"] = true;
    json["a"].push_back(1);
    json["a"].push_back({{"b", false}});
    json["a"].push_back({"c", "d"});
    json["a"][1]["e"] = 5;
    json["a"][0] = "was a number";
    json["gone"] = 1;
    json.erase("gone");
    json.erase("never there");
    json.update({{"z", 1}, {"new", 2}});
    json["z"] = J(nullptr);
    J copy = json;
    json["copy"] = copy;
    json["moved"] = std::move(copy);
  });
}

TEST(Json, TakesTheTypesOfTheLanguage) {
  expect_same([](auto& json) {
    const std::string text = "text";
    const std::vector<std::string> texts = {"x", "", "z"};
    const std::array<float, 3> floats = {1, 2.5F, 0.1F};
    const std::set<int> sorted = {3, 1, 2};
    json = {{"text", text},
            {"view", std::string_view(text).substr(1)},
            {"texts", texts},
            {"none", std::vector<double>()},
            {"floats", floats},
            {"nested", std::vector<std::vector<int>>{{1}, {}, {2, 3}}},
            {"sorted", sorted},
            {"short", short(-3)},
            {"byte", std::uint8_t(200)},
            {"letter", 'a'},
            {"size", sizeof(int)},
            {"float", 0.1F},
            {"condition", text.empty()}};
    json[text + "!"] = text;
  });
}

TEST(Json, WritesNumbersAsTheLibrary) {
  expect_same([](auto& json) {
    for (const double value : {0.0,
                               -0.0,
                               1.0,
                               -1.0,
                               3.0,
                               0.1,
                               1.0 / 3,
                               1e15,
                               1e16,
                               1e17,
                               123456789012345678.0,
                               1e21,
                               1e22,
                               1e-4,
                               1e-5,
                               1e-6,
                               5e-324,
                               1.7976931348623157e308,
                               2.2250738585072014e-308,
                               100.0,
                               1e2,
                               0.001,
                               double(std::nan("")),
                               double(INFINITY),
                               double(-INFINITY),
                               9007199254740993.0}) {
      json.push_back(value);
    }
    json.push_back(std::numeric_limits<std::int64_t>::min());
    json.push_back(std::numeric_limits<std::int64_t>::max());
    json.push_back(std::numeric_limits<std::uint64_t>::max());
    json.push_back(std::numeric_limits<int>::min());
  });
  expect_same([](auto& json) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 4000; ++i) {
      const std::uint64_t bits = random();
      json.push_back(std::bit_cast<double>(bits));
      json.push_back(double(std::bit_cast<float>(std::uint32_t(bits))));
      json.push_back(double(bits % 1000000) / 1000);
      json.push_back(bits >> (bits % 64));
      json.push_back(-std::int64_t(bits >> (1 + bits % 63)));
    }
  });
}

TEST(Json, WritesAnyBytesAsTheLibrary) {
  expect_same([](auto& json) {
    for (int first = 0; first < 256; ++first) {
      json.push_back(std::string("a") + char(first) + "b");
      json[std::size_t(first)] = std::string(1, char(first));
    }
    for (const char* text :
         {"\"\\/", "\xC3\xBC\xE2\x82\xAC\xF0\x9F\x98\x80", "\xE2\x80\xA8", "\xC0\xAF",
          "\xED\xA0\x80", "\xF4\x90\x80\x80", "cut \xE2\x82", "\xE2\x28\xA1", "\xFF\xFE", "\x7F"}) {
      json.push_back(text);
    }
    std::mt19937 random(2);
    for (int i = 0; i < 3000; ++i) {
      std::string bytes;
      for (auto left = random() % 12; left > 0; --left) bytes += char(random() % 256);
      json.push_back(bytes);
    }
  });
  expect_same([](auto& json) {
    json["\n"] = 1;
    json["\xFF"] = 2;
    json["\xC3\xBC\""] = 3;
    json[""] = 4;
  });
}

TEST(Json, ReadsAsTheLibrary) {
  for (const char* text :
       {"{}", "[]",
        " [1, -2, 3.5, 1e3, -0, 18446744073709551615, -9223372036854775808, "
        "18446744073709551616, 1E-400] ",
        "\"\\u00fc\\ud83d\\ude00\\n\\/\"", "null", "true", "\xEF\xBB\xBF{\"a\": 1}",
        "{\"a\": {\"b\": [{}, [], \"\"]}, \"c\": null}", "{\"b\": 1, \"a\": 2, \"b\": {\"c\": 3}}",
        "{\"b\": 1, \"b\": 2, \"a\": 0, \"a\": 1, \"b\": 3}"}) {
    const Result<Json> read = Json::parse(text);
    ASSERT_TRUE(read) << text;
    EXPECT_EQ(read->dump(), Theirs::parse(text).dump()) << text;
    const Result<Json> sorted = Json::parse(text, {.sorted = true});
    ASSERT_TRUE(sorted) << text;
    EXPECT_EQ(sorted->dump(), nlohmann::json::parse(text).dump()) << text;
    Json later = *read;
    later.sort();
    EXPECT_EQ(later.dump(), sorted->dump());
  }
  for (const char* text :
       {"", " ", "{", "[1,", "[1 2]", "{\"a\" 1}", "{1: 2}", "nul", "01", "[\"\n\"]", "\"\xFF\"",
        "\"\\ud800\"", "[1]]", "NaN", "'a'", "[1,]", "// c\n1", "\"open"}) {
    const Result<Json> read = Json::parse(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, Code::syntax);
    try {
      const Theirs theirs = Theirs::parse(text);
      ADD_FAILURE() << text << theirs.size();
    } catch (const Theirs::parse_error& error) {
      EXPECT_EQ(read.error().where.column, std::int64_t(std::max<std::size_t>(error.byte, 1)))
          << text;
    }
  }
  EXPECT_FALSE(Json::parse("[1e999]"));  // no number of the machine
}

TEST(Json, DepthIsBoundedOnlyByTheReader) {
  constexpr std::size_t kDeep = 1000000;
  const std::string open(kDeep, '['), close(kDeep, ']');
  {
    const Result<Json> deep = Json::parse(open + close);
    ASSERT_TRUE(deep);
    EXPECT_EQ(deep->size(), 1U);
  }  // its end does not overflow the stack
  EXPECT_FALSE(Json::parse(open));
  EXPECT_TRUE(Json::parse("[[1]]", {.deepest = 2}));
  const Result<Json> refused = Json::parse("[[[1]]]", {.deepest = 2});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::out_of_range);
}

TEST(Json, ManyMembersAreReadQuickly) {
  std::string text = "{";
  for (int i = 0; i < 50000; ++i) text += "\"member " + std::to_string(i * 7919 % 50000) + "\":1,";
  text.back() = '}';
  const Result<Json> read = Json::parse(text, {.sorted = true});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->size(), 50000U);
  for (int i = 0; i < 50000; ++i) ASSERT_TRUE(read->contains("member " + std::to_string(i)));
}

TEST(Json, AnswersQuestions) {
  const Json json = *Json::parse(
      R"({"t": "x", "n": 3, "m": -3, "f": 2.5, "b": true, "l": ["a", "b"], "z": null})");
  EXPECT_EQ(json["t"].text(), "x");
  EXPECT_EQ(json["n"].get<int>(), 3);
  EXPECT_EQ(json["m"].get<long>(), -3);
  EXPECT_EQ(json["f"].get<double>(), 2.5);
  EXPECT_EQ(json["n"].get<double>(), 3);
  EXPECT_TRUE(json["b"].get<bool>());
  EXPECT_EQ(json["l"].get<std::vector<std::string>>(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(json["n"].is_number_unsigned());
  EXPECT_FALSE(json["m"].is_number_unsigned());
  EXPECT_FALSE(json["f"].is_number_integer());
  EXPECT_TRUE(json["no such"].is_null());
  EXPECT_TRUE(json["t"]["no object"].is_null());
  EXPECT_EQ(json.find("no such"), nullptr);
  EXPECT_TRUE(json.contains("z"));
  EXPECT_EQ(json["l"].back(), "b");
  EXPECT_EQ(json["t"].begin(), json["t"].end());
  EXPECT_TRUE(json["t"].items().empty());
  EXPECT_THROW(json["t"].get<double>(), std::runtime_error);
  EXPECT_THROW(json["n"].text(), std::runtime_error);
  EXPECT_EQ(Json(1), Json(1.0));
  EXPECT_EQ(Json(1U), Json(1));
  EXPECT_FALSE(Json(-1) == Json(std::numeric_limits<std::uint64_t>::max()));
  EXPECT_FALSE(Json("1") == Json(1));
  EXPECT_EQ(json, Json(json));
}

}  // namespace json_test
}  // namespace animeme::tools
