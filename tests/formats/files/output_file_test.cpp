// Files appear whole or not at all, and nothing that lies in the folder is touched on the way.
#include "tools/formats/files/output_file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>

#include "tests/support/files.h"
#include "tests/support/temp_dir.h"
#include "tools/formats/files/files.h"
#include "tools/formats/files/output_folder.h"
#include "tools/formats/files/unfinished.h"

namespace animeme::tools {
namespace output_file_test {

namespace fs = std::filesystem;
using test::slurp;
using test::spill;
using test::TempDir;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

int mode_of(const std::string& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 ? int(status.st_mode & 07777) : -1;
}

TEST(OutputFile, TakesItsNameAtTheEnd) {
  const TempDir dir;
  OutputFile file(dir / "a");
  EXPECT_THAT(dir.files(), IsEmpty());
  ASSERT_TRUE(file.write("one "));
  ASSERT_TRUE(file.write("two"));
  ASSERT_EQ(dir.count(), 1u);
  EXPECT_NE(dir.files()[0], "a");
  ASSERT_TRUE(file.publish());
  EXPECT_THAT(dir.files(), ElementsAre("a"));
  EXPECT_EQ(slurp(dir / "a"), "one two");
}

TEST(OutputFile, LeavesNothingUnlessPublished) {
  const TempDir dir;
  spill(dir / "a", "old");
  {
    OutputFile file(dir / "a");
    ASSERT_TRUE(file.write("new"));
    OutputFile moved(std::move(file));
    ASSERT_TRUE(moved.write("er"));
  }
  EXPECT_THAT(dir.files(), ElementsAre("a"));
  EXPECT_EQ(slurp(dir / "a"), "old");
}

TEST(OutputFile, NamesCannotBeForeseen) {
  const TempDir dir;
  OutputFile a(dir / "x"), b(dir / "x");
  const Result<std::string> one = a.place(), two = b.place();
  ASSERT_TRUE(one && two);
  EXPECT_NE(*one, *two);
  // What earlier versions used: somebody's link waits there, and stays what it is.
  spill(dir / "precious", "precious");
  for (const std::string& name :
       {dir / "y.part", dir / "y.part0", (dir / "y.part") + std::to_string(::getpid())}) {
    fs::create_symlink(dir / "precious", name);
  }
  ASSERT_TRUE(write_file(dir / "y", "mine"));
  EXPECT_EQ(slurp(dir / "precious"), "precious");
  EXPECT_EQ(slurp(dir / "y"), "mine");
}

TEST(OutputFile, KeepsTheModeOfWhatItReplaces) {
  const TempDir dir;
  const mode_t mask = ::umask(027);
  ASSERT_TRUE(write_file(dir / "new", "x"));
  EXPECT_EQ(mode_of(dir / "new"), 0640);
  for (const int mode : {0600, 0444, 0755}) {
    spill(dir / "old", "x");
    ASSERT_EQ(::chmod((dir / "old").c_str(), mode_t(mode)), 0);
    ASSERT_TRUE(write_file(dir / "old", "y"));
    EXPECT_EQ(mode_of(dir / "old"), mode);
    EXPECT_EQ(slurp(dir / "old"), "y");
    fs::remove(dir / "old");
  }
  ::umask(mask);
}

TEST(OutputFile, FollowsLinks) {
  const TempDir dir;
  fs::create_directory(dir / "there");
  spill(dir / "there/a", "old");
  fs::create_symlink("there/a", dir / "link");
  fs::create_symlink(dir / "link", dir / "link of link");
  ASSERT_TRUE(write_file(dir / "link of link", "new"));
  EXPECT_TRUE(fs::is_symlink(dir / "link of link") && fs::is_symlink(dir / "link"));
  EXPECT_EQ(slurp(dir / "there/a"), "new");
  fs::create_symlink("there/b", dir / "to nothing yet");
  ASSERT_TRUE(write_file(dir / "to nothing yet", "b"));
  EXPECT_EQ(slurp(dir / "there/b"), "b");
  fs::create_symlink("ring", dir / "ring");
  EXPECT_EQ(write_file(dir / "ring", "x").error().code, Code::io);
}

TEST(OutputFile, SaysWhatIsWrong) {
  const TempDir dir;
  EXPECT_EQ(write_file(dir / "no/such/folder", "x").error().code, Code::io);
  EXPECT_EQ(write_file(dir.path().string(), "x").error().code, Code::io);
  EXPECT_EQ(write_file("", "x").error().code, Code::io);
  EXPECT_EQ(write_file("/dev/full", "x").error().code, Code::io);
  EXPECT_TRUE(write_file("/dev/null", "x"));
  EXPECT_EQ(OutputFile("/dev/null").place().error().code, Code::io);
  EXPECT_EQ(OutputFile("-").place().error().code, Code::io);
  EXPECT_THAT(dir.files(), IsEmpty());
}

TEST(OutputFile, SeveralAtOnceOrNone) {
  const TempDir dir;
  spill(dir / "a", "old");
  const OutputText bad[] = {{dir / "a", "new"}, {dir / "no/b", "new"}};
  EXPECT_FALSE(write_files(bad));
  EXPECT_EQ(slurp(dir / "a"), "old");
  const OutputText good[] = {{dir / "a", "new"}, {dir / "b", "new"}};
  EXPECT_TRUE(write_files(good));
  EXPECT_EQ(dir.count(), 2u);
}

bool nobody_is_replaced(std::string_view) { return false; }

// A program that ends in the middle of a file and of a folder: how says `end`.
void expect_clean_end(void (*end)(), int wanted_signal) {
  const TempDir dir;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit none = {0, 0};
    ::setrlimit(RLIMIT_CORE, &none);
    for (const int number : {SIGABRT, SIGSEGV, SIGTERM, SIGHUP}) ::signal(number, SIG_DFL);
    clean_up_on_signals();
    OutputFile file(dir / "a");
    if (!file.write("half")) ::_exit(9);
    auto folder = OutputFolder::create(dir / "b", nobody_is_replaced);
    if (!folder) ::_exit(9);
    spill(folder->file("segment"), "half");
    if (dir.count() != 2) ::_exit(8);
    end();
    ::_exit(7);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  if (wanted_signal == 0) {
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  } else {
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == wanted_signal) << status;
  }
  EXPECT_THAT(dir.files(), IsEmpty());
}

TEST(Unfinished, IsRemovedHoweverAProgramEnds) {
  expect_clean_end([] { ::raise(SIGTERM); }, SIGTERM);
  expect_clean_end([] { ::raise(SIGHUP); }, SIGHUP);
  expect_clean_end([] { ::raise(SIGSEGV); }, SIGSEGV);
  expect_clean_end([] { std::abort(); }, SIGABRT);
}

TEST(Unfinished, BelongsToTheProcessThatMadeIt) {
  const TempDir dir;
  OutputFile file(dir / "a");
  ASSERT_TRUE(file.write("half"));
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    remove_unfinished();
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_EQ(dir.count(), 1u);
  EXPECT_TRUE(file.publish());
}

}  // namespace output_file_test
}  // namespace animeme::tools
