// Heads that wait in a cache are the ones that would be made, or they are made.
#include "tools/view/studio/head_store.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>

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

// A head of twelve vertices with all that a file may name.
head::Head small_head() {
  head::Head made;
  made.name = "child";
  for (std::size_t part = 0; part < head::kPartCount; ++part) {
    head::Mesh& mesh = made.parts[part];
    for (int v = 0; v < 12; ++v) {
      mesh.positions.push_back({float(v % 3) - 1, float(v / 3) - 2, float(part) * 0.1f + 1});
    }
    mesh.triangles = {{0, 1, 3}, {1, 4, 3}, {3, 4, 6}, {4, 7, 6}, {6, 7, 9}};
    mesh.colours.assign(12, {0.5f, 0.5f, 0.5f});
    mesh.occlusion.assign(12, 1);
  }
  made.eyes = {head::Eye{{1, 0, 0}, 1, 0.5f, 0.2f}, head::Eye{{-1, 0, 0}, 1, 0.5f, 0.2f}};
  for (std::size_t i = 0; i < made.feature_points.size(); ++i) {
    made.feature_points[i] = {head::Part::skin, std::uint32_t(i % 12)};
  }
  made.fapu = {1, 2, 3, 4, 5};
  made.seams.lips = {{4, 1}, {5, 2}};
  made.seams.lids = {{{{7, 4}}, {{10, 7}}}};
  for (auto& weights : made.seams.lid_weights) weights.assign(12, 0.5f);
  made.seams.jaw_weights.assign(12, 0.5f);
  made.seams.freedom.assign(12, 0.5f);
  made.seams.neck_weights.assign(12, 0.5f);
  made.lash_anchors.assign(12, 3);
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; fap += 3) {
    made.targets.push_back(
        {fap, head::Part(fap % head::kPartCount), {1, 5, 11}, {{}, {1, 0, 0}, {}}});
  }
  made.eased = true;
  return made;
}

TEST(HeadStore, RefusesHeadsThatIndexBehindTheirLists) {
  const head::Head good = small_head();
  ASSERT_TRUE(studio::restore_head(studio::store_head(good)));
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::pair<const char*, std::function<void(head::Head&)>>> planted = {
      {"triangle", [](head::Head& h) { h.parts[0].triangles[2][1] = 12; }},
      {"colours", [](head::Head& h) { h.parts[3].colours.pop_back(); }},
      {"occlusion", [](head::Head& h) { h.parts[3].occlusion.push_back(1); }},
      {"surface", [](head::Head& h) { h.parts[1].surface = head::SurfaceKind(6); }},
      {"position", [](head::Head& h) { h.parts[0].positions[0].y = kNan; }},
      {"far", [](head::Head& h) { h.parts[0].positions[0].y = 1e30f; }},
      {"point", [](head::Head& h) { h.feature_points[83].vertex = 12; }},
      {"part of a point", [](head::Head& h) { h.feature_points[0].part = head::Part(10); }},
      {"unit", [](head::Head& h) { h.fapu.mw = 0; }},
      {"lip", [](head::Head& h) { h.seams.lips[1].lower = 12; }},
      {"lid", [](head::Head& h) { h.seams.lids[1][0].upper = ~0u; }},
      {"lid weights", [](head::Head& h) { h.seams.lid_weights[3].pop_back(); }},
      {"jaw weights", [](head::Head& h) { h.seams.jaw_weights.resize(3); }},
      {"freedom", [](head::Head& h) { h.seams.freedom[0] = kNan; }},
      {"neck", [](head::Head& h) { h.seams.neck_weights[0] = -1; }},
      {"lash", [](head::Head& h) { h.lash_anchors[11] = 12; }},
      {"lashes", [](head::Head& h) { h.lash_anchors.clear(); }},
      {"gain", [](head::Head& h) { h.mouth_gain = kNan; }},
      {"eye", [](head::Head& h) { h.eyes[0].radius = -1; }},
      {"no skin", [](head::Head& h) { h.parts[0] = {}; }},
      {"control", [](head::Head& h) { h.targets[0].control = 69; }},
      {"emotion", [](head::Head& h) { h.targets[0].control = 2; }},
      {"part of a target", [](head::Head& h) { h.targets[0].part = head::Part(10); }},
      {"vertex", [](head::Head& h) { h.targets[0].vertices[2] = 12; }},
      {"twice", [](head::Head& h) { h.targets[0].vertices[1] = 1; }},
      {"deltas", [](head::Head& h) { h.targets[0].deltas.pop_back(); }},
      {"delta", [](head::Head& h) { h.targets[0].deltas[0].x = kNan; }},
      {"range", [](head::Head& h) { h.targets[0].low = 1, h.targets[0].high = 0; }},
      {"no range", [](head::Head& h) { h.targets[0].high = kNan; }},
  };
  for (const auto& [what, plant] : planted) {
    head::Head bad = good;
    plant(bad);
    EXPECT_FALSE(studio::restore_head(studio::store_head(bad))) << what;
  }
}

