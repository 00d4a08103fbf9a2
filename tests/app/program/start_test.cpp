// What the program loads before it knows what is asked of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/folders.h"
#include "tests/support/program.h"

namespace animeme::test {
namespace start_test {

using ::testing::HasSubstr;
using ::testing::Not;

// The loader's own list of what is linked: the program is not run.
TEST(Start, LoadsNoLibraryBeforeItIsNeeded) {
  const auto result = run_command(
      {"env", "LD_TRACE_LOADED_OBJECTS=1", std::string(test::kBinaryFolder) + "/bin/animeme"});
  EXPECT_THAT(result.out, HasSubstr("libstdc++"));
  for (const char* library : {"libav", "libsw", "libespeak", "libsphinx", "libpocketsphinx",
                              "libspeex", "libicu", "libmecab", "libcld2", "libxml2"}) {
    EXPECT_THAT(result.out, Not(HasSubstr(library))) << "a call by-passes tools/app/late";
  }
}

}  // namespace start_test
}  // namespace animeme::test
