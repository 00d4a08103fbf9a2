// What reads streams and texts frame by frame takes no memory for those that are over.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <fstream>
#include <string>
#include <vector>

#include "codec/encode/encoder.h"
#include "fap/text.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/sanitized.h"
#include "tools/formats/media/audio.h"

extern char** environ;

namespace animeme {
namespace memory_test {

using test::TempDir;

constexpr int kPlanes = 200'000;

// 26 FAPs that hardly move.
void write_long_stream(const std::string& path) {
  fba::FaceSettings settings;
  settings.send_range.fill(true);
  for (auto& set : settings.range) set.fill(1);
  for (int fap = 3; fap < 55; fap += 2) settings.mask.set(std::size_t(fap));
  for (std::size_t group = 1; group < fap::kGroupCount; ++group) {
    settings.mask_type[group] = fba::MaskType::hold;
  }
  fba::Encoder encoder;
  std::ofstream out(path, std::ios::binary);
  fap::Frame face;
  const auto flush = [&](const std::vector<std::uint8_t>& bytes) {
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  };
  for (int i = 0; i < kPlanes; ++i) {
    face.value[3] = i % 2;
    fba::PlaneInput plane;
    plane.intra = i == 0;
    plane.face = &face;
    plane.face_settings = &settings;
    ASSERT_TRUE(encoder.write(plane));
    if (i % 1000 == 0) flush(encoder.take());
  }
  flush(encoder.finish());
}

// Megabytes that the program had resident at most.
long megabytes_of(std::vector<std::string> arguments, const std::string& out) {
  arguments.insert(arguments.begin(), std::string(test::kBinaryFolder) + "/bin/animeme");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t child = 0;
  EXPECT_EQ(posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ), 0);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0) << testing::PrintToString(arguments);
  return usage.ru_maxrss / 1024;
}

TEST(Memory, DoesNotGrowWithTheStream) {
  if (test::kAddressSanitizer) GTEST_SKIP() << "the address sanitizer keeps what was freed";
  const TempDir dir;
  const std::string stream = dir / "long.fba";
  write_long_stream(stream);
  // Decoded planes alone would be 100 MB.
  constexpr long kMost = 70;
  EXPECT_LT(megabytes_of({"info", stream}, dir / "out"), kMost);
  EXPECT_LT(megabytes_of({"stats", stream}, dir / "out"), kMost);
  EXPECT_LT(megabytes_of({"compare", stream, stream}, dir / "out"), kMost);
  EXPECT_LT(megabytes_of({"decode", stream, "-o", dir / "long.fap"}, dir / "out"), kMost);
}

// 13 FAPs, some of which rest for long.
void write_long_text(const std::string& path) {
  std::ofstream out(path, std::ios::binary);
  out << fap::text_header({60, 1}, "long", kPlanes);
  std::string text;
  fap::Frame frame;
  for (int i = 0; i < kPlanes; ++i) {
    frame.number = i;
    for (int fap = 3; fap < 55; fap += 4) {
      frame.set(fap, i % 5000 < 500 * (fap % 7) ? (i * fap / 8) % 60 : fap);
    }
    fap::append_text(text, frame);
    if (i % 1000 > 0 && i + 1 < kPlanes) continue;
    out << text;
    text.clear();
  }
}

