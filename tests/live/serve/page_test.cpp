// Two heads of one server, each on its page in a browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "tests/live/web/chromium.h"
#include "tests/support/folders.h"
#include "tests/support/temp_dir.h"
#include "tools/live/serve/server.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::test {
namespace page_test {

using Json = nlohmann::json;

bool shows(Chromium& browser, const std::string& expression) {
  return browser.evaluate(
             "new Promise(done => { const end = Date.now() + 120000; (function look() { if (" +
             expression +
             ") done(true); else if (Date.now() > end) done(false); "
             "else setTimeout(look, 50); })(); })") == true;
}

TEST(PageOfAHead, TalksAndStaysWithItsHead) {
  if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > 20) GTEST_SKIP() << "this machine is too busy";
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
  // What the page shows may be gone before somebody looks, on a busy machine.
  browser.evaluate(
      "window.captions = ''; window.rows = 0; window.marked = new Set();"
      "animeme.addEventListener('tick', () => {"
      "  const captions = document.getElementById('captions');"
      "  window.captions += captions.textContent;"
      "  const word = captions.querySelector('b')?.textContent;"
      "  if (word) window.marked.add(word);"
      "  window.rows = Math.max(window.rows, document.querySelectorAll('#legend li').length);"
      "})");
  ASSERT_TRUE((*server)->find("anna")->say({"Mama, papa, and many more open their mouths."}));
  EXPECT_TRUE(shows(browser, "Number(document.getElementById('mouth').ariaValueNow) > 10"));
  // Captions: all words of the line, one after another marked; a row for each of six curves.
  EXPECT_TRUE(shows(browser, "/papa.* many more/.test(window.captions)"));
  EXPECT_TRUE(shows(browser, "window.marked.size > 2"));
  EXPECT_TRUE(shows(browser, "window.rows === 6"));
  browser.save_picture(std::filesystem::path(test::kBinaryFolder) /
                       "screenshots/serve_captions.png");
  EXPECT_TRUE(shows(browser, "document.getElementById('captions').textContent === ''"));
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

// By a ticket, and by WebRTC where the module is there.
TEST(PageOfAHead, OpensWithATicketAndByWebRtc) {
  if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > 20) GTEST_SKIP() << "this machine is too busy";
  serve::ServerOptions options{.url = "http://127.0.0.1:0/"};
  options.token = "secret";
  options.guard_viewers = true;
  options.web.make_peer_connections = [] { return webrtc::make_peer_connections(); };
  auto server = serve::HeadServer::open(options, {});
  ASSERT_TRUE(server) << server.error().message;
  ASSERT_TRUE((*server)->make("anna", {}));
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open((*server)->address() + "heads/anna/", 1000, 800, false);
  EXPECT_TRUE(shows(browser, "animeme.state === 'lost'"));
  const std::string ticket = serve::Tickets("secret").make("anna", std::time(nullptr) + 600);
  browser.open((*server)->address() + "heads/anna/?ticket=" + ticket, 1000, 800, false);
  EXPECT_TRUE(shows(browser, "animeme.blocked || animeme.state === 'live'"));
  browser.evaluate("document.getElementById('sound').click()");
  ASSERT_TRUE(shows(browser, "animeme.state === 'live' && animeme.shown > 20"));
  if (webrtc::is_there()) {
    EXPECT_TRUE(shows(browser, "animeme.session.connected"));
  }
  EXPECT_EQ((*server)->find("anna")->figures().viewers, 1);
  ASSERT_TRUE((*server)->find("anna")->say({"Mama, papa, and many more open their mouths."}));
  EXPECT_TRUE(shows(browser, "Number(document.getElementById('mouth').ariaValueNow) > 10"));
  // Made anew, it is watched again.
  serve::HeadSettings other;
  other.quant = 2;
  ASSERT_TRUE((*server)->update("anna", other));
  EXPECT_TRUE(shows(browser, "animeme.state !== 'live'"));
  EXPECT_TRUE(shows(browser, "animeme.state === 'live'"));
  (*server)->finish();
}

