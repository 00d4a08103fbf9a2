// Files of sums: any order of merging, and no damage goes unnoticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/dam/accumulate_support.h"
#include "tests/support/files.h"
#include "tests/support/sealed_model.h"
#include "tests/support/temp_dir.h"

namespace animeme::dam {
namespace accumulate_file_test {

using test::planted;
using test::sums_of;
using testing::HasSubstr;

TEST(AccumulateFile, TheOrderOfFilesDoesNotMatterToABit) {
  const auto sentences = planted(24);
  const std::span<const Utterance> all = sentences;
  const test::TempDir dir;
  const std::vector<std::filesystem::path> paths = {dir / "sums_a", dir / "sums_b", dir / "sums_c"};
  for (std::size_t i = 0; i < 3; ++i)
    test::write_bytes(paths[i], write_training_sums(sums_of(all.subspan(8 * i, 8))));
  std::vector<std::size_t> order = {0, 1, 2};
  std::vector<std::uint8_t> first;
  do {
    const auto sums =
        merge_training_sums(std::vector{paths[order[0]], paths[order[1]], paths[order[2]]});
    ASSERT_TRUE(sums) << sums.error().describe();
    const auto bytes = write_training_sums(*sums);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first);
  } while (std::next_permutation(order.begin(), order.end()));
  const auto twice = merge_training_sums(std::vector{paths[0], paths[0]});
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().describe(), testing::AllOf(HasSubstr("_a"), HasSubstr("twice")));
  EXPECT_FALSE(merge_training_sums({}));
  for (const auto& path : paths) {
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
    std::filesystem::remove(path);
  }
  EXPECT_EQ(load_training_sums(paths[0]).error().code, Code::not_found);
}

/// Two phones, one control; or silence, which has no unknowns: a file of a few kilobytes.
std::vector<std::uint8_t> small_file(bool speech = true) {
  Utterance u;
  u.id = "a";
  u.script.phones = {{0, 0.4, "SIL", ""}, {0.4, 0.5, speech ? "AA" : "SIL", "a"}};
  u.script.phones.push_back({0.5, 0.9, "SIL", ""});
  u.signal.rate = {25, 1};
  u.signal.names = {"c"};
  for (int i = 0; i < 22; ++i) u.signal.values.push_back(i % 5);
  return write_training_sums(sums_of(std::vector{u}));
}

#ifdef ANIMEME_SANITIZED
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif

/// Every byte of the small file, some of the other.
template <class Visit>
void each_byte(Visit visit) {
  for (const bool speech : {false, true}) {
    const auto bytes = small_file(speech);
    for (std::size_t i = 0; i < bytes.size(); i += !speech ? 1 : i < 4000 ? 31 : 997)
      visit(bytes, i);
  }
}

TEST(AccumulateFile, ReadsWhatItWrote) {
  const auto bytes = small_file();
  const auto sums = read_training_sums(bytes);
  ASSERT_TRUE(sums) << sums.error().describe();
  EXPECT_EQ(write_training_sums(*sums), bytes);
  EXPECT_EQ(sums->sentences(), 1u);
  EXPECT_EQ(sums->controls(), std::vector<std::string>{"c"});
  EXPECT_EQ(sums->rate(), (fap::Rate{25, 1}));
  const auto empty = write_training_sums(sums_of({}));
  ASSERT_TRUE(read_training_sums(empty));
  EXPECT_EQ(write_training_sums(*read_training_sums(empty)), empty);
}

TEST(AccumulateFile, EveryDamagedByteIsFound) {
  each_byte([](std::vector<std::uint8_t> bytes, std::size_t i) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      bytes[i] = std::uint8_t(bytes[i] ^ flip);
      EXPECT_FALSE(read_training_sums(bytes)) << "byte " << i;
      bytes[i] = std::uint8_t(bytes[i] ^ flip);
    }
  });
}

TEST(AccumulateFile, EveryCutAndExtensionIsFound) {
  each_byte([](const std::vector<std::uint8_t>& bytes, std::size_t i) {
    EXPECT_FALSE(read_training_sums(std::span(bytes).first(i))) << i << " bytes";
  });
  auto bytes = small_file();
  bytes.push_back(0);
  EXPECT_FALSE(read_training_sums(bytes));
}

TEST(AccumulateFile, ForeignFilesAndOtherVersions) {
  const auto model = train(planted(3));
  ASSERT_TRUE(model);
  const auto foreign = read_training_sums(write_model(*model));
  ASSERT_FALSE(foreign);
  EXPECT_THAT(foreign.error().message, HasSubstr("not a file of sums"));
  auto bytes = small_file();
  for (const int major : {3, 5}) {  // what an older version summed, too
    bytes[8] = std::uint8_t(major);
    EXPECT_EQ(read_training_sums(bytes).error().code, Code::unsupported);
  }
}

TEST(AccumulateFile, SealedNonsenseIsRefusedWithoutHarm) {
  int refused = 0;
  each_byte([&](const std::vector<std::uint8_t>& good, std::size_t i) {
    if (i < 20 || i + 4 >= good.size()) return;
    int number = int(i);
    for (const int value : {0x00, 0x7F, 0xFF}) {
      if (kSlow && ++number % 3 != 0) continue;  // trains from each that is not refused
      auto bytes = good;
      bytes[i] = std::uint8_t(value);
      test::seal(bytes);
      auto sums = read_training_sums(bytes);
      refused += sums ? 0 : 1;
      if (!sums) continue;
      EXPECT_EQ(write_training_sums(*sums), bytes) << "byte " << i;
      const auto model = train_from_sums(std::move(*sums));
      if (model) {
        EXPECT_TRUE(validate(*model)) << "byte " << i;
      }
    }
  });
  EXPECT_GT(refused, kSlow ? 30 : 100);
}

}  // namespace accumulate_file_test
}  // namespace animeme::dam
