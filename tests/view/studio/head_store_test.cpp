// Heads that wait in a cache are the ones that would be made, or they are made.
#include "tools/view/studio/head_store.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fap/head/rig.h"
#include "tests/support/files.h"
#include "tests/support/temp_dir.h"

namespace animeme::test {
namespace head_store_test {

namespace fs = std::filesystem;

// Everything that a frame can show, bit by bit.
void expect_moves_alike(const head::Head& is, const head::Head& was) {
  const head::Rig left = head::make_rig(is), right = head::make_rig(was);
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    fap::Frame frame;
    frame.set(fap, 600);
    const head::Pose a = head::pose(left, frame), b = head::pose(right, frame);
    for (std::size_t part = 0; part < head::kPartCount; ++part) {
      EXPECT_EQ(a.positions[part], b.positions[part]) << fap << " " << head::kPartNames[part];
    }
  }
}

std::string only_file(const fs::path& folder) {
  std::string found;
  for (const auto& entry : fs::directory_iterator(folder)) {
    EXPECT_EQ(found, "");
    found = entry.path();
  }
  return found;
}

TEST(HeadStore, KeepsAHeadAsItWasMade) {
  const TempDir dir;
  const std::string folder = dir.file("cache/animeme");
  const head::Head made = *head::make_head(*head::head_parameters("child"));
  const auto first = studio::ready_head("child", folder);
  ASSERT_TRUE(first);
  const std::string file = only_file(folder);
  const auto when = fs::last_write_time(file);
  const auto again = studio::ready_head("child", folder);
  ASSERT_TRUE(again);
  EXPECT_EQ(fs::last_write_time(file), when);  // it was read
  for (const head::Head* head : {&*first, &*again}) {
    EXPECT_EQ(head->name, "child");
    EXPECT_EQ(head->fapu.mns, made.fapu.mns);
    for (std::size_t i = 0; i < head::kPartCount; ++i) {
      EXPECT_EQ(head->parts[i].positions, made.parts[i].positions);
      EXPECT_EQ(head->parts[i].triangles, made.parts[i].triangles);
      EXPECT_EQ(head->parts[i].colours, made.parts[i].colours);
      EXPECT_EQ(head->parts[i].occlusion, made.parts[i].occlusion);
      EXPECT_EQ(head->parts[i].surface, made.parts[i].surface);
    }
    for (const fap::FeaturePointInfo& point : fap::kFeaturePoints) {
      EXPECT_EQ(head->at(point.id), made.at(point.id)) << point.id;
    }
    expect_moves_alike(*head, made);
  }
}

TEST(HeadStore, MakesAnewWhatIsDamagedOrOfAnotherBuild) {
  const std::string whole = studio::store_head(*head::make_head(*head::head_parameters("child")));
  ASSERT_TRUE(studio::restore_head(whole));
  EXPECT_FALSE(studio::restore_head(""));
  EXPECT_FALSE(studio::restore_head(whole.substr(0, 7)));
  EXPECT_FALSE(studio::restore_head(whole + '\0'));
  for (const std::size_t at : {std::size_t(12), whole.size() / 2, whole.size() - 3}) {
    std::string other = whole;
    other[at] = char(other[at] ^ 1);
    EXPECT_FALSE(studio::restore_head(other)) << at;
    EXPECT_FALSE(studio::restore_head(whole.substr(0, at))) << at;
  }
  const TempDir dir;
  const auto first = studio::ready_head("child", dir.path());
  ASSERT_TRUE(first);
  const std::string file = only_file(dir.path());
  const std::string kept = slurp(file);
  std::ofstream(file, std::ios::binary) << kept.substr(0, kept.size() / 3);
  const auto mended = studio::ready_head("child", dir.path());
  ASSERT_TRUE(mended);
  EXPECT_EQ(mended->parts[0].positions, first->parts[0].positions);
  EXPECT_EQ(slurp(file).size(), kept.size());
}

TEST(HeadStore, IsOfNoneIfThereIsNoFolder) {
  EXPECT_TRUE(studio::ready_head("child", ""));
  EXPECT_TRUE(studio::ready_head("child", "/dev/null/cache"));
  EXPECT_EQ(studio::ready_head("me.glb", "").error().code, Code::not_found);
}

}  // namespace head_store_test
}  // namespace animeme::test