// ANIMEME_REDEPLOYS=10 for a table of times.
TEST(PageOfAHead, ComesBackAfterEachRedeploy) {
  if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > 20) GTEST_SKIP() << "this machine is too busy";
  const char* wanted = std::getenv("ANIMEME_REDEPLOYS");
  const int redeploys = wanted != nullptr ? std::atoi(wanted) : 2;
  serve::ServerOptions options{.url = "http://127.0.0.1:0/"};
  options.web.make_peer_connections = [] { return webrtc::make_peer_connections(); };
  const std::vector<std::pair<std::string, serve::HeadSettings>> heads{{"anna", {}}};
  auto server = serve::HeadServer::open(options, heads);
  ASSERT_TRUE(server) << server.error().message;
  options.url = (*server)->address();
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open(options.url + "heads/anna/", 1000, 800, false);
  EXPECT_TRUE(shows(browser, "animeme.blocked || animeme.state === 'live'"));
  browser.evaluate("document.getElementById('sound').click()");
  std::string times;
  for (int i = 0; i < redeploys; ++i) {
    ASSERT_TRUE(shows(browser, "animeme.state === 'live' && animeme.session.frames.length > 20"));
    browser.evaluate(
        "window.back = undefined; window.gone = undefined;"
        "clearInterval(window.watch); window.watch = setInterval(() => {"
        "  if (animeme.state !== 'live') window.gone = window.gone || performance.now();"
        "  else if (window.gone) window.back = window.back || performance.now();"
        "}, 10)");
    ASSERT_TRUE((*server)->find("anna")->say({"Line."}));
    (*server)->drain();
    (*server)->finish();
    server->reset();
    std::this_thread::sleep_for(std::chrono::seconds(1));  // what a process takes to start
    server = serve::HeadServer::open(options, heads);
    ASSERT_TRUE(server) << server.error().message;
    ASSERT_TRUE(shows(browser, "window.back !== undefined")) << i;
    times += " " + std::to_string(int(
                       browser.evaluate("Math.round(window.back - window.gone)").get<double>()));
  }
  std::printf("ms until the page is live again, of which the server is away for 1000:%s\n",
              times.c_str());
  (*server)->finish();
}

// `animeme serve` with a head "anna", as a process of its own.
class ServeProcess {
 public:
  /// `url`: where it listens; port 0: anywhere. address() is empty where it does not start.
  ServeProcess(const std::string& heads, const std::string& url) {
    int ends[2] = {-1, -1};
    if (::pipe(ends) != 0) return;
    const std::string program = std::string(kBinaryFolder) + "/bin/animeme";
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[1], 1);
      ::close(ends[0]);
      ::execl(program.c_str(), program.c_str(), "serve", heads.c_str(), "--listen", url.c_str(),
              "--json", "--quiet", static_cast<char*>(nullptr));
      ::_exit(127);
    }
    ::close(ends[1]);
    std::string line;
    for (char letter = 0; ::read(ends[0], &letter, 1) == 1 && letter != '\n';) line += letter;
    out_ = ends[0];
    const Json json = Json::parse(line, nullptr, false);
    if (json.is_object()) address_ = json.value("address", "");
  }
  ~ServeProcess() { (void)end(); }
  ServeProcess(const ServeProcess&) = delete;
  ServeProcess& operator=(const ServeProcess&) = delete;

  const std::string& address() const { return address_; }
  /// Exit code after SIGTERM.
  int end() {
    if (pid_ <= 0) return -1;
    ::kill(pid_, SIGTERM);
    char rest[4096];
    while (::read(out_, rest, sizeof rest) > 0) {
    }
    ::close(out_);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int out_ = -1;
  std::string address_;
};

