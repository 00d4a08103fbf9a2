// `animeme view` as a user calls it.
#include <gmock/gmock.h>

#include "tests/support/folders.h"
#include "tests/support/program.h"

namespace animeme::test {
namespace view_test {

using testing::HasSubstr;
using testing::Not;

const std::string kData = std::string(test::kSourceFolder) + "/tests/data/";

TEST(ViewCommand, WritesOnePageOfEachKindOfInput) {
  const TempDir dir;
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  const std::string script = kData + "grid_s1_sample/phonemes/prac8p.tsv";
  const auto silent =
      animeme({"view", curves, "--script", script, "--head", "child", "-o", dir / "a.html"});
  EXPECT_EQ(silent.exit_code, 0) << silent.err;
  EXPECT_THAT(silent.err, HasSubstr("silent"));
  const std::string page = slurp(dir / "a.html");
  EXPECT_THAT(page, HasSubstr("<title>prac8p.csv</title>"));
  EXPECT_THAT(page, HasSubstr("\"please\""));
  EXPECT_LE(page.size(), 3'000'000u);
  const auto pair = animeme({"view", kData + "containers/std_aac.mp4", curves, "-o", "-"});
  EXPECT_EQ(pair.exit_code, 0) << pair.err;
  EXPECT_THAT(pair.err, HasSubstr("with sound"));
  EXPECT_THAT(pair.out, HasSubstr("id=\"clip1\""));
  EXPECT_THAT(pair.out, HasSubstr("id=\"sound\""));
  const auto faceless =
      animeme({"view", kData + "containers/iso_reference_fba_only.mp4", "-o", dir / "b.html"});
  EXPECT_EQ(faceless.exit_code, 0) << faceless.err;
  EXPECT_THAT(faceless.err, HasSubstr("silent"));
}

TEST(ViewCommand, OffersSeveralHeads) {
  const TempDir dir;
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  const auto view = [&](std::vector<std::string> heads) {
    heads.insert(heads.begin(), {"view", curves, "-o", "-"});
    return animeme(heads);
  };
  const std::string list = "\"heads\":[\"man\",\"child\"]";
  const auto one = view({"--head", "man"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.out, Not(HasSubstr("model_1")));
  EXPECT_THAT(one.out, Not(HasSubstr("\"heads\":")));
  const auto listed = view({"--head", "man,child"});
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_THAT(listed.out, HasSubstr(list));
  EXPECT_THAT(listed.out, HasSubstr("id=\"model_1\""));
  EXPECT_GT(listed.out.size(), one.out.size() + 500'000);
  EXPECT_EQ(view({"--head", "man", "--head", "child"}).out, listed.out);
  const auto wrong = view({"--head", "man,nobody"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("nobody"));
}

// Noise, 16 bits, one channel, 16 kHz.
std::string noise(int seconds) {
  const auto number = [](std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += char(value >> (8 * i) & 255);
    return text;
  };
  std::string data;
  std::uint32_t state = 1;
  for (int i = 0; i < 16000 * seconds; ++i) {
    state = state * 1664525u + 1013904223u;
    data += number(state >> 18, 2);
  }
  return "RIFF" + number(std::uint32_t(36 + data.size()), 4) + "WAVEfmt " + number(16, 4) +
         number(1, 2) + number(1, 2) + number(16000, 4) + number(32000, 4) + number(2, 2) +
         number(16, 2) + "data" + number(std::uint32_t(data.size()), 4) + data;
}

TEST(ViewCommand, TakesTheSoundOfAnyContainer) {
  const TempDir dir;
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  spill(dir / "a.wav", noise(3));
  const auto second =
      animeme({"view", curves, kData + "containers/std_aac.mp4", "-o", dir / "a.html"});
  EXPECT_EQ(second.exit_code, 0) << second.err;
  EXPECT_THAT(second.err, HasSubstr("with sound"));
  ASSERT_EQ(animeme({"mux", curves, dir / "a.wav", "-o", dir / "a.m3u8"}).exit_code, 0);
  const auto segments = animeme({"view", dir / "a.m3u8", "-o", dir / "b.html"});
  EXPECT_EQ(segments.exit_code, 0) << segments.err;
  EXPECT_THAT(segments.err, HasSubstr("with sound"));
}

TEST(ViewCommand, SaysWhatMakesALargePageSmall) {
  const TempDir dir;
  spill(dir / "a.wav", noise(240));
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  const auto large = animeme({"view", curves, "--audio", dir / "a.wav", "-o", dir / "a.html"});
  ASSERT_EQ(large.exit_code, 0) << large.err;
  EXPECT_THAT(large.err, HasSubstr("the face lasts 3.00 s, the sound 240.00 s"));
  const std::string remedy = "--audio-codec opus --audio-bitrate ";
  const std::size_t at = large.err.find(remedy);
  ASSERT_NE(at, std::string::npos) << large.err;
  const std::string rate = std::to_string(std::stoi(large.err.substr(at + remedy.size())));
  const auto small = animeme({"view", curves, "--audio", dir / "a.wav", "--audio-codec", "opus",
                              "--audio-bitrate", rate, "-o", dir / "b.html"});
  ASSERT_EQ(small.exit_code, 0) << small.err;
  EXPECT_THAT(small.err, Not(HasSubstr("--audio-bitrate")));
  EXPECT_GT(slurp(dir / "a.html").size(), 3'000'000u);
  EXPECT_LE(slurp(dir / "b.html").size(), 3'000'000u);
}

TEST(ViewCommand, SaysWhatIsWrong) {
  const TempDir dir;
  const std::string curves = kData + "grid_s1_sample/fap/prac8p.csv";
  const auto head = animeme({"view", curves, "--head", "dog", "-o", dir / "a.html"});
  EXPECT_EQ(head.exit_code, 2);
  EXPECT_THAT(head.err, HasSubstr("woman, man, child"));
  EXPECT_EQ(animeme({"view", dir / "none.fap", "-o", dir / "a.html"}).exit_code, 3);
  const auto sound = animeme({"view", curves, "--audio", curves, "-o", dir / "a.html"});
  EXPECT_EQ(sound.exit_code, 3);
  EXPECT_THAT(sound.err, HasSubstr("prac8p.csv"));
  EXPECT_EQ(dir.files().size(), 0u);
}

}  // namespace view_test
}  // namespace animeme::test
