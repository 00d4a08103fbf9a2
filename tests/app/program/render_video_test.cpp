// `animeme render` to video and `mux --preview`: what any player shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "fap/text.h"
#include "tests/support/program.h"

namespace animeme {
namespace render_video_test {

using nlohmann::json;
using test::animeme;
using test::spill;
using test::TempDir;
using testing::HasSubstr;

// One second of a jaw that opens and closes, and a tone.
void write_talk(const TempDir& dir) {
  fap::Sequence clip{{10, 1}, {}, "talk"};
  for (int i = 0; i < 10; ++i) {
    fap::Frame frame;
    frame.number = i;
    frame.set(3, i % 4 * 150);
    frame.set(5, -(i % 4) * 200);
    clip.frames.push_back(frame);
  }
  spill(dir / "talk.fap", fap::write_text(clip));
  std::string wav = "RIFF....WAVEfmt ";
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) wav += char(value >> (8 * i) & 255);
  };
  put(16, 4), put(1, 2), put(1, 2), put(16000, 4), put(32000, 4), put(2, 2), put(16, 2);
  wav += "data";
  put(32000, 4);
  for (int i = 0; i < 16000; ++i) {
    put(std::uint32_t(std::lround(8000 * std::sin(0.1 * i))) & 0xFFFF, 2);
  }
  spill(dir / "voice.wav", wav);
}

json info_of(const std::string& path) {
  const auto out = animeme({"info", path, "--json"});
  EXPECT_EQ(out.exit_code, 0) << out.err;
  return json::parse(out.out, nullptr, false);
}

const json& track(const json& info, const std::string& kind) {
  for (const json& entry : info["tracks"]) {
    if (entry["kind"] == kind) return entry;
  }
  ADD_FAILURE() << "no " << kind << " in " << info.dump(1);
  return info;
}

bool lacks_encoder(const test::ProgramResult& out) {
  return out.err.find("built without") != std::string::npos;
}

TEST(RenderVideo, PicturesAndSoundOfTheClip) {
  const TempDir dir;
  write_talk(dir);
  for (const auto& [name, codec] : {std::pair{"talk.mp4", "h264"}, std::pair{"talk.webm", "vp9"},
                                    std::pair{"talk.mov", "prores"}}) {
    const auto out = animeme({"render", dir / "talk.fap", "--audio", dir / "voice.wav", "--size",
                              "97x65", "-o", dir / name});
    if (lacks_encoder(out)) GTEST_SKIP() << out.err;
    ASSERT_EQ(out.exit_code, 0) << out.err;
    EXPECT_THAT(out.err, HasSubstr("10 pictures, 96x64, 10 per second"));
    const json info = info_of(dir / name);
    EXPECT_EQ(track(info, "video")["codec"], codec);
    EXPECT_EQ(track(info, "video")["width"], 96);
    EXPECT_NEAR(info["seconds"].get<double>(), 1.0, 0.06);
    EXPECT_EQ(info["tracks"].size(), 2u);
    track(info, "audio");
  }
}

TEST(RenderVideo, AnyRateAStripAndNoSound) {
  const TempDir dir;
  write_talk(dir);
  spill(dir / "talk.tsv", "start_s\tend_s\tphone\n0\t0.4\tSIL\n0.4\t0.7\tAA\n0.7\t1\tM\n");
  const auto out =
      animeme({"render", dir / "talk.fap", "--rate", "29.97", "--script", dir / "talk.tsv",
               "--curves", "open_jaw,5", "--size", "160x200", "-o", dir / "talk.mkv"});
  if (lacks_encoder(out) || out.err.find("cannot draw SVG") != std::string::npos) {
    GTEST_SKIP() << out.err;
  }
  ASSERT_EQ(out.exit_code, 0) << out.err;
  EXPECT_THAT(out.err, HasSubstr("30 pictures"));
  EXPECT_EQ(info_of(dir / "talk.mkv")["tracks"].size(), 1u);
}

TEST(RenderVideo, APreviewBesideTheFace) {
  const TempDir dir;
  write_talk(dir);
  const auto out = animeme({"mux", dir / "talk.fap", dir / "voice.wav", "-o", dir / "talk.mp4",
                            "--preview", dir / "talk.preview.mp4"});
  if (lacks_encoder(out)) GTEST_SKIP() << out.err;
  ASSERT_EQ(out.exit_code, 0) << out.err;
  track(info_of(dir / "talk.mp4"), "face");
  const json preview = info_of(dir / "talk.preview.mp4");
  track(preview, "video");
  track(preview, "audio");
  EXPECT_EQ(preview["tracks"].size(), 2u);
}

TEST(RenderVideo, SpeechHasAPreviewWithoutAFaceTrack) {
  const TempDir dir;
  spill(dir / "talk.tsv", "start_s\tend_s\tphone\n0\t0.2\tSIL\n0.2\t0.5\tAA\n0.5\t0.8\tM\n");
  for (const char* name : {"talk.preview.mp4", "talk.webm"}) {
    const auto out = animeme(
        {"speak", "--script", dir / "talk.tsv", "-o", dir / "talk.mp4", "--preview", dir / name});
    if (lacks_encoder(out)) GTEST_SKIP() << out.err;
    ASSERT_EQ(out.exit_code, 0) << out.err;
    const json preview = info_of(dir / name);
    track(preview, "video");
    EXPECT_EQ(preview["tracks"].size(), 1u) << name;
  }
}

