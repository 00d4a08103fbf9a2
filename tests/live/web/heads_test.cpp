// `animeme stream --head`: heads for the page, chosen by the address or by whoever looks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/formats/media/live/stream_support.h"
#include "tests/live/web/http.h"
#include "tests/live/web/test_server.h"
#include "tests/support/folders.h"

namespace animeme::test {
namespace heads_test {

using ::testing::HasSubstr;

class PageHeads : public ::testing::Test {
 protected:
  TempDir dir_;
};

TEST_F(PageHeads, OfTheProgram) {
  const std::string samples = std::string(test::kSourceFolder) + "/tools/release/samples/";
  const std::string port = std::to_string(free_ports()), url = "http://127.0.0.1:" + port + "/";
  Running send({"stream", samples + "talk.fba", "--loop", "--to", url, "--head",
                "child," + samples + "me.glb", "--head", "man"},
               dir_ / "out", dir_ / "err");
  for (int i = 0; i < 1200 && slurp(dir_ / "err").find("sending") == std::string::npos; ++i) {
    usleep(50000);
  }
  const auto info = nlohmann::json::parse(body_of(get(std::stoi(port), "/info.json")));
  EXPECT_EQ(info["heads"], nlohmann::json({"child", "me", "man"}));
  if (!Chromium::find().empty()) {
    Chromium browser;
    ASSERT_TRUE(browser.is_open());
    browser.open(url + "?head=me", 1100, 800, false);
    ASSERT_TRUE(wait_for(browser, "animeme.head && animeme.shown > 10 && heads.length", 120));
    EXPECT_EQ(browser.evaluate("[heads.value, heads.selectedOptions[0].text, "
                               "heads.parentElement.hidden]"),
              nlohmann::json({"1", "me", false}));
    const auto vertices = [&] {
      return int(browser.evaluate("animeme.head.rigs[0].positions[0].length"));
    };
    const int first = vertices();
    // An avatar's own shapes show what is said.
    const auto moves = browser.evaluate(R"(new Promise(done => {
      const rig = animeme.head.rigs[0], skin = () => Array.from(rig.positions[0]), rest = skin();
      let most = 0, left = 40;
      (function look() {
        skin().forEach((x, i) => { most = Math.max(most, Math.abs(x - rest[i])); });
        if (--left) setTimeout(look, 50); else done(most);
      })();
    }))");
    EXPECT_GT(moves.get<double>(), 0.2) << "cm";
    browser.save_picture(std::filesystem::path(test::kBinaryFolder) / "screenshots" /
                         "web_heads.png");
    browser.evaluate("heads.value = 2, heads.dispatchEvent(new Event('change'))");
    ASSERT_TRUE(
        wait_for(browser, "animeme.head.rigs[0].positions[0].length !== " + std::to_string(first)));
    EXPECT_EQ(browser.evaluate("heads.selectedOptions[0].text"), "man");
    EXPECT_THAT(browser.complaints(), ::testing::IsEmpty());
  }
  send.signal(SIGINT);
  EXPECT_EQ(send.wait(), 130) << slurp(dir_ / "err");
}

TEST_F(PageHeads, WhatIsNoneIsTold) {
  const std::string clip = std::string(test::kSourceFolder) + "/tools/release/samples/talk.fba";
  auto run = animeme({"stream", clip, "--fast", "--to", "http://127.0.0.1:0/", "--head", "none"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("none"));
  run = animeme({"stream", clip, "--fast", "--to", "udp://127.0.0.1:9", "--head", "man"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("--head is for the page"));
}

}  // namespace heads_test
}  // namespace animeme::test
