// The page in headless Chromium: sound and picture together, texts that stay texts, screens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/view/viewer/page_support.h"
#include "tools/formats/media/mux.h"
#include "tools/view/viewer/detail/bytes.h"

namespace animeme::test {
namespace page_test {

viewer::Sound sound_of(const media::Pcm& samples, const TempDir& dir) {
  media::MuxInput input;
  input.audio = &samples;
  EXPECT_TRUE(media::write_mp4(dir.file("sound.mp4"), input));
  return {read_bytes(dir.file("sound.mp4")), "audio/mp4"};
}

// How far pictures are from the sound that is heard with them, beyond the 40 ms that each is shown:
// seconds as people feel them. A click or burst begins at each second of the clip.
struct Apart {
  double worst = 0;
  int compared = 0;
};

Apart apart_of(const Json& report, double speed, double seconds) {
  const double zero = report["clicks"][0].get<double>() - 1 / speed;
  Apart apart;
  for (const Json& picture : report["pictures"]) {
    const double heard = (picture["clock"].get<double>() - zero) * speed;
    if (heard < 0.1 || heard > seconds) continue;
    ++apart.compared;
    const double begin = picture["frame"].get<double>() / 25;
    apart.worst = std::max({apart.worst, (begin - heard) / speed, (heard - begin - 0.04) / speed});
  }
  return apart;
}

TEST(Page, IsSmallAndWhole) {
  const std::string html = make({{moving_clip(), 0, "clip"}});
  EXPECT_LE(html.size(), 3'000'000u);
  for (const char* mark : {"<!--title-->", "/*style*/", "<!--data-->", "/*script*/"}) {
    EXPECT_EQ(html.find(mark), std::string::npos) << mark;
  }
  for (const char* part : {"http://", "https://", "import ", "src="}) {
    EXPECT_EQ(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html, make({{moving_clip(), 0, "clip"}}));
}

TEST(Page, RefusesWhatItCannotShow) {
  const TestHead& h = test_head();
  const viewer::Clip clip{moving_clip(), 0, "clip"};
  EXPECT_EQ(viewer::make_page({}).error().code, Code::invalid_argument);
  EXPECT_EQ(viewer::make_page({&h.head, &h.rig}).error().code, Code::invalid_argument);
  EXPECT_EQ(viewer::make_page({&h.head, &h.rig, {clip, clip, clip}}).error().code,
            Code::invalid_argument);
  EXPECT_EQ(viewer::make_page({&h.head, &h.rig, {viewer::Clip()}}).error().code,
            Code::invalid_argument);
}

TEST(Page, PictureFollowsTheSoundThatIsHeard) {
  NEEDS_BROWSER();
  const TempDir dir;
  std::vector<std::size_t> starts;
  for (std::size_t second = 1; second < kSeconds; ++second) starts.push_back(second * 48000);
  const media::Pcm clicks = make_clicks(48000, std::size_t(kSeconds) * 48000, starts);
  const std::string html = make({{moving_clip(), 0, "clip"}}, sound_of(clicks, dir));
  EXPECT_LE(html.size(), 3'000'000u);
  const Json report = report_of("sound", html, dir);
  ASSERT_TRUE(report.contains("clicks"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  EXPECT_EQ(report["state"]["sound"], true);
  ASSERT_EQ(report["clicks"].size(), 10u);
  for (std::size_t i = 0; i < 10; ++i) {
    EXPECT_NEAR(report["clicks"][i].get<double>(), report["clicks"][0].get<double>() + double(i),
                0.002);
  }
  const Apart apart = apart_of(report, 1, 10);
  EXPECT_GE(apart.compared, 2);  // hundreds where somebody looks; a machine without a GPU is slow
  EXPECT_LT(apart.worst, 0.04);
  RecordProperty("compared", apart.compared);
  RecordProperty("worst_seconds", std::to_string(apart.worst));
}

TEST(Page, OtherSpeedsKeepThePitchAndTheTime) {
  NEEDS_BROWSER();
  const TempDir dir;
  media::Pcm tones{48000, std::vector<float>(48000 * 4)};
  for (std::size_t second = 1; second < 4; ++second) {
    for (std::size_t i = 0; i < 9600; ++i) {
      tones.samples[second * 48000 + i] =
          float(0.5 * std::sin(2 * std::numbers::pi * 440 * double(i) / 48000));
    }
  }
  const Json report =
      report_of("speeds", make({{moving_clip(), 0, "clip"}}, sound_of(tones, dir)), dir);
  EXPECT_EQ(said(report), std::vector<std::string>());
  for (const auto& [name, speed] : {std::pair("0.5", 0.5), std::pair("2", 2.0)}) {
    ASSERT_TRUE(report.contains(name));
    const Json& heard = report[name];
    EXPECT_EQ(heard["state"]["rate"], speed);
    ASSERT_EQ(heard["clicks"].size(), 3u) << name;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(heard["pitches"][i].get<double>(), 440, 26) << name;  // two periods
      EXPECT_NEAR(heard["clicks"][i].get<double>(),
                  heard["clicks"][0].get<double>() + double(i) / speed, 0.02 / speed)
          << name;
    }
    const Apart apart = apart_of(heard, speed, 3);
    EXPECT_GE(apart.compared, 1);
    EXPECT_LT(apart.worst, 0.04);
    RecordProperty(std::string("worst_seconds_") + (speed < 1 ? "half" : "double"),
                   std::to_string(apart.worst));
  }
}

media::Pcm bursts_of(double hertz, std::size_t seconds) {
  media::Pcm tones{48000, std::vector<float>(48000 * seconds)};
  for (std::size_t second = 1; second < seconds; ++second) {
    for (std::size_t i = 0; i < 9600; ++i) {
      tones.samples[second * 48000 + i] =
          float(0.5 * std::sin(2 * std::numbers::pi * hertz * double(i) / 48000));
    }
  }
  return tones;
}

dam::Script saying(const std::string& word) {
  dam::Script script;
  script.phones = {{0, 6, "AA", word}};
  return script;
}

// Two languages: what is heard, seen and said changes together while it plays.
TEST(Page, LanguagesChangeWhileItPlays) {
  NEEDS_BROWSER();
  const TempDir dir;
  viewer::Page page{&test_head().head,
                    &test_head().rig,
                    {{moving_clip(), 0, "clip"}},
                    sound_of(bursts_of(440, 6), dir),
                    saying("hello")};
  page.lang = "en";
  page.tracks.push_back(
      {"de", "Ann", {moving_clip(), 0, "clip"}, sound_of(bursts_of(880, 6), dir), saying("hallo")});
  const auto html = viewer::make_page(page);
  ASSERT_TRUE(html) << html.error().describe();
  const Json report = report_of("tracks", *html, dir);
  ASSERT_TRUE(report.contains("clicks"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  EXPECT_EQ(report["list"], Json::parse(R"(["English", "Ann, Deutsch"])"));
  EXPECT_EQ(report["state"]["lang"], "de");
  EXPECT_EQ(report["back"]["lang"], "en");
  EXPECT_EQ(report["back"]["sound"], true);
  EXPECT_EQ(report["asked"]["lang"], "de");
  ASSERT_EQ(report["clicks"].size(), 5u);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(report["pitches"][i].get<double>(), i < 2 ? 440 : 880, 26) << i;
  // From then on German words and the German face go with the German sound.
  const double zero = report["clicks"][2].get<double>() - 3;
  int compared = 0;
  bool german = false;
  for (const Json& picture : report["pictures"]) {
    german = german || picture["lang"] == "de";
    EXPECT_EQ(picture["lang"], german ? "de" : "en");
    const std::string now = picture["said"];
    const double heard = picture["clock"].get<double>() - zero;
    if (!german || heard < 2.8 || heard > 5) continue;
    ++compared;
    EXPECT_EQ(now.substr(0, 5), "hallo");
    const double begin = picture["frame"].get<double>() / 25;
    EXPECT_LT(std::max(begin - heard, heard - begin - 0.04), 0.04);
  }
  EXPECT_GE(compared, 1);
  page.clips.push_back({moving_clip(), 0, "other"});
  EXPECT_EQ(viewer::make_page(page).error().code, Code::invalid_argument);
}

TEST(Page, SaysLinesAndShowsTheWave) {
  NEEDS_BROWSER();
  const TempDir dir;
  media::Pcm tones{48000, std::vector<float>(48000 * 4)};
  for (std::size_t second = 1; second < 4; ++second) {
    for (std::size_t i = 0; i < 9600; ++i) {
      tones.samples[second * 48000 + i] =
          float(0.2 / double(second) * std::sin(2 * std::numbers::pi * 440 * double(i) / 48000));
    }
  }
  const dam::Script script{{{0, 1, "SIL", ""},
                            {1, 1.1, "B", "bin"},
                            {1.1, 1.2, "IH", "bin"},
                            {1.2, 1.5, "UW", "blue"},
                            {1.5, 3, "SIL", ""},
                            {3, 3.4, "AW", "now"}}};
  const Json report =
      report_of("says", make({{moving_clip(), 0, "clip"}}, sound_of(tones, dir), script), dir);
  EXPECT_EQ(said(report), std::vector<std::string>());
  const auto at = [&](const char* time) {
    const Json& now = report["said"][time];
    return now["line"].get<std::string>() + "|" + now["spoken"].get<std::string>() + "|" +
           now["phone"].get<std::string>();
  };
  EXPECT_EQ(at("0.5"), "||");
  EXPECT_EQ(at("0.8"), "bin blue ||") << "a line is there before it is spoken";
  EXPECT_EQ(at("1.15"), "bin blue IH|bin|IH");
  EXPECT_EQ(at("1.3"), "bin blue UW|blue|UW");
  EXPECT_EQ(at("2.5"), "||");
  EXPECT_EQ(at("3.1"), "now AW|now|AW") << "what comes behind a pause is a line of its own";
  // The largest sample fills the row, half of it half; silence is a line.
  const Json& wave = report["wave"];
  ASSERT_EQ(wave.size(), 4u);  // at 0.55, 1.1, 1.55 and 2.1 s
  EXPECT_LE(wave[0], 3);
  EXPECT_GE(wave[1], 28);
  EXPECT_LE(wave[2], 3);
  EXPECT_NEAR(wave[3].get<double>(), wave[1].get<double>() / 2, 3);
}

TEST(Page, TextsStayTexts) {
  NEEDS_BROWSER();
  const TempDir dir;
  const std::string evil = "</script><img src=x onerror='window.hacked=1'>&amp;\"<!--\xff";
  const std::string shown = "</script><img src=x onerror='window.hacked=1'>&amp;\"<!--\xEF\xBF\xBD";
  dam::Script script;
  script.phones.push_back({0, 0.5, "</title>", "</script><script>window.hacked=2</script>"});
  fap::Sequence other = moving_clip();
  other.frames[2].set(3, 100);
  const Json report =
      report_of("texts", make({{moving_clip(), 0, evil}, {other, 0, evil}}, {}, script), dir);
  ASSERT_TRUE(report.contains("texts"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  const Json& texts = report["texts"];
  EXPECT_EQ(texts["hacked"], "undefined");
  EXPECT_EQ(texts["title"], shown);
  EXPECT_EQ(texts["heading"], shown + " / " + shown);
  EXPECT_EQ(texts["name"], shown);
  EXPECT_EQ(texts["now"], "</script><script>window.hacked=2</script> </title>");
  EXPECT_EQ(texts["spoken"], "</script><script>window.hacked=2</script>");
  EXPECT_EQ(texts["images"], 0);
  EXPECT_EQ(texts["scripts"], 5);  // facts, model, two clips, the program
  EXPECT_THAT(texts["readout"].get<std::string>(), testing::StartsWith("13.2 FAP units RMS"));
  for (const char* mode : {"first", "second", "side", "ghost", "heat"}) {
    EXPECT_EQ(report["modes"][mode], mode);
  }
  const Json& keys = report["keys"];
  EXPECT_EQ(keys["wire"], true);
  EXPECT_EQ(keys["points"], true);
  EXPECT_EQ(keys["between"], false);
  EXPECT_EQ(report["help"], true);
  const Json& nohead = report["nohead"];
  EXPECT_EQ(nohead["head"], false);
  EXPECT_EQ(nohead["frame"], 3);
  EXPECT_EQ(nohead["faps"], Json::parse("[3, 51]"));
  EXPECT_EQ(nohead["rate"], 0.5);
  EXPECT_EQ(nohead["loop"], Json::parse("[0.2, 0.4]"));
  const Json& played = report["played"];
  EXPECT_EQ(played["playing"], true);
  EXPECT_GE(played["position"], 0.2);
  EXPECT_LT(played["position"], 0.4);
}

// On desktops and phones, upright and lying: nothing is cut off or lies over something else, and
// fingers find what they look for.
TEST(Page, FitsTheScreen) {
  NEEDS_BROWSER();
  const TempDir dir;
  dam::Script script;
  script.phones.push_back({0, 0.5, "AH", "word"});
  fap::Sequence other = moving_clip();
  other.frames[2].set(48, 100);
  const std::string long_name = "a rather long name of a file that somebody gave to a clip.fap";
  const viewer::Sound sound = sound_of({48000, std::vector<float>(48000)}, dir);
  const Json report = report_of(
      "screens", make({{moving_clip(), 0, "a.fap"}, {other, 0, long_name}}, sound, script), dir);
  ASSERT_TRUE(report.contains("messages"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  int screens = 0;
  for (const auto& [size, screen] : report.items()) {
    if (size == "messages") continue;
    ++screens;
    EXPECT_EQ(screen["overlaps"], Json::array()) << size;
    EXPECT_EQ(screen["outside"], Json::array()) << size;
    EXPECT_EQ(screen["width"].get<int>(), std::stoi(size)) << size;
    EXPECT_LT(screen["chin"], screen["said"]) << size;
    const bool lying = size != "390x844" && size != "320x568";
    EXPECT_EQ(screen["legend"], lying ? "flex" : "none") << size;
    EXPECT_GT(screen["targets"].size(), 70u) << size;
    for (const Json& target : screen["targets"]) {
      const double least = screen["touch"].get<bool>() ? 36 : 18;
      EXPECT_GE(target["width"].get<double>(), least) << size << " " << target;
      EXPECT_GE(target["height"].get<double>(), least) << size << " " << target;
    }
  }
  EXPECT_EQ(screens, 6);
}

// What README.md says about pages with motion of their own: the feature points that a page shows
// for `values`, a script, as JSON.
Json shown(const TestHead& h, const std::string& values, const TempDir& dir) {
  const std::string html =
      page_of_head(h,
                   "const view = new HeadView(document.getElementById('face'), readModel(bytes));\n"
                   "view.camera.listen(view.canvas);\n"
                   "const at = () => view.model.points.map(({part, vertex}) =>\n"
                   "    [...view.rigs[0].placed(part).slice(vertex * 3, vertex * 3 + 3)]);\n"
                   "view.show(" +
                       values + ");\nwindow.result = at();");
  const Json report = report_of("live", html, dir);
  EXPECT_EQ(said(report), std::vector<std::string>());
  return report.value("result", Json::array());
}

void expect_points(const TestHead& h, const fap::Frame& frame, const Json& is) {
  const head::Pose pose = head::pose(h.rig, frame);
  std::size_t next = 0;
  for (const head::FeaturePoint& point : h.head.feature_points) {
    if (!point.exists()) continue;
    ASSERT_LT(next, is.size());
    const auto part = std::size_t(point.part);
    const auto& places =
        pose.positions[part].empty() ? h.rig.parts[part].positions : pose.positions[part];
    const head::Vec3 want = pose.transforms[part](places[point.vertex]);
    const Json& place = is[next++];
    EXPECT_LT(length(want - head::Vec3{place[0], place[1], place[2]}), 0.02f);
  }
  EXPECT_EQ(next, is.size());
}

TEST(Page, HeadTakesValuesFromElsewhere) {
  NEEDS_BROWSER();
  const TempDir dir;
  fap::Frame frame = frame_of({{3, 100}, {25, 20000}});
  frame.mask.set(1);
  frame.viseme = {.select1 = 10, .select2 = 0, .blend = 40};
  expect_points(
      test_head(), frame,
      shown(test_head(), "{1: {select1: 10, select2: 0, blend: 40}, 3: 100, 25: 20000}", dir));
}

// As avatars do: shapes of their maker, which are fitted to each frame.
TestHead head_with_shapes() {
  TestHead out;
  const auto targets = out.rig.targets;
  for (const auto& [fap, value] : std::vector<std::pair<int, int>>{
           {3, 700}, {5, -500}, {12, 200}, {13, 200}, {19, 1000}, {20, 1000}, {51, -200}}) {
    head::ShapeControl shape;
    shape.name = "shape" + std::to_string(fap);
    shape.faps.set(fap, value);
    for (head::Target target : targets) {
      if (target.control != fap) continue;
      target.control = head::kFirstShape + int(out.head.shapes.size());
      for (head::Vec3& delta : target.deltas) delta *= float(value) / head::kFullShape;
      target.low = 0;
      target.high = head::kFullShape;
      out.head.targets.push_back(std::move(target));
    }
    out.head.shapes.push_back(std::move(shape));
  }
  out.rig = head::make_rig(out.head);
  return out;
}

TEST(Page, ShapesOfAnAvatarFollowFaps) {
  NEEDS_BROWSER();
  const TempDir dir;
  const TestHead avatar = head_with_shapes();
  const fap::Frame frame =
      frame_of({{3, 400}, {5, -300}, {12, 100}, {13, 60}, {19, 500}, {48, 9000}});
  const head::Pose open = head::pose(avatar.rig, frame), rest = head::pose(avatar.rig, {});
  const std::uint32_t lip = avatar.head.point("2.3").vertex;
  ASSERT_LT(open.positions[0][lip].y, rest.positions[0][lip].y - 0.3f);
  expect_points(avatar, frame,
                shown(avatar, "{3: 400, 5: -300, 12: 100, 13: 60, 19: 500, 48: 9000}", dir));
}

}  // namespace page_test
}  // namespace animeme::test
