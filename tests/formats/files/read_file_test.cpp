// What is read as a whole is looked at first, and has a limit.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <thread>

#include "tests/support/files.h"
#include "tests/support/temp_dir.h"
#include "tools/formats/files/file_lock.h"
#include "tools/formats/files/files.h"

namespace animeme::tools {
namespace read_file_test {

namespace fs = std::filesystem;
using test::spill;
using test::TempDir;
using ::testing::HasSubstr;

TEST(ReadFile, GivesAllBytesOfAnySize) {
  const TempDir dir;
  for (const std::size_t size : {0u, 1u, 4095u, 4096u, 4097u, 262144u, 266240u, 1000003u}) {
    std::string text(size, 'x');
    for (std::size_t i = 0; i < size; i += 7) text[i] = char('a' + i % 26);
    spill(dir / "a", text);
    const auto read = read_text_file(dir / "a");
    ASSERT_TRUE(read) << read.error().describe();
    EXPECT_EQ(*read, text);
    const auto bytes = read_file(dir / "a", size);
    ASSERT_TRUE(bytes) << "a file as large as the limit";
    EXPECT_EQ(bytes->size(), size);
    if (size > 0) {
      EXPECT_EQ(read_file(dir / "a", size - 1).error().code, Code::out_of_range);
    }
  }
}

TEST(ReadFile, ReadsWhatSaysThatItIsEmpty) {
  const auto status = read_text_file("/proc/self/status");  // its size is told as 0
  ASSERT_TRUE(status);
  EXPECT_THAT(*status, HasSubstr("Name:"));
  EXPECT_EQ(read_file("/dev/null")->size(), 0u);
}

TEST(ReadFile, RefusesWhatNeverEndsOrIsNothing) {
  const TempDir dir;
  EXPECT_EQ(read_file("/dev/zero").error().code, Code::io);
  EXPECT_EQ(read_file("/dev/urandom").error().code, Code::io);
  fs::create_symlink("/dev/zero", dir / "link");
  EXPECT_EQ(read_file(dir / "link").error().code, Code::io);
  EXPECT_EQ(read_file(dir.path().string()).error().code, Code::io);
  EXPECT_EQ(read_file(dir / "none").error().code, Code::not_found);
  spill(dir / "hole", "");
  fs::resize_file(dir / "hole", std::uintmax_t(4) << 30);
  EXPECT_EQ(read_file(dir / "hole").error().code, Code::out_of_range);
  fs::resize_file(dir / "hole", std::uintmax_t(500) << 20);
  EXPECT_EQ(read_file(dir / "hole").error().code, Code::syntax);
  spill(dir / "binary", std::string("text\0more", 9));
  EXPECT_TRUE(read_file(dir / "binary"));
  EXPECT_THAT(read_text_file(dir / "binary").error().describe(), HasSubstr("byte 5"));
  spill(dir / "wide", std::string("\xFF\xFEt\0", 4));
  EXPECT_TRUE(read_text_file(dir / "wide"));
}

TEST(ReadFile, APipeHasALimitToo) {
  const TempDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  for (const std::uint64_t limit : {std::uint64_t(10) << 20, std::uint64_t(1) << 20}) {
    std::thread writer([&] {
      const int out = ::open((dir / "pipe").c_str(), O_WRONLY);
      const std::string block(1 << 16, 'y');
      for (int i = 0; i < 64 && ::write(out, block.data(), block.size()) > 0; ++i) {
      }
      ::close(out);
    });
    struct sigaction old = {}, ignore = {};
    ignore.sa_handler = SIG_IGN;
    ::sigaction(SIGPIPE, &ignore, &old);
    const auto bytes = read_file(dir / "pipe", limit);
    writer.join();
    ::sigaction(SIGPIPE, &old, nullptr);
    if (limit > std::uint64_t(4) << 20) {
      EXPECT_EQ(bytes->size(), std::size_t(4) << 20);
    } else {
      EXPECT_EQ(bytes.error().code, Code::out_of_range);
    }
  }
}

TEST(FileLock, IsForOneAtATime) {
  const TempDir dir;
  const std::string path = dir / "sums";
  {
    const auto mine = FileLock::take(path);
    ASSERT_TRUE(mine);
    const auto yours = FileLock::take(path);
    ASSERT_FALSE(yours);
    EXPECT_EQ(yours.error().code, Code::io);
    EXPECT_THAT(yours.error().describe(), HasSubstr("another program"));
    EXPECT_TRUE(FileLock::take(dir / "other"));
  }
  EXPECT_EQ(dir.count(), 0u);
  EXPECT_TRUE(FileLock::take(path));
  // One that was killed: its file stays, its lock does not.
  spill(dir / ".sums.lock", "");
  EXPECT_TRUE(FileLock::take(path));
  EXPECT_EQ(FileLock::take(dir / "no/folder").error().code, Code::io);
}

}  // namespace read_file_test
}  // namespace animeme::tools
