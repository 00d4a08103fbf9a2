// Two heads of one server, each on its page in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/live/web/chromium.h"
#include "tests/support/folders.h"
#include "tools/live/serve/server.h"

namespace animeme::test {
namespace page_test {

using Json = nlohmann::json;

bool shows(Chromium& browser, const std::string& expression) {
  return browser.evaluate(
             "new Promise(done => { const end = Date.now() + 60000; (function look() { if (" +
             expression +
             ") done(true); else if (Date.now() > end) done(false); "
             "else setTimeout(look, 50); })(); })") == true;
}

TEST(PageOfAHead, TalksAndStaysWithItsHead) {
  if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > 10) GTEST_SKIP() << "this machine is too busy";
  auto server = serve::HeadServer::open({.url = "http://127.0.0.1:0/"}, {});
  ASSERT_TRUE(server) << server.error().message;
  for (const char* name : {"anna", "ben"}) ASSERT_TRUE((*server)->make(name, {}));
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open((*server)->address() + "heads/anna/", 1000, 800, false);
  // It begins by itself, without sound as long as nobody has clicked.
  EXPECT_TRUE(shows(browser, "animeme.blocked || animeme.state === 'live'"));
  browser.evaluate("document.getElementById('sound').click()");
  ASSERT_TRUE(shows(browser, "animeme.state === 'live' && animeme.shown > 20"));
  EXPECT_FALSE((*server)->find("anna")->figures().asleep);
  EXPECT_TRUE((*server)->find("ben")->figures().asleep);
  ASSERT_TRUE((*server)->find("anna")->say({"Mama, papa, and many more open their mouths."}));
  EXPECT_TRUE(shows(browser, "Number(document.getElementById('mouth').ariaValueNow) > 10"));
  // It goes, and comes back: the page joins it again by itself.
  ASSERT_TRUE((*server)->remove("anna"));
  EXPECT_TRUE(shows(browser, "animeme.state === 'ended'"));
  ASSERT_TRUE((*server)->make("anna", {}));
  browser.evaluate("document.getElementById('start').click()");
  EXPECT_TRUE(shows(browser, "animeme.state === 'live'"));
  EXPECT_THAT(browser.complaints(), testing::IsEmpty());
  browser.save_picture(std::filesystem::path(test::kBinaryFolder) / "screenshots/serve_head.png");
  (*server)->finish();
}

}  // namespace page_test
}  // namespace animeme::test
