// What reads a stream plane by plane takes no memory for those that are over.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <fstream>

#include "codec/encode/encoder.h"
#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/sanitized.h"

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

}  // namespace memory_test
}  // namespace animeme
