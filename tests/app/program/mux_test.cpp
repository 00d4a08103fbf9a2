// mux and demux through the program: codecs, formats, segments, and an end by a signal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"

namespace animeme {
namespace mux_test {

using test::animeme;
using test::TempDir;
using testing::HasSubstr;

// 8 bits, 8 kHz.
void write_noise(const std::string& path, std::uint32_t seconds) {
  const std::uint32_t bytes = seconds * 8000;
  std::string wav = "RIFF....WAVEfmt ";
  const auto number = [&](std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) wav += char(value >> (8 * i) & 255);
  };
  number(16, 4);
  number(1, 2);
  number(1, 2);
  number(8000, 4);
  number(8000, 4);
  number(1, 2);
  number(8, 2);
  wav += "data";
  number(bytes, 4);
  std::uint32_t state = 1;
  for (std::uint32_t i = 0; i < bytes; ++i) {
    state = state * 1664525u + 1013904223u;
    wav += char(state >> 24);
  }
  test::spill(path, wav);
}

std::string sample() { return (test::data_dir() / "containers" / "std_aac.mp4").string(); }

std::string codec_of_sound(const std::string& path) {
  const auto info = animeme({"info", path, "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  const auto json = nlohmann::json::parse(info.out, nullptr, false);
  if (!json.is_object()) return "";
  for (const auto& track : json["tracks"]) {
    if (track["kind"] == "audio") return track["codec"];
  }
  return "none";
}

TEST(MuxCommand, TheFaceStaysTheSameInEveryFormat) {
  const TempDir dir;
  ASSERT_EQ(animeme({"demux", sample(), "--face", dir / "in.fba"}).exit_code, 0);
  struct Way {
    const char* file;
    std::vector<std::string> options;
    const char* codec;
  };
  for (const Way& way :
       {Way{"a.mp4", {}, "aac"}, Way{"b.mp4", {"--audio-codec", "opus"}, "opus"},
        Way{"c.mp4", {"--fragmented"}, "aac"},
        Way{"d.mkv", {"--audio-codec", "opus", "--audio-bitrate", "24000"}, "opus"},
        Way{"e.ts", {"--audio-codec", "copy"}, "aac"}, Way{"f.m3u8", {}, "aac"},
        Way{"g.mpd", {"--fragment-seconds", "1"}, "aac"}}) {
    SCOPED_TRACE(way.file);
    std::vector<std::string> arguments = {"mux", sample(), sample(), "-o", dir / way.file};
    arguments.insert(arguments.end(), way.options.begin(), way.options.end());
    const auto muxed = animeme(arguments);
    ASSERT_EQ(muxed.exit_code, 0) << muxed.err;
    EXPECT_EQ(codec_of_sound(dir / way.file), way.codec);
    ASSERT_EQ(animeme({"demux", dir / way.file, "--face", dir / "out.fba"}).exit_code, 0);
    EXPECT_EQ(test::slurp(dir / "out.fba"), test::slurp(dir / "in.fba"));
  }
}

std::size_t face_bytes(const std::string& path) {
  const TempDir dir;
  EXPECT_EQ(animeme({"demux", path, "-o", dir / "face.fba"}).exit_code, 0);
  return test::slurp(dir / "face.fba").size();
}

TEST(MuxCommand, SmallIsSmallerWithoutAVisibleError) {
  const TempDir dir;
  ASSERT_EQ(animeme({"speak", "-q", "--text", "Small streams move the same lips.", "-o",
                     dir / "talk.fap"})
                .exit_code,
            0);
  for (const char* name : {"a.mp4", "a.m3u8"}) {
    SCOPED_TRACE(name);
    const std::vector<std::string> line = {"mux", dir / "talk.fap", "--intra-seconds", "1", "-o"};
    auto plain = line, small = line;
    plain.push_back(dir / name);
    small.insert(small.end(), {dir / (std::string("small_") + name), "--small"});
    ASSERT_EQ(animeme(plain).exit_code, 0);
    ASSERT_EQ(animeme(small).exit_code, 0);
    EXPECT_LT(face_bytes(small[5]), face_bytes(plain[5]) * 3 / 4);
    const auto compared = animeme({"compare", dir / "talk.fap", small[5]});
    const std::size_t error = compared.out.find("error: ");
    ASSERT_NE(error, std::string::npos) << compared.out;
    EXPECT_LT(std::stod(compared.out.substr(error + 7)), 1.1);  // quantiser steps
  }
}

// A stream of one intra plane, as encode writes it, of 20 s.
void write_long_stream(const TempDir& dir) {
  std::string text = "2.1 long 25 500\n";
  std::string mask(68 * 2, ' ');
  for (std::size_t fap = 0; fap < 68; ++fap) mask[2 * fap] = fap == 2 ? '1' : '0';
  for (int i = 0; i < 500; ++i) {
    text += mask + "\n" + std::to_string(i) + " " + std::to_string(i * 37 % 400) + "\n";
  }
  test::spill(dir / "long.fap", text);
  ASSERT_EQ(animeme({"encode", dir / "long.fap", "--quant", "3", "-o", dir / "long.fba"}).exit_code,
            0);
  write_noise(dir / "long.wav", 20);
}

std::size_t segments_of(const std::string& playlist) {
  const std::string text = test::slurp(playlist);
  std::size_t count = 0;
  for (auto at = text.find("#EXTINF"); at != text.npos; at = text.find("#EXTINF", at + 1)) ++count;
  return count;
}

TEST(MuxCommand, AStreamOfOneIntraPlaneIsCodedAgainForSegments) {
  const TempDir dir;
  write_long_stream(dir);
  const std::vector<std::string> mux = {"mux", dir / "long.fba", dir / "long.wav", "-o"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = mux;
    all.insert(all.end(), more.begin(), more.end());
    return animeme(all);
  };
  const auto again = with({dir / "a.m3u8"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("encoded again, so that a segment can start every 5.00 s"));
  EXPECT_THAT(again.err, HasSubstr("--copy keeps it"));
  EXPECT_EQ(segments_of(dir / "a_hls/face.m3u8"), 4u);
  // The same values, since the quantiser is the same.
  ASSERT_EQ(animeme({"decode", dir / "long.fba", "-o", dir / "one.fap"}).exit_code, 0);
  ASSERT_EQ(animeme({"decode", dir / "a.m3u8", "-o", dir / "four.fap"}).exit_code, 0);
  const auto body = [](const std::string& text) { return text.substr(text.find("25 500")); };
  EXPECT_EQ(body(test::slurp(dir / "one.fap")), body(test::slurp(dir / "four.fap")));

  const auto closer = with({dir / "b.m3u8", "--intra-seconds", "2"});
  ASSERT_EQ(closer.exit_code, 0) << closer.err;
  EXPECT_EQ(segments_of(dir / "b_hls/face.m3u8"), 10u);
  const auto second = animeme({"mux", dir / "b.m3u8", dir / "long.wav", "-o", dir / "c.m3u8"});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.err, testing::Not(HasSubstr("coded again"))) << "close enough";

  const auto copy = with({dir / "d.mpd", "--copy"});
  ASSERT_EQ(copy.exit_code, 0) << copy.err;
  EXPECT_THAT(copy.err, HasSubstr("segments last up to 20.00 s"));
  ASSERT_EQ(animeme({"demux", dir / "d.mpd", "--face", dir / "d.fba"}).exit_code, 0);
  ASSERT_EQ(with({dir / "e.mp4"}).exit_code, 0) << "others keep the stream";
  ASSERT_EQ(animeme({"demux", dir / "e.mp4", "--face", dir / "e.fba"}).exit_code, 0);
  EXPECT_EQ(test::slurp(dir / "d.fba"), test::slurp(dir / "e.fba"));
  const auto one = with({dir / "f.m3u8", "--intra-seconds", "0"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(segments_of(dir / "f_hls/face.m3u8"), 1u);
}

TEST(DemuxCommand, JsonTellsWhatWasTaken) {
  const TempDir dir;
  const auto done = animeme({"demux", sample(), "--face", dir / "a.fba", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto json = nlohmann::json::parse(done.out, nullptr, false);
  ASSERT_TRUE(json.is_object()) << done.out;
  EXPECT_EQ(json["face"]["planes"], 250);
  EXPECT_EQ(json["face"]["format"], "mp4");
  EXPECT_EQ(json["face"]["timescale"], 25000);
  EXPECT_EQ(json["face"]["bytes"], test::slurp(dir / "a.fba").size());
  EXPECT_FALSE(json.contains("audio"));
  EXPECT_EQ(animeme({"demux", sample(), "--face", "-", "--json"}).exit_code, 2);
}

TEST(DemuxCommand, EndingsTellWhatIsTaken) {
  const TempDir dir;
  const auto done = animeme({"demux", sample(), "-o", dir / "a.fba", "-o", dir / "a.wav"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  ASSERT_EQ(
      animeme({"demux", sample(), "--face", dir / "b.fba", "--audio", dir / "b.wav"}).exit_code, 0);
  EXPECT_EQ(test::slurp(dir / "a.fba"), test::slurp(dir / "b.fba"));
  EXPECT_EQ(test::slurp(dir / "a.wav"), test::slurp(dir / "b.wav"));
  EXPECT_EQ(animeme({"demux", sample(), "-o", "-"}).out, test::slurp(dir / "a.fba"));
  const auto text = animeme({"demux", sample(), "-o", dir / "c.fap"});
  EXPECT_EQ(text.exit_code, 2);
  EXPECT_THAT(text.err, HasSubstr("decode writes text"));
  EXPECT_EQ(animeme({"demux", sample(), "-o", dir / "c.fba", "--face", dir / "d.fba"}).exit_code,
            2);
  EXPECT_EQ(animeme({"demux", sample()}).exit_code, 2);
  EXPECT_EQ(dir.count(), 4u);
}

TEST(MuxCommand, RefusalsNameTheRemedy) {
  const TempDir dir;
  const auto ts = animeme({"mux", sample(), sample(), "--audio-codec", "opus", "-o", dir / "a.ts"});
  EXPECT_EQ(ts.exit_code, 3);
  EXPECT_THAT(ts.err, HasSubstr("does not support opus; code the sound as aac"));
  const auto pipe = animeme({"mux", sample(), sample(), "-o", "-"});
  EXPECT_EQ(pipe.exit_code, 3);
  EXPECT_THAT(pipe.err, HasSubstr("standard output"));
  write_noise(dir / "a.wav", 1);
  const auto copy =
      animeme({"mux", sample(), dir / "a.wav", "--audio-codec", "copy", "-o", dir / "a.mp4"});
  EXPECT_EQ(copy.exit_code, 3);
  EXPECT_THAT(copy.err, HasSubstr("only aac and opus can be taken as they are"));
  EXPECT_EQ(
      animeme({"mux", sample(), sample(), "--audio-codec", "mp3", "-o", dir / "a.mp4"}).exit_code,
      2);
  EXPECT_EQ(dir.files().size(), 1u) << "nothing is left but the sound";
}

TEST(MuxCommand, ASignalEndsTheFileInOrder) {
  const TempDir dir;
  write_noise(dir / "long.wav", 30 * 60);
  for (const char* name : {"a.mp4", "a.m3u8"}) {
    SCOPED_TRACE(name);
    // The signal is sent when the temporary file has some content.
    const std::string script =
        "cd " + test::quoted(dir.path().string()) + "; " +
        test::quoted(std::string(test::kBinaryFolder) + "/bin/animeme") + " mux " +
        test::quoted(sample()) + " long.wav -o " + name +
        " & pid=$!; while kill -0 $pid && [ -z \"$(find . -path '*.part*' -type f -size +4k)\" ]; "
        "do sleep 0.02; done; kill -TERM $pid; wait $pid";
    const auto result = test::run_command({"sh", "-c", script});
    EXPECT_EQ(result.exit_code, 130) << result.err;
    EXPECT_THAT(result.err, HasSubstr("stopped; the file holds the first"));
    const auto info = animeme({"info", dir / name, "--json"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    const auto json = nlohmann::json::parse(info.out, nullptr, false);
    EXPECT_GT(json["seconds"], 0.4);
    EXPECT_LT(json["seconds"], 30 * 60 - 1);
    for (const std::string& file : dir.files()) {
      EXPECT_EQ(file.find(".part"), std::string::npos) << file;
    }
  }
}

}  // namespace mux_test
}  // namespace animeme