// Decoded frames alone would be 68 MB, and access units 20.
TEST(Memory, DoesNotGrowWithTheText) {
  if (test::kAddressSanitizer) GTEST_SKIP() << "the address sanitizer keeps what was freed";
  const TempDir dir;
  const std::string text = dir / "long.fap";
  const std::string stream = dir / "long.fba";
  write_long_text(text);
  constexpr long kMost = 60;
  const auto expect_flat = [&](const std::vector<std::string>& arguments, long most) {
    const long megabytes = megabytes_of(arguments, dir / "out");
    EXPECT_LT(megabytes, most) << testing::PrintToString(arguments);
  };
  for (const std::vector<std::string>& preset :
       std::vector<std::vector<std::string>>{{"plain"}, {"file", "--skip-still"}, {"live"}}) {
    std::vector<std::string> encode = {"encode", text, "-o", stream, "--preset"};
    encode.insert(encode.end(), preset.begin(), preset.end());
    expect_flat(encode, kMost);
  }
  expect_flat({"encode", text, "-o", stream, "--preset", "file", "--kbps", "2"}, kMost);
  expect_flat({"encode", text, "-o", stream, "--quant", "0"}, kMost);
  expect_flat({"info", text}, kMost);
  expect_flat({"compare", text, stream}, kMost);
  expect_flat({"decode", text, "--exact", "-o", dir / "again.fap"}, kMost);
  // FFmpeg takes a third of this. (What this program has in memory would count for its children,
  // too.)
  constexpr long kMostWithLibraries = 90;
  for (const std::string ending : {".mp4", ".mkv", ".ts"}) {
    expect_flat({"mux", text, "-o", dir / ("text" + ending)}, kMostWithLibraries);
    expect_flat({"mux", stream, "-o", dir / ("face" + ending)}, kMostWithLibraries);
    expect_flat({"demux", dir / ("face" + ending), "-o", dir / "back.fba"}, kMostWithLibraries);
    expect_flat({"compare", stream, dir / "back.fba"}, kMost);
    expect_flat(
        {"edit", dir / ("face" + ending), "--at", "10-900,1000-2900", "-o", dir / ("cut" + ending)},
        kMostWithLibraries);
  }
  expect_flat({"edit", stream, stream, "--from", "10", "--offset", "-1", "-o", dir / "cut.fba"},
              kMost);
  // With changed values.
  expect_flat({"edit", text, "--speed", "1.3", "--take", "lips=" + text, "-o", dir / "changed.fba"},
              kMost);
  expect_flat({"edit", stream, "--scale", "lips=0.9", "--smooth", "head=0.2,lips=0.1", "--mirror",
               "--fade", "20", "-o", dir / "changed.fap"},
              kMost);
}

// Half an hour of speech, whose sound alone would be 160 MB.
TEST(Memory, DoesNotGrowWithTheSoundOfSpeech) {
  if (test::kAddressSanitizer) GTEST_SKIP() << "the address sanitizer keeps what was freed";
  const TempDir dir;
  if (test::animeme({"speak", "--text", "a", "-o", dir / "a.fap"}).exit_code != 0) {
    GTEST_SKIP() << "no voice";
  }
  const std::string text = dir / "long.txt";
  std::ofstream out(text, std::ios::binary);
  for (int i = 0; i < 400; ++i) {
    out << "The quick brown fox jumps over the lazy dog, and then it sleeps.\n";
  }
  out.close();
  constexpr long kMost = 200;
  const std::string spoken = dir / "text.mp4", script = dir / "text.tsv";
  EXPECT_LT(megabytes_of({"speak", "--text-file", text, "-o", spoken, "--save-script", script},
                         dir / "out"),
            kMost);
  test::succeeds({"demux", spoken, "--audio", dir / "voice.wav"});
  EXPECT_LT(megabytes_of({"speak", "--script", script, "--audio", dir / "voice.wav", "-o",
                          dir / "script.fap"},
                         dir / "out"),
            kMost);
}

// Half an hour of sound of which seconds are speech, read once at 16 kHz: 115 MB, and no copy.
TEST(Memory, TakesARecordingOnce) {
  if (test::kAddressSanitizer) GTEST_SKIP() << "the address sanitizer keeps what was freed";
  const TempDir dir;
  const std::string text = "The quick brown fox jumps over the lazy dog.";
  const std::string wav = dir / "voice.wav", fap = dir / "a.fap";
  if (test::animeme({"speak", "--text", text, "-o", dir / "a.mp4"}).exit_code != 0) {
    GTEST_SKIP() << "no voice";
  }
  test::succeeds({"demux", dir / "a.mp4", "--audio", wav});
  if (test::animeme({"align", wav, "--transcript", text, "-o", dir / "a.tsv"}).exit_code != 0) {
    GTEST_SKIP() << "no recogniser";
  }
  auto voice = media::read_audio(wav, {});
  ASSERT_TRUE(voice);
  voice->samples.resize(std::size_t(1800 * voice->sample_rate));
  ASSERT_TRUE(media::write_wav(wav, *voice));
  constexpr long kMost = 260;  // with a second copy 307 and 347
  EXPECT_LT(megabytes_of({"align", wav, "--transcript", text, "-o", dir / "a.tsv"}, dir / "out"),
            kMost);
  EXPECT_LT(megabytes_of({"speak", "--audio", wav, "--transcript", text, "-o", fap}, dir / "out"),
            kMost);
}

}  // namespace memory_test
}  // namespace animeme
