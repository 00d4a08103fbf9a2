// Heads from strangers, in the program under a limit of memory.
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/app/program/commands.h"
#include "tests/support/folders.h"
#include "tests/support/gltf_writer.h"
#include "tests/support/picture_writer.h"
#include "tests/support/sanitized.h"
#include "tests/support/shared.h"

namespace animeme {
namespace hostile_head_test {

using nlohmann::json;
using test::Bytes;
using ::testing::HasSubstr;

// A whole head of 22 kB.
struct Mask : test::GltfWriter {
  Mask() {
    const test::TempDir dir;
    test::succeeds(
        {"head", (test::data_dir() / "heads" / "mask.fdp").string(), "-o", dir / "mask.glb"});
    const Bytes file = test::read_bytes(dir / "mask.glb");
    const std::size_t size = std::size_t(file[12]) + 256 * std::size_t(file[13]);
    root = json::parse(file.begin() + 20, file.begin() + 20 + std::ptrdiff_t(size));
    binary.assign(file.begin() + 28 + std::ptrdiff_t(size), file.end());
    const std::size_t vertices =
        root["accessors"][face()["attributes"]["POSITION"].get<std::size_t>()]["count"];
    face()["attributes"]["TEXCOORD_0"] = accessor(std::vector<float>(2 * vertices, 0.5f), "VEC2");
  }
  json& face() { return root["meshes"][0]["primitives"][0]; }

  // The first mesh is shown with this picture.
  void paint(const Bytes& picture) { paint(view(picture)); }
  void paint(int picture) {
    const int image = add("images", {{"bufferView", picture}});
    const int texture = add("textures", {{"source", image}});
    face()["material"] =
        add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  }
  // ... and once more as it is now.
  void repeat() { root["meshes"][0]["primitives"].push_back(face()); }
};

// As PNG writes it best: some kB.
Bytes black(int side) {
  return test::png_as(Bytes(std::size_t(side) * std::size_t(side) / 8), side, side,
                      {.colour = PNG_COLOR_TYPE_GRAY, .depth = 1});
}

// The program with 300 MB for all data; HEAD and OUT stand for files.
test::ProgramResult within_300_mb(const Bytes& head, std::vector<std::string> arguments) {
  const test::TempDir dir;
  test::write_bytes(dir / "head.glb", head);
  const std::string limit = test::kAddressSanitizer ? "" : "ulimit -d 300000; ";
  std::vector<std::string> command = {"sh", "-c", limit + "exec \"$@\"", "sh",
                                      std::string(test::kBinaryFolder) + "/bin/animeme"};
  for (const std::string& argument : arguments) {
    command.push_back(argument == "HEAD"  ? dir / "head.glb"
                      : argument == "OUT" ? dir / "out.html"
                                          : argument);
  }
  return test::run_command(command);
}

void is_shown_with_a_note(const Bytes& head, const std::string& note) {
  const auto result = within_300_mb(head, {"head", "HEAD"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out + result.err, HasSubstr(note));
}

void ends_in_a_sentence(const Bytes& head, const std::string& sentence) {
  const auto result = within_300_mb(head, {"head", "HEAD"});
  EXPECT_EQ(result.exit_code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr(sentence));
}

TEST(HostileHead, PicturesThatBreakDecoders) {
  const std::string clip = (test::data_dir() / "fap" / "plain.fap").string();
  for (const Bytes& picture : {test::jpeg_with_too_many_symbols(), test::jpeg_without_tables()}) {
    Mask mask;
    mask.paint(picture);
    is_shown_with_a_note(mask.glb(), "texture 0 \"\" is left out: it is damaged");
    const auto page = within_300_mb(mask.glb(), {"view", clip, "--head", "HEAD", "-o", "OUT"});
    EXPECT_EQ(page.exit_code, 0) << page.err;
  }
}

TEST(HostileHead, PicturesThatAreNamedAgainAndAgain) {
  Mask mask;
  const int picture = mask.view(black(8000));
  for (int i = 0; i < 100; ++i) {
    mask.paint(picture);
    mask.repeat();
  }
  is_shown_with_a_note(mask.glb(), "skin");
}

TEST(HostileHead, PicturesThatAreLargeTogether) {
  Mask mask;
  for (int i = 0; i < 30; ++i) {
    mask.paint(black(4000));
    mask.repeat();
  }
  EXPECT_LT(mask.glb().size(), 200'000u);
  is_shown_with_a_note(mask.glb(),
                       "texture 8 \"\" is left out: the file has more than 150 million");
}

TEST(HostileHead, MeshesThatAreShownAgainAndAgain) {
  Mask mask;
  mask.face().erase("targets");
  for (int i = 0; i < 10000; ++i) mask.add("nodes", {{"mesh", 0}, {"name", "face"}});
  mask.root["scenes"] = json::array();
  ends_in_a_sentence(mask.glb(), "more than 500000 vertices");
}

TEST(HostileHead, ShapesThatAreNamedAgainAndAgain) {
  Mask mask;
  const int moves = mask.accessor(std::vector<float>(3 * 5000, 0.5f), "VEC3");
  mask.face()["attributes"] = {{"POSITION", moves}};
  mask.face()["targets"] = json::array();
  for (int i = 0; i < 10000; ++i) mask.face()["targets"].push_back({{"POSITION", moves}});
  mask.root["meshes"][0].erase("weights");
  ends_in_a_sentence(mask.glb(), "more than 4 million moves");
}

TEST(HostileHead, NumbersThatAreNotThere) {
  const std::pair<const char*, const char*> claims[] = {
      {"POSITION", "VEC3"}, {"TEXCOORD_0", "VEC2"}, {"COLOR_0", "VEC4"}, {"WEIGHTS_0", "VEC4"}};
  for (const auto& [name, type] : claims) {
    SCOPED_TRACE(name);
    Mask mask;
    mask.face()["attributes"][name] =
        mask.add("accessors", {{"componentType", 5126}, {"count", 3'000'000'000u}, {"type", type}});
    const auto result = within_300_mb(mask.glb(), {"head", "HEAD"});
    EXPECT_EQ(result.exit_code, std::string(name) == "POSITION" ? 3 : 0) << result.err;
  }
  Mask mask;
  mask.face()["indices"] = mask.add(
      "accessors", {{"componentType", 5125}, {"count", 3'000'000'000u}, {"type", "SCALAR"}});
  ends_in_a_sentence(mask.glb(), "more than 2 million triangles");
}

TEST(HostileHead, FilesThatHaveNoEnd) {
  const test::TempDir dir;
  std::filesystem::create_symlink("/dev/zero", std::filesystem::path(dir / "zero.glb"));
  std::filesystem::create_symlink("/dev/zero", std::filesystem::path(dir / "zero.gltf"));
  test::spill(dir / "large.gltf", "{");
  std::filesystem::resize_file(dir / "large.gltf", std::uintmax_t(1) << 32);
  for (const char* name : {"zero.glb", "zero.gltf", "large.gltf"}) {
    const auto result = within_300_mb({}, {"head", dir / name});
    EXPECT_EQ(result.exit_code, 3) << name << result.err;
  }
}

}  // namespace hostile_head_test
}  // namespace animeme
