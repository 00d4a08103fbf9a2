// Pages to test, and Chromium that looks at them.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "fap/tables.h"
#include "tests/readers/scripts.h"
#include "tests/support/folders.h"
#include "tools/view/viewer/detail/bytes.h"
#include "tools/view/viewer/viewer.h"

namespace animeme::test {
#define NEEDS_BROWSER()                  \
  NEEDS_PROGRAM("chromium", "chromium"); \
  if (!has_node()) GTEST_SKIP() << "node 18 or later is not installed (Debian package nodejs)"

inline constexpr int kSeconds = 11;
inline constexpr std::size_t kOpen = 1;  // the frame with an open mouth; frame 0 is neutral

inline fap::Frame frame_of(std::initializer_list<std::pair<int, int>> values) {
  fap::Frame frame;
  for (const auto& [fap, value] : values) frame.set(fap, value);
  return frame;
}

// Small values of all FAPs.
inline fap::Frame mixed_frame(unsigned seed) {
  std::mt19937 random(seed);
  fap::Frame frame;
  for (int f = fap::kFirstLowLevel; f <= fap::kFapCount; ++f) {
    const bool angle = fap::info(f).unit == fap::Unit::angle;
    const int size = angle ? 15000 : 220;
    frame.set(f, int(random() % unsigned(2 * size + 1)) - size);
  }
  return frame;
}

// Eight poses, then rest; from second to second five frames of open mouth.
inline fap::Sequence moving_clip() {
  fap::Sequence clip;
  clip.frames.push_back({});
  clip.frames.push_back(frame_of({{3, 500},
                                  {4, -200},
                                  {5, -600},
                                  {8, -150},
                                  {9, -150},
                                  {10, -420},
                                  {11, -420},
                                  {51, -200},
                                  {52, -600}}));
  clip.frames.push_back(frame_of({{4, 150},
                                  {5, 200},
                                  {8, 90},
                                  {10, 120},
                                  {9, 80},
                                  {11, 60},
                                  {12, 200},
                                  {13, -100}}));  // lips that would pass each other
  clip.frames.push_back(frame_of({{19, 900}, {21, 300}, {22, 400}}));
  clip.frames.push_back(frame_of({{3, 300},
                                  {14, 120},
                                  {15, -150},
                                  {48, 20000},
                                  {49, -35000},
                                  {50, 9000},
                                  {43, 80},
                                  {44, 200},
                                  {45, 150}}));
  clip.frames.push_back(frame_of({{23, 40000},
                                  {24, 30000},
                                  {25, -20000},
                                  {26, 15000},
                                  {27, 100},
                                  {29, 200},
                                  {30, -100},
                                  {19, -200}}));
  clip.frames.push_back(mixed_frame(1));
  clip.frames.push_back(mixed_frame(2));
  for (int i = int(clip.frames.size()); i < 25 * kSeconds; ++i) {
    clip.frames.push_back(i >= 25 && i % 25 < 5 ? clip.frames[kOpen] : fap::Frame());
  }
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    clip.frames[i].number = std::int64_t(i);
    for (std::size_t f = 3; f <= fap::kFapCount; ++f) clip.frames[i].mask.set(f);
    clip.frames[i].mask.reset(20);  // nobody carries it: the right lid follows its eye
  }
  return clip;
}

struct TestHead {
  head::Head head = *head::make_head();
  head::Rig rig = head::make_rig(head);
};

inline const TestHead& test_head() {
  static const TestHead made;
  return made;
}

// As a head of somebody else: nobody knows which vertices touch each other.
inline const TestHead& foreign_head() {
  static const TestHead made = [] {
    TestHead out = test_head();
    out.head.seams = {};
    out.rig = head::make_rig(out.head);
    return out;
  }();
  return made;
}

inline std::string make(const std::vector<viewer::Clip>& clips,
                        std::optional<viewer::Sound> sound = {}, dam::Script script = {},
                        const TestHead& head = test_head()) {
  const viewer::Page page{&head.head, &head.rig, clips, std::move(sound), std::move(script)};
  const auto html = viewer::make_page(page);
  EXPECT_TRUE(html) << html.error().describe();
  return html ? *html : std::string();
}

inline Bytes bytes_of(const std::string& text) { return Bytes(text.begin(), text.end()); }

// What a script reports of a page, in Chromium.
inline Json report_of(const std::string& kind, const std::string& html, const TempDir& dir) {
  const std::string path = dir.file("a page.html");
  write_bytes(path, bytes_of(html));
  return run_json("node '" + std::string(test::kSourceFolder) +
                  "/tests/view/viewer/js/viewer_report.js' " + kind + " '" + path + "' '" +
                  dir.file("") + "'");
}

/// A page with a canvas `face` and a script that has the head in `bytes` and goes on with `script`.
inline std::string page_of_head(const TestHead& h, const std::string& script) {
  return "<!doctype html><link rel=icon href='data:,'><canvas id=face style='width:200px'></canvas>"
         "<script type=module>" +
         std::string(viewer::head_script()) + "const bytes = fromBase64('" +
         viewer::detail::base64(viewer::pack_head(h.head, h.rig)) + "');\n" + script + "</script>";
}

// The software renderer of Chromium says how slow it is; that is not the page's doing.
inline std::vector<std::string> said(const Json& report) {
  std::vector<std::string> lines;
  for (const Json& message : report["messages"]) {
    const auto text = message["text"].get<std::string>();
    if (text.find("GPU stall due to ReadPixels") == std::string::npos) lines.push_back(text);
  }
  return lines;
}

}  // namespace animeme::test