// With the sum of what it holds: somebody may have made it.
void put_sum(std::string& bytes) {
  std::uint64_t sum = 0xCBF29CE484222325u;
  const std::size_t end = bytes.size() - sizeof sum;
  for (std::size_t i = 0; i < end; i += sizeof sum) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, end - i));
    sum = (sum ^ word) * 0x100000001B3u;
  }
  std::memcpy(bytes.data() + end, &sum, sizeof sum);
}

TEST(HeadStore, WhateverIsRestoredMoves) {
  const std::string whole = studio::store_head(small_head());
  std::string same = whole;
  put_sum(same);
  ASSERT_TRUE(same == whole);
  std::uint64_t build = 0;  // a text of this length, which has to stay
  std::memcpy(&build, whole.data(), sizeof build);
  const std::size_t first = sizeof build + std::size_t(build);
  std::mt19937 random(47);
  int restored = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string bytes = whole;
    for (auto n = 1 + random() % 3; n > 0; --n) {
      const std::size_t at = first + random() % (bytes.size() - first - 8);
      const auto what = random() % 6;
      if (what == 0) bytes[at] = char(random());
      if (what == 1) bytes[at] = char(bytes[at] ^ (1 << (random() % 8)));
      if (what == 2) std::fill_n(bytes.begin() + std::ptrdiff_t(at), 4, char(0xFF));
      if (what == 3) std::fill_n(bytes.begin() + std::ptrdiff_t(at), 8, char(0));
      if (what == 4) bytes.erase(at, random() % 9);
      if (what == 5) bytes.insert(at, random() % 9, char(random()));
    }
    put_sum(bytes);
    const auto head = studio::restore_head(bytes);
    if (!head) continue;
    ++restored;
    const head::Rig rig = head::make_rig(*head);
    fap::Frame frame;
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) frame.set(fap, 900);
    EXPECT_EQ(head::pose(rig, frame).positions[0].size(), head->parts[0].positions.size());
  }
  EXPECT_GT(restored, 400);  // another position is still a head
}

TEST(HeadStore, BelongsToTheUserAloneAndFollowsNoLinks) {
  const TempDir dir;
  const std::string folder = dir.file("cache/animeme");
  const auto mode_of = [](const std::string& path) {
    struct stat status = {};
    return ::lstat(path.c_str(), &status) == 0 ? int(status.st_mode & 07777) : -1;
  };
  ASSERT_TRUE(studio::ready_head("child", folder));
  const std::string file = only_file(folder);
  EXPECT_EQ(mode_of(folder), 0700);
  EXPECT_EQ(mode_of(dir.file("cache")), 0700);
  EXPECT_EQ(mode_of(file), 0600);

  const auto is_made =
      [whole = studio::restore_head(slurp(file))->parts[0].positions](const std::string& path) {
        const auto head = studio::restore_head(slurp(path));
        return head && head->parts[0].positions == whole;
      };
  // A planted link is neither read nor written through: what it leads to stays.
  const std::string theirs = dir.file("theirs");
  head::Head other = *studio::restore_head(slurp(file));
  other.parts[0].positions[0].x += 1;
  spill(theirs, studio::store_head(other));
  const std::string before = slurp(theirs);
  fs::remove(file);
  fs::create_symlink(theirs, file);
  const auto made = studio::ready_head("child", folder);
  ASSERT_TRUE(made);
  EXPECT_NE(made->parts[0].positions[0], other.parts[0].positions[0]);
  EXPECT_TRUE(slurp(theirs) == before);
  EXPECT_FALSE(fs::is_symlink(file));
  EXPECT_TRUE(is_made(file));

  // Nor is a folder that is a link, and a pipe keeps nobody waiting.
  const std::string link = dir.file("link");
  fs::create_directory(dir.file("documents"));
  fs::create_directory_symlink(dir.file("documents"), link);
  EXPECT_TRUE(studio::ready_head("child", link));
  EXPECT_TRUE(fs::is_empty(dir.file("documents")));
  fs::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  ASSERT_TRUE(studio::ready_head("child", folder));
  EXPECT_TRUE(is_made(file));

  // What others may write is not believed, and becomes ours again.
  spill(file, before);
  fs::permissions(file, fs::perms(0666));
  fs::permissions(folder, fs::perms(0777));
  const auto again = studio::ready_head("child", folder);
  ASSERT_TRUE(again);
  EXPECT_NE(again->parts[0].positions[0], other.parts[0].positions[0]);
  EXPECT_EQ(mode_of(folder), 0700);
  EXPECT_EQ(mode_of(file), 0600);
}

TEST(HeadStore, IsOfNoneIfThereIsNoFolder) {
  EXPECT_TRUE(studio::ready_head("child", ""));
  EXPECT_TRUE(studio::ready_head("child", "/dev/null/cache"));
  EXPECT_EQ(studio::ready_head("me.glb", "").error().code, Code::not_found);
}

}  // namespace head_store_test
}  // namespace animeme::test
