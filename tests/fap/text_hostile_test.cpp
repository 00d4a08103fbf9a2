// Whatever comes in: an answer, and what was read can be written and read again.
#include <gtest/gtest.h>

#include "fap/text.h"
#include "tests/fap/in_pieces.h"
#include "tests/fap/make.h"

namespace animeme::fap {
namespace text_hostile_test {

// Reads; on success checks what the header promises of every result.
void survive(const std::string& text) {
  std::vector<std::string> warnings;
  const Result<Sequence> clip = read_text(text, {}, &warnings);
  in_pieces::expect_as_whole(text);
  if (!clip) {
    ASSERT_FALSE(clip.error().message.empty());
    ASSERT_GT(clip.error().where.line, 0);
    ASSERT_NE(clip.error().code, Code::internal);
    return;
  }
  ASSERT_TRUE(clip->rate.valid());
  std::int64_t previous = -1;
  for (const Frame& frame : clip->frames) {
    ASSERT_GT(frame.number, previous);
    ASSERT_FALSE(frame.mask[0]);
    previous = frame.number;
  }
  const Result<Sequence> again = read_text(write_text(*clip));
  ASSERT_TRUE(again) << again.error().describe();
  ASSERT_EQ(again->frames, clip->frames);
  ASSERT_EQ(again->rate, clip->rate);
}

std::string good_text() {
  made::Random random(7);
  return "# comment\n" + write_text(made::random_sequence(random, 3));
}

TEST(HostileText, TruncatedAtEveryByte) {
  const std::string text = good_text();
  for (std::size_t size = 0; size <= text.size(); ++size) survive(text.substr(0, size));
}

TEST(HostileText, EveryByteReplaced) {
  const std::string text = good_text();
  for (const char byte : {'\0', ' ', '\n', '#', '9', '-', '.', '\xff'}) {
    for (std::size_t at = 0; at < text.size(); ++at) {
      std::string changed = text;
      changed[at] = byte;
      survive(changed);
    }
  }
}

TEST(HostileText, EveryLineRemovedOrDoubled) {
  const std::string text = good_text();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin) + 1;
    survive(text.substr(0, begin) + text.substr(end));
    survive(text.substr(0, end) + text.substr(begin));
    begin = end;
  }
}

TEST(HostileText, RandomBytes) {
  made::Random random(99);
  const std::string alphabet = "01 0 1 0 \n\t\r#.-+e25/\\x\xef\xbb\xbf";
  for (int round = 0; round < 3000; ++round) {
    std::string text = random.chance(50) ? "2.1 x 25 3\n" : "";
    const std::int64_t size = random.in(0, 400);
    const bool any_byte = random.chance(20);
    for (std::int64_t i = 0; i < size; ++i) {
      text += any_byte ? char(random.in(0, 255))
                       : alphabet[std::size_t(random.in(0, std::int64_t(alphabet.size()) - 1))];
    }
    survive(text);
  }
}

TEST(HostileText, RandomTokens) {
  made::Random random(5);
  const char* tokens[] = {"1e999", "-", "nan", "2147483648", "69", "1.5", "\n", "#", "1", "0"};
  for (int round = 0; round < 2000; ++round) {
    std::string text = "2.1 x 25 2000000000\n";
    for (int line = 0; line < 6; ++line) {
      const std::int64_t count = random.in(60, 80);
      for (std::int64_t i = 0; i < count; ++i) {
        text += random.chance(1) ? tokens[random.in(0, 9)] : tokens[random.in(8, 9)];
        text += ' ';
      }
      text += '\n';
      if (random.chance(50)) text += "0 1 2 3\n";
    }
    survive(text);
  }
}

TEST(HostileText, LongLinesAndTokens) {
  const std::string million(1'000'000, '1');
  survive(million);
  survive("2.1 x " + million + " 1\n");
  survive("2.1 x 25 " + million + "\n");
  survive("2.1 " + million + " 25 0\n");
  survive("2.1 x 25 1\n" + made::mask_line({3}) + "\n0 " + million + "\n");
  survive("2.1 x 25 1\n" + made::mask_line({3}) + "\n" + million + " 0\n");
  survive("2.1 x 25 1\n" + std::string(1'000'000, '#') + "\n" + std::string(1'000'000, ' '));
  std::string zeros;
  for (int i = 0; i < 500'000; ++i) zeros += "0 ";
  survive(zeros);
  survive("2.1 x 25 1\n" + zeros);
  survive("2.1 x 25 1\n" + made::mask_line({3}) + "\n" + zeros);
}

}  // namespace text_hostile_test
}  // namespace animeme::fap
