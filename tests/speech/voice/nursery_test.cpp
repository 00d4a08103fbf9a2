#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>
#include <unistd.h>

#include "tools/speech/voice/child.h"

namespace animeme::test {
namespace nursery_test {

using voice::Nursery;
using voice::Sender;

std::string g_name;  // of a child, and what its requests add
std::string g_program = "small";

class NurseryTest : public testing::Test {
 protected:
  void SetUp() override {
    auto started = Nursery::start(
        [](std::string_view name) { g_name = name; },
        [](Sender& sender, std::string_view request) {
          if (request == "crash") ::raise(SIGSEGV);
          g_name += request;
          return sender.send(1, g_program + " " + g_name + " " + std::to_string(::getppid()));
        },
        20);
    ASSERT_TRUE(started) << started.error().message;
    nursery_ = std::move(*started);
  }
  /// What a child says, and the process that it is a copy of.
  static std::pair<std::string, std::string> ask(voice::KeptChild& child, const std::string& what) {
    std::string said;
    const auto ran = child.run("a child", what, [&](std::uint32_t, std::string bytes) {
      said = std::move(bytes);
      return true;
    });
    if (!ran) return {"error", ran.error().message};
    const std::size_t blank = said.rfind(' ');
    return {said.substr(0, blank), said.substr(blank + 1)};
  }
  std::unique_ptr<Nursery> nursery_;
};

TEST_F(NurseryTest, ChildrenAreCopiesOfWhatTheProgramWas) {
  g_program = "large";
  auto a = nursery_->child("a"), b = nursery_->child("b");
  ASSERT_TRUE(a && b);
  const auto first = ask(**a, "1");
  EXPECT_EQ(first.first, "small a1");
  EXPECT_EQ(ask(**b, "2").first, "small b2");
  const auto again = ask(**a, "3");
  EXPECT_EQ(again.first, "small a3") << "no request sees what another one left";
  EXPECT_EQ(again.second, first.second) << "the child stays";
  EXPECT_NE(first.second, std::to_string(::getpid()));
  g_program = "small";
}

TEST_F(NurseryTest, ACrashIsAnErrorAndTheChildStays) {
  auto child = nursery_->child("a");
  ASSERT_TRUE(child);
  EXPECT_EQ(ask(**child, "crash").first, "error");
  EXPECT_EQ(ask(**child, "1").first, "small a1");
}

TEST_F(NurseryTest, ChildrenEndWithIt) {
  auto child = nursery_->child("a");
  ASSERT_TRUE(child);
  EXPECT_EQ(ask(**child, "1").first, "small a1");
  nursery_.reset();
  EXPECT_EQ(ask(**child, "2").first, "error");
}

TEST_F(NurseryTest, HundredsComeAndGo) {
  for (int i = 0; i < 200; ++i) {
    auto child = nursery_->child(std::to_string(i));
    ASSERT_TRUE(child);
    if (i % 20 != 0) continue;
    EXPECT_EQ(ask(**child, "x").first, "small " + std::to_string(i) + "x");
  }
}

}  // namespace nursery_test
}  // namespace animeme::test
