// "kbit/s" means the same in every report: the bytes of the stream, times 8, by the seconds of the
// clip.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "codec/decode/access_unit.h"
#include "tests/app/program/commands.h"
#include "tools/formats/media/container.h"

namespace animeme {
namespace bit_rate_test {

using test::animeme;
using test::Json;
using test::json_of;
using test::slurp;
using test::TempDir;

constexpr const char* kText = "Hello world, how are you today?";

// "... 6.35 kbit/s" of a line for people.
double told(const std::string& line) {
  std::smatch found;
  if (!std::regex_search(line, found, std::regex("([0-9.]+) kbit/s"))) return -1;
  return std::stod(found[1]);
}

double rate_of(std::size_t bytes, double seconds) { return double(bytes) * 8 / seconds / 1000; }

TEST(BitRate, OfAStream) {
  const TempDir dir;
  const auto spoken = animeme({"speak", "--text", kText, "-o", dir / "a.fba"});
  ASSERT_EQ(spoken.exit_code, 0) << spoken.err;
  const Json info = json_of({"info", dir / "a.fba"}), stats = json_of({"stats", dir / "a.fba"});
  const double rate = rate_of(slurp(dir / "a.fba").size(), info["seconds"]);
  EXPECT_NEAR(info["kbit_per_s"].get<double>(), rate, 1e-9);
  EXPECT_NEAR(stats["kbit_per_s"].get<double>(), rate, 1e-9);
  EXPECT_NEAR(told(spoken.err), rate, 0.0051);

  test::succeeds({"decode", dir / "a.fba", "-o", dir / "a.fap"});
  const Json coded = json_of({"encode", dir / "a.fap", "-o", dir / "b.fba"});
  const auto line = animeme({"encode", dir / "a.fap", "-o", dir / "b.fba"});
  const double again = rate_of(slurp(dir / "b.fba").size(), info["seconds"]);
  EXPECT_NEAR(coded["kbit_per_s"].get<double>(), again, 1e-9);
  EXPECT_NEAR(told(line.err), again, 0.0051);
  EXPECT_NEAR(json_of({"info", dir / "b.fba"})["kbit_per_s"].get<double>(), again, 1e-9);
}

TEST(BitRate, OfTheFaceInAContainer) {
  const TempDir dir;
  const auto spoken = animeme({"speak", "--text", kText, "-o", dir / "a.mp4"});
  ASSERT_EQ(spoken.exit_code, 0) << spoken.err;
  const auto container = media::read_container(dir / "a.mp4");
  ASSERT_TRUE(container) << container.error().describe();
  const Json info = json_of({"info", dir / "a.mp4"}), stats = json_of({"stats", dir / "a.mp4"});
  const double rate =
      rate_of(fba::join_access_units(container->face).size(), info["face"]["seconds"]);
  EXPECT_NEAR(info["face"]["kbit_per_s"].get<double>(), rate, 1e-9);
  EXPECT_NEAR(stats["kbit_per_s"].get<double>(), rate, 1e-9);
  EXPECT_NEAR(told(spoken.err), rate, 0.0051);
}

}  // namespace bit_rate_test
}  // namespace animeme
