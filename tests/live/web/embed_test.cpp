// The page and its numbers in pages and programs of others: a page of another origin, a frame, a
// browser source of OBS. Pictures lie in <build>/screenshots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fap/head/model.h"
#include "fap/head/rig.h"
#include "tests/live/web/http.h"
#include "tests/live/web/test_server.h"
#include "tests/support/files.h"
#include "tests/support/folders.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::test {
namespace embed_test {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

constexpr auto kSound = media::AudioCodec::aac;

// What obs-browser adds to the command line of its browser (browser-app.cpp,
// OnBeforeCommandLineProcessing) where textures are not shared.
const std::vector<std::string> kObs{"--autoplay-policy=no-user-gesture-required",
                                    "--disable-features=HardwareMediaKeyHandling",
                                    "--disable-gpu-compositing"};
// The style that a browser source has at first (obs-browser-plugin.cpp).
constexpr const char* kObsStyle =
    "body { background-color: rgba(0, 0, 0, 0); margin: 0px auto; overflow: hidden; }";

class PageElsewhere : public ::testing::Test {
 protected:
  void SetUp() override {
    if (Chromium::find().empty()) GTEST_SKIP() << "Chromium is not installed";
  }
  static web::WebOptions with_head(std::vector<std::string> origins = {}) {
    const auto head = head::make_head();
    EXPECT_TRUE(head);
    web::WebOptions options{.allow_origins = std::move(origins)};
    options.head_script = viewer::head_script();
    options.head_model = viewer::pack_head(*head, head::make_rig(*head));
    return options;
  }
  /// Puts a script into the browser's page that counts what of the picture is how opaque.
  static Json alphas(Chromium& browser, const fs::path& picture) {
    browser.save_picture(picture);
    const std::string bytes = slurp(picture);
    std::string hex;
    for (const char c : bytes) {
      hex += "0123456789abcdef"[std::uint8_t(c) >> 4];
      hex += "0123456789abcdef"[c & 15];
    }
    return browser.evaluate(
        "new Promise(async done => { const bytes = Uint8Array.from('" + hex +
            "'.match(/../g), x => parseInt(x, 16));"
            "const image = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));"
            "const {width, height} = image, canvas = new OffscreenCanvas(width, height);"
            "const draw = canvas.getContext('2d'); draw.drawImage(image, 0, 0);"
            "const {data} = draw.getImageData(0, 0, width, height);"
            "const at = (x, y) => [...data.slice(4 * (y * width + x), 4 * (y * width + x) + 4)];"
            "let clear = 0, solid = 0;"
            "for (let i = 3; i < data.length; i += 4) { clear += data[i] === 0; solid += data[i] "
            "=== "
            "255; }"
            "done({width, height, clear: 4 * clear / data.length, solid: 4 * solid / data.length, "
            "corner: at(2, 2), middle: at(width >> 1, height >> 1)}); })",
        false);
  }
  static fs::path picture(const char* name) {
    return fs::path(test::kBinaryFolder) / "screenshots" / name;
  }
};

/// The lines of JavaScript in the README that read /faps?binary.
std::string readme_reader() {
  const std::string text = slurp(fs::path(test::kSourceFolder) / "tools/live/web/protocol.md");
  const std::size_t begin = text.find("function planeReader");
  const std::size_t end = text.find("```", begin);
  EXPECT_NE(begin, std::string::npos);
  return begin == std::string::npos ? "" : text.substr(begin, end - begin);
}

TEST(PlaneReader, IsThatOfThePage) {
  const std::string page = slurp(fs::path(test::kSourceFolder) / "tools/live/web/page/planes.js");
  EXPECT_THAT(page, HasSubstr(readme_reader()));
}

TEST_F(PageElsewhere, ReadsBothFormsOfTheValues) {
  OnePage page("<!doctype html><meta charset=utf-8><link rel=icon href=data:,><p>elsewhere</p>");
  TestServer server(kSound, {.allow_origins = {page.origin()}});
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open(page.origin(), 400, 300, false);
  const std::string url = "ws" + server.address().substr(4) + "faps";
  const Json seen = browser.evaluate(readme_reader() + R"(
    new Promise((done) => {
      const texts = [], planes = [];
      const text = new WebSocket(')" +
                                     url + R"(');
      text.onmessage = ({data}) => {
        const message = JSON.parse(data);
        if (message.values) texts.push(message);
      };
      const small = new WebSocket(')" +
                                     url + R"(?binary');
      small.binaryType = 'arraybuffer';
      let read;
      small.onmessage = ({data}) => {
        if (typeof data !== 'string') planes.push(read(data));
        else read ??= planeReader(JSON.parse(data).timescale);
        if (planes.length > 150) done([texts, planes]);
      };
      small.onerror = () => done('refused');
    }))");
  ASSERT_TRUE(seen.is_array()) << seen;
  std::map<long, Json> texts;
  const auto key = [](const Json& plane) { return std::lround(double(plane["time"]) * 1e6); };
  for (const Json& each : seen[0]) texts[key(each)] = each;
  int compared = 0;
  for (const Json& plane : seen[1]) {
    const auto found = texts.find(key(plane));
    if (found == texts.end()) continue;
    for (const char* name : {"intra", "bytes", "values"}) {
      ASSERT_EQ(plane[name], found->second[name]) << name << " at " << plane["time"];
    }
    ASSERT_NEAR(double(plane["duration"]), double(found->second["duration"]), 1e-6);
    ASSERT_EQ(plane["missed"], false);
    ++compared;
  }
  EXPECT_GT(compared, 100);
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(PageElsewhere, HasTheFaceInAFrameIfItMay) {
  OnePage page("");
  const auto html = [&](const std::string& url) {
    return "<!doctype html><meta charset=utf-8><link rel=icon href=data:,>"
           "<style>body { margin: 0; height: 100vh; background: repeating-conic-gradient("
           "#c33 0 25%, #fc3 0 50%) 0 0 / 80px 80px } iframe { border: 0; width: 100%; height: "
           "100% }</style><iframe src='" +
           url + "?transparent' allow=autoplay></iframe>";
  };
  {
    TestServer server(kSound);
    page.set(html(server.address()));
    Chromium browser;
    ASSERT_TRUE(browser.is_open());
    browser.open(page.origin(), 500, 500, false);
    for (int i = 0; i < 100 && browser.complaints().empty(); ++i) browser.evaluate("0");
    ASSERT_FALSE(browser.complaints().empty());
    EXPECT_THAT(browser.complaints().front(), HasSubstr("frame-ancestors"));
    EXPECT_EQ(server.viewers(), 0);
  }
  TestServer server(kSound, with_head({page.origin()}));
  page.set(html(server.address()));
  Chromium browser(kObs);
  ASSERT_TRUE(browser.is_open());
  browser.open(page.origin(), 500, 500, false);
  for (int i = 0; i < 600 && server.viewers() == 0; ++i) usleep(50000);
  EXPECT_EQ(server.viewers(), 1);
  Json seen;
  for (int i = 0; i < 120; ++i) {  // until the head is there
    seen = alphas(browser, picture("web_frame.png"));
    if (seen.contains("middle") && seen["middle"] != Json({255, 204, 51, 255}) &&
        seen["middle"] != Json({204, 51, 51, 255})) {
      break;
    }
    usleep(500000);
  }
  EXPECT_EQ(seen["corner"], Json({255, 204, 51, 255})) << "the page behind it";
  EXPECT_NE(seen["middle"], Json({255, 204, 51, 255}));
  EXPECT_NE(seen["middle"], Json({204, 51, 51, 255}));
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(PageElsewhere, IsABrowserSource) {
  TestServer server(kSound, with_head());
  Chromium browser(kObs);
  ASSERT_TRUE(browser.is_open());
  browser.make_background_transparent();
  browser.open(server.address() + "?transparent&zoom=1.3&left=10", 600, 700, false);
  browser.evaluate(
      "document.adoptedStyleSheets = [new CSSStyleSheet()], "
      "document.adoptedStyleSheets[0].replaceSync('" +
          std::string(kObsStyle) + "')",
      false);
  ASSERT_TRUE(wait_for(browser, "animeme.state === 'live' && animeme.shown > 20 && animeme.head",
                       150, false));
  EXPECT_EQ(browser.evaluate("[audio.muted, audio.paused, animeme.blocked]", false),
            Json({false, false, false}))
      << "it sounds by itself";
  EXPECT_EQ(browser.evaluate("document.body.innerText.trim()", false), "") << "nothing but a face";
  EXPECT_EQ(browser.evaluate("Math.round(animeme.head.camera.left * 180 / Math.PI)", false), 10);
  const Json seen = alphas(browser, picture("web_transparent.png"));
  ASSERT_TRUE(seen.contains("clear"));
  EXPECT_EQ(seen["width"], 600);
  EXPECT_EQ(seen["height"], 700);
  EXPECT_EQ(seen["corner"], Json({0, 0, 0, 0}));
  EXPECT_EQ(seen["middle"][3], 255);
  EXPECT_GT(double(seen["clear"]), 0.1);
  EXPECT_GT(double(seen["solid"]), 0.3);
  EXPECT_GT(double(seen["clear"]) + double(seen["solid"]), 0.97) << "but for the edges";
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

// A browser that plays nothing without a click, not even without sound, shows the face all the
// same.
TEST_F(PageElsewhere, TheFaceNeedsNoPlayer) {
  TestServer server(kSound);
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.call("Page.addScriptToEvaluateOnNewDocument", {{"source", R"(
    const play = HTMLMediaElement.prototype.play;
    HTMLMediaElement.prototype.play = function() {
      return window.clicked ? play.call(this)
                            : Promise.reject(new DOMException('a click first', 'NotAllowedError'));
    };)"}});
  browser.open(server.address() + "?transparent", 400, 400, false);
  ASSERT_TRUE(wait_for(browser, "animeme.session.soundless && animeme.shown > 20", 60, false));
  EXPECT_TRUE(wait_for(browser, "animeme.state === 'live'", 60, false));
  EXPECT_NE(browser.evaluate("getComputedStyle(sound).display", false), "none");
  browser.evaluate("window.clicked = true, sound.click()");
  EXPECT_TRUE(wait_for(browser,
                       "animeme.state === 'live' && !animeme.session.soundless && "
                       "!audio.muted && audio.currentTime > 1"));
  EXPECT_EQ(browser.evaluate("getComputedStyle(sound).display"), "none") << "nothing to ask for";
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

TEST_F(PageElsewhere, MutedIsNothingToAskFor) {
  TestServer server(kSound);
  Chromium browser;
  ASSERT_TRUE(browser.is_open());
  browser.open(server.address() + "?transparent&muted", 400, 400, false);
  ASSERT_TRUE(wait_for(browser, "animeme.state === 'live' && animeme.shown > 5", 60, false));
  EXPECT_EQ(
      browser.evaluate("[audio.muted, animeme.blocked, getComputedStyle(sound).display]", false),
      Json({true, false, "none"}));
  EXPECT_THAT(browser.complaints(), IsEmpty());
}

// Nobody is there to press Start when the stream is over and begins again.
TEST_F(PageElsewhere, ABrowserSourceComesBack) {
  std::optional<TestServer> server(std::in_place, kSound);
  const std::string address = server->address();
  Chromium browser(kObs);
  ASSERT_TRUE(browser.is_open());
  browser.open(address + "?transparent", 400, 400, false);
  ASSERT_TRUE(wait_for(browser, "animeme.state === 'live' && animeme.shown > 20", 60, false));
  server->finish();
  ASSERT_TRUE(wait_for(browser, "animeme.state === 'ended'", 60, false));
  server.reset();
  server.emplace(kSound, web::WebOptions{}, address);
  EXPECT_TRUE(wait_for(browser, "animeme.state === 'live'", 60, false));
}

}  // namespace embed_test
}  // namespace animeme::test
