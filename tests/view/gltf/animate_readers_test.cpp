// What the Khronos validator says of avatars before and after, and avatars of others.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/files.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tests/view/gltf/avatar_file.h"

namespace animeme::gltf {
namespace animate_readers_test {

using nlohmann::json;

// Avatars of others, where they are: nothing is lost and the validator has nothing new to say.
json issues_of(const std::string& path) {
  const std::string script =
      std::string(test::kSourceFolder) + "/tests/view/gltf/scripts/validate.js";
  const json report = json::parse(
      test::run("node " + test::quoted(script) + " " + test::quoted(path)), nullptr, false);
  json counts = json::object();
  for (const json& message : report["issues"]["messages"]) {
    // An extension that the validator does not know, and what only that uses.
    if (message["severity"].get<int>() >= 2) continue;
    json& count = counts[message["code"].get<std::string>()];
    count = count.is_null() ? 1 : count.get<int>() + 1;
  }
  EXPECT_TRUE(report.contains("issues"));
  return counts;
}

bool has_validator() {
  return test::has_program("node") &&
         std::filesystem::exists(std::string(test::kSourceFolder) +
                                 "/tests/readers/js/node_modules/gltf-validator");
}

TEST(AnimateReaders, TheValidatorFindsNothingNew) {
  if (!has_validator()) GTEST_SKIP() << "npm gltf-validator is not installed: tools/setup.sh tests";
  const test::TempDir dir;
  const NamedClip clips[] = {{"talk", talk(), FileSound{"audio/wav", {1, 2, 3}}, "voice.wav"}};
  for (const Bytes& before : {woman(), Crooked().file.glb()}) {
    test::write_bytes(dir / "before.glb", before);
    test::write_bytes(dir / "after.glb", whole(animate_file(before, clips)));
    EXPECT_EQ(issues_of(dir / "before.glb"), issues_of(dir / "after.glb"));
  }
}

TEST(AnimateReaders, AvatarsOfOthersStayWhatTheyAre) {
  const auto folder = test::shared_dir() / "data" / "avatars";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "there are no avatars";
  const test::TempDir dir;
  const NamedClip clips[] = {{"talk", talk()}};
  for (const char* name :
       {"brunette-t.glb", "arkit_and_visemes.glb", "visemes_only.glb", "vroid.glb"}) {
    SCOPED_TRACE(name);
    const std::string path = (folder / name).string();
    const Bytes before = test::read_bytes(path);
    const auto file = animate_file(before, clips);
    const Bytes after = whole(file);
    expect_kept(before, after);
    EXPECT_GE(file->bones, 2u);
    if (!has_validator()) continue;
    test::write_bytes(dir / name, after);
    EXPECT_EQ(issues_of(path), issues_of(dir / name));
  }
}

}  // namespace animate_readers_test
}  // namespace animeme::gltf