TEST(PageOfAHead, ComesBackAfterItsProcessIsReplaced) {
  if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  if (!std::filesystem::exists(std::string(kBinaryFolder) + "/bin/animeme")) {
    GTEST_SKIP() << "the program is not built";
  }
  double load = 0;
  if (getloadavg(&load, 1) == 1 && load > 20) GTEST_SKIP() << "this machine is too busy";
  const char* wanted = std::getenv("ANIMEME_REDEPLOYS");
  const int redeploys = wanted != nullptr ? std::atoi(wanted) : 2;
  const TempDir dir;
  const std::string heads = dir.file("heads.json");
  std::ofstream(heads) << R"({"heads": [{"name": "anna"}]})";
  std::optional<ServeProcess> server;
  server.emplace(heads, "http://127.0.0.1:0/");
  ASSERT_FALSE(server->address().empty());
  const std::string url = server->address();
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open(url + "heads/anna/", 1000, 800, false);
  EXPECT_TRUE(shows(browser, "animeme.blocked || animeme.state === 'live'"));
  browser.evaluate("document.getElementById('sound').click()");
  std::string times;
  for (int i = 0; i < redeploys; ++i) {
    ASSERT_TRUE(shows(browser, "animeme.state === 'live' && animeme.session.frames.length > 20"));
    // What was accepted is said to its end, and only then do viewers have to look for another one.
    browser.evaluate(
        "window.back = window.gone = window.end = undefined;"
        "clearInterval(window.watch); window.watch = setInterval(() => {"
        "  if (animeme.state !== 'live') window.gone = window.gone || performance.now();"
        "  else if (window.gone) window.back = window.back || performance.now();"
        "}, 10)");
    EXPECT_EQ(browser.evaluate("fetch('say', {method: 'POST', body: 'This is said to its end.'})"
                               ".then((answer) => answer.status)"),
              202);
    EXPECT_EQ(server->end(), 0);
    const auto ended = std::chrono::steady_clock::now();
    server.emplace(heads, url);
    const std::chrono::duration<double, std::milli> away = std::chrono::steady_clock::now() - ended;
    ASSERT_EQ(server->address(), url) << i;
    ASSERT_TRUE(shows(browser, "window.back !== undefined")) << i;
    times += " " +
             std::to_string(
                 int(browser.evaluate("Math.round(window.back - window.gone)").get<double>())) +
             " (" + std::to_string(int(away.count())) + ")";
  }
  std::printf("ms until the page is live again, and until the next process listens; load %.1f:%s\n",
              load, times.c_str());
  EXPECT_EQ(server->end(), 0);
}

TEST(PageOfAHead, TheListShowsOne) {
  if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  serve::ServerOptions options{.url = "http://127.0.0.1:0/"};
  options.token = "secret";
  options.guard_viewers = true;
  auto server = serve::HeadServer::open(options, {});
  ASSERT_TRUE(server) << server.error().message;
  for (const char* name : {"anna", "ben"}) ASSERT_TRUE((*server)->make(name, {}));
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open((*server)->address(), 1000, 800, false);
  EXPECT_TRUE(shows(browser, "!document.getElementById('access').hidden"));
  EXPECT_TRUE(shows(browser, "document.getElementById('heads').rows.length === 0"));
  browser.evaluate(
      "document.getElementById('token').value = 'secret',"
      "document.querySelector('#access button').click()");
  EXPECT_TRUE(shows(browser, "document.getElementById('heads').rows.length === 2"));
  browser.evaluate("document.querySelector('tr[data-name=ben] button').click()");
  EXPECT_TRUE(shows(browser,
                    "document.getElementById('frame').contentWindow?.animeme?.session?.frames"
                    ".length > 5"));
  EXPECT_FALSE((*server)->find("ben")->figures().asleep);
  browser.evaluate(
      "document.getElementById('text').value = 'Hello.',"
      "document.querySelector('#speech button').click()");
  for (int i = 0; i < 600 && (*server)->find("ben")->figures().spoken == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_EQ((*server)->find("ben")->figures().spoken, 1);
  browser.save_picture(std::filesystem::path(test::kBinaryFolder) / "screenshots/serve_list.png");
  (*server)->finish();
}

}  // namespace page_test
}  // namespace animeme::test