TEST(RenderVideo, WhatCannotBeIsSaid) {
  const TempDir dir;
  write_talk(dir);
  EXPECT_EQ(animeme({"render", dir / "talk.fap", "--time", "0.5", "-o", dir / "a.mp4"}).exit_code,
            2);
  EXPECT_EQ(animeme({"render", dir / "talk.fap", "-o", dir / "a.avi"}).exit_code, 2);
  const auto curve = animeme({"render", dir / "talk.fap", "--curves", "jaw", "-o", dir / "a.mp4"});
  EXPECT_EQ(curve.exit_code, 2);
  EXPECT_THAT(curve.err, HasSubstr("jaw is not a FAP"));
  const auto preview = animeme({"mux", dir / "talk.fap", dir / "voice.wav", "-o", dir / "talk.mp4",
                                "--preview", dir / "talk.gif"});
  EXPECT_EQ(preview.exit_code, 2);
}

// Without a background a video has a second picture of alpha in each block (Matroska:
// BlockAdditions, 75 A1, and the tag ALPHA_MODE), and pictures have alpha.
TEST(RenderVideo, Transparent) {
  const TempDir dir;
  write_talk(dir);
  const auto out = animeme({"render", dir / "talk.fap", "--size", "96x96", "--background", "none",
                            "-o", dir / "talk.webm"});
  if (lacks_encoder(out)) GTEST_SKIP() << out.err;
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const std::string video = test::slurp(dir / "talk.webm");
  std::size_t beside = 0;
  for (std::size_t at = video.find("\x75\xA1"); at != std::string::npos;
       at = video.find("\x75\xA1", at + 1))
    ++beside;
  EXPECT_GE(beside, 10u);
  EXPECT_THAT(video, HasSubstr("ALPHA_MODE"));

  // ProRes 4444, whose sample entry says 32 bits a pixel where there is alpha.
  const auto edited = animeme({"render", dir / "talk.fap", "--size", "96x96", "--background",
                               "none", "-o", dir / "talk.mov"});
  ASSERT_EQ(edited.exit_code, 0) << edited.err;
  const std::string movie = test::slurp(dir / "talk.mov");
  const std::size_t entry = movie.find("ap4h");
  ASSERT_LT(entry + 80, movie.size());
  EXPECT_EQ(movie[entry + 79], 32);

  const auto frames = animeme({"render", dir / "talk.fap", "--size", "64x64", "--background",
                               "none", "-o", dir / "f_%03d.png"});
  ASSERT_EQ(frames.exit_code, 0) << frames.err;
  EXPECT_THAT(frames.err, HasSubstr("10 pictures"));
  for (const char* name : {"f_001.png", "f_010.png"}) {
    const std::string png = test::slurp(dir / name);
    ASSERT_GT(png.size(), 100u) << name;
    EXPECT_EQ(png[25], 6) << "RGBA";
  }
  EXPECT_EQ(test::slurp(dir / "f_011.png"), "");

  for (const char* name : {"talk.mp4", "talk.jpg"}) {
    const auto none =
        animeme({"render", dir / "talk.fap", "--background", "none", "-o", dir / name});
    EXPECT_EQ(none.exit_code, 2) << name;
    EXPECT_THAT(none.err, HasSubstr("transparency"));
  }
  const auto odd =
      animeme({"render", dir / "talk.fap", "--background", "whit", "-o", dir / "x.mp4"});
  EXPECT_EQ(odd.exit_code, 2);
  EXPECT_THAT(odd.err, HasSubstr("is no background"));
}

TEST(RenderVideo, Captions) {
  const TempDir dir;
  write_talk(dir);
  spill(dir / "words.tsv",
        "start_s\tend_s\tphone\tword\n0.1\t0.5\tHH\thello\n0.5\t0.9\tW\tworld\n");
  const auto rendered = [&](const char* name, const std::vector<std::string>& more) {
    std::vector<std::string> line = {"render", dir / "talk.fap", "--size", "128x128",
                                     "-o",     dir / name};
    line.insert(line.end(), more.begin(), more.end());
    return animeme(line);
  };
  const auto with = rendered("a_%d.png", {"--captions", "--script", dir / "words.tsv"});
  if (with.exit_code != 0 && with.err.find("SVG") != std::string::npos) GTEST_SKIP() << with.err;
  ASSERT_EQ(with.exit_code, 0) << with.err;
  ASSERT_EQ(rendered("b_%d.png", {"--script", dir / "words.tsv"}).exit_code, 0);
  EXPECT_NE(test::slurp(dir / "a_3.png"), test::slurp(dir / "b_3.png"));
  const auto unknown = rendered("c.mp4", {"--captions"});
  EXPECT_NE(unknown.exit_code, 0);
  EXPECT_THAT(unknown.err, HasSubstr("--script"));
  EXPECT_EQ(
      rendered("d.png", {"--captions", "--time", "0.5", "--script", dir / "words.tsv"}).exit_code,
      2);
}

}  // namespace render_video_test
}  // namespace animeme
