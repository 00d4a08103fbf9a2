// Commands and options that are typed wrongly.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/program.h"

namespace animeme {
namespace did_you_mean_test {

using test::animeme;
using testing::HasSubstr;
using testing::Not;

TEST(DidYouMean, NamesWhatIsNear) {
  const struct {
    std::vector<std::string> typed;
    const char* said;
  } cases[] = {
      {{"speek", "--text", "x"}, "there is no command \"speek\"; did you mean speak?"},
      {{"-q", "ecnode", "a.fap"}, "there is no command \"ecnode\"; did you mean encode?"},
      {{"encode", "a.fap", "--qaunt", "3"}, "encode has no option --qaunt; did you mean --quant?"},
      {{"speak", "--txt=Hello"}, "speak has no option --txt; did you mean --text?"},
      {{"render", "a.fap", "--haed", "man"}, "render has no option --haed; did you mean --head?"},
      // As FFmpeg and other programs call them.
      {{"speak", "Hi", "--fps", "30"}, "speak has no option --fps; did you mean --rate?"},
      {{"speak", "Hi", "--bitrate=3"}, "speak has no option --bitrate; did you mean --kbps?"},
      {{"speak", "Hi", "--emotion", "joy"}, "speak has no option --emotion; did you mean --mood?"},
      {{"edit", "a.mp4", "--ss", "3"}, "edit has no option --ss; did you mean --from?"},
      {{"render", "a.fap", "--width", "64"}, "render has no option --width; did you mean --size?"},
      {{"--hepl"}, "animeme has no option --hepl; did you mean --help?"},
      {{"speak", "--hepl"}, "speak has no option --hepl; did you mean --help?"},
      {{"help", "speek"}, "there is no command \"speek\"; did you mean speak?"},
  };
  for (const auto& test : cases) {
    const auto result = animeme(test.typed);
    EXPECT_EQ(result.exit_code, 2) << test.said;
    EXPECT_THAT(result.err, HasSubstr(test.said));
  }
}

TEST(DidYouMean, DoesNotGuessWildly) {
  for (const std::vector<std::string>& typed :
       {std::vector<std::string>{"frobnicate"}, {"speak", "--zzz"}, {std::string(5000, 'x')}}) {
    const auto result = animeme(typed);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, Not(HasSubstr("did you mean")));
  }
  // What is wrong in another way is told as before.
  EXPECT_THAT(animeme({"encode", "a.fap", "--quant", "99"}).err, HasSubstr("--quant"));
  EXPECT_EQ(animeme({"speak", "--help"}).exit_code, 0);
}

}  // namespace did_you_mean_test
}  // namespace animeme
