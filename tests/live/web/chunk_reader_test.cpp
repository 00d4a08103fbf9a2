#include "tools/live/web/detail/chunk_reader.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace animeme::test {
namespace chunk_reader_test {

// Nothing: it is wrong.
std::optional<std::string> read(const std::string& bytes, std::size_t step, bool& over) {
  web::ChunkReader reader;
  std::string body;
  for (std::size_t at = 0; at < bytes.size(); at += step) {
    if (!reader.read(std::string_view(bytes).substr(at, step), body)) return std::nullopt;
  }
  over = reader.over();
  return body;
}

TEST(ChunkReader, ReadsChunksHoweverTheyAreCut) {
  const std::string bytes =
      "4\r\nWiki\r\n5;name=value\r\npedia\r\nE \r\n in\r\n\r\nchunks.\r\n0\r\nTrailer: "
      "x\r\n\r\nrest";
  for (std::size_t step = 1; step <= bytes.size(); ++step) {
    bool over = false;
    EXPECT_EQ(read(bytes, step, over), "Wikipedia in\r\n\r\nchunks.") << step;
    EXPECT_TRUE(over);
  }
  for (std::size_t size = 0; size + 4 < bytes.size(); ++size) {
    bool over = false;
    EXPECT_TRUE(read(bytes.substr(0, size), 3, over));
    EXPECT_FALSE(over) << size;
  }
}

TEST(ChunkReader, RefusesWhatIsNone) {
  for (const char* wrong : {"x\r\n", "\r\n", "-1\r\n", "0x4\r\nWiki\r\n", "4\r\nWikiX\r\n",
                            "123456789\r\n", " 4\r\nWiki\r\n", ";a\r\n", "4 4\r\n"}) {
    bool over = false;
    EXPECT_FALSE(read(wrong, 1, over)) << wrong;
    EXPECT_FALSE(read(wrong, 100, over)) << wrong;
  }
  bool over = false;
  EXPECT_FALSE(read(std::string(1000, '1'), 7, over));
  EXPECT_FALSE(read("0\r\n" + std::string(5000, 'x'), 7, over));
}

}  // namespace chunk_reader_test
}  // namespace animeme::test
