// Files that claim much, name things again and again, or lead elsewhere.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "tests/support/picture_writer.h"
#include "tests/support/temp_dir.h"
#include "tests/view/gltf/square.h"

namespace animeme::gltf {
namespace limits_test {

namespace fs = std::filesystem;

using head::Vec3;
using nlohmann::json;
using test::Bytes;
using test::GltfWriter;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

// A square with `count` materials, each with a texture of its own, whose images are these.
struct Painted : Square {
  explicit Painted(const json& images) {
    add_uvs({0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f});
    json primitives = json::array();
    for (const json& image : images) {
      const int source = file.add("images", image);
      const int texture = file.add("textures", {{"source", source}});
      primitive["material"] = file.add(
          "materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
      primitives.push_back(primitive);
    }
    file.add("meshes", {{"primitives", primitives}, {"name", "face"}});
    file.add("nodes", {{"mesh", 0}});
  }
};

Bytes one_colour(int side, std::uint8_t red) {
  Bytes rgba;
  for (int i = 0; i < side * side; ++i) rgba.insert(rgba.end(), {red, 0, 0, 255});
  return test::png_as(rgba, side, side, {});
}

json data_image(const Bytes& bytes) { return {{"uri", GltfWriter::data_uri(bytes)}}; }

Error error_within(const Bytes& file, const ReadLimits& limits) {
  ReadOptions options;
  options.limits = limits;
  const auto source = read_head(file, options);
  EXPECT_FALSE(source);
  return source ? Error{} : source.error();
}

TEST(Limits, TexelsOfAllPicturesTogether) {
  const Painted head({data_image(one_colour(32, 255)), data_image(one_colour(32, 200)),
                      data_image(one_colour(4, 100))});
  ReadOptions options;
  options.limits.texels = 1500;
  const head::Source source = read(head.file.glb(), options);
  // The first and the last fit in.
  EXPECT_THAT(source.notes,
              Contains(AllOf(HasSubstr("texture 1 "), HasSubstr("more than 1500 texels"))));
  EXPECT_THAT(source.notes, Not(Contains(HasSubstr("texture 2 "))));
  options.limits.texels = 32 * 32 * 2 + 4 * 4;
  EXPECT_THAT(read(head.file.glb(), options).notes, Not(Contains(HasSubstr("texels"))));
}

TEST(Limits, APictureThatIsNamedAgainIsDecodedOnce) {
  Painted head(json::array({json{{"bufferView", 0}}, json{{"bufferView", 0}}}));
  const int picture = head.file.view(one_colour(32, 255));
  for (json& image : head.file.root["images"]) image["bufferView"] = picture;
  ReadOptions options;
  options.limits.texels = 32 * 32;
  const head::Source source = read(head.file.glb(), options);
  EXPECT_THAT(source.notes, Not(Contains(HasSubstr("texture"))));
}

TEST(Limits, ABrokenPictureIsLeftOutOfTheHead) {
  for (const Bytes& picture : {test::jpeg_with_too_many_symbols(), test::jpeg_without_tables()}) {
    const head::Source source = read(Painted(json::array({data_image(picture)})).file.glb());
    EXPECT_EQ(source.pieces.size(), 1u);
    EXPECT_THAT(source.notes, Contains(AllOf(HasSubstr("texture 0"), HasSubstr("it is damaged"))));
  }
}

TEST(Limits, WebpIsUsedWhereTheTextureNamesIt) {
  Painted head(
      json::array({data_image({1, 2, 3}), data_image(test::webp_as({255, 0, 0, 255}, 1, 1, -1))}));
  head.file.root["textures"][0] = {{"source", 0},
                                   {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}};
  head.file.root["extensionsRequired"] = {"EXT_texture_webp"};
  const head::Source source = read(head.file.glb());
  EXPECT_THAT(source.notes, Not(Contains(HasSubstr("texture"))));
  expect_near(source.pieces.at(0).mesh.colours.at(0), {1, 0, 0});
}

TEST(Limits, VerticesAreCountedBeforeThereIsRoomForThem) {
  Square square;
  square.file.root["accessors"][0] = {{"componentType", 5126}, {"count", 4e9}, {"type", "VEC3"}};
  EXPECT_THAT(error_of(square.glb()).message,
              AllOf(HasSubstr("more than 500000 vertices"), HasSubstr("reduce")));
  // As often as they are shown.
  Square many;
  const int mesh = many.file.add("meshes", {{"primitives", {many.primitive}}});
  for (int i = 0; i < 20; ++i) many.file.add("nodes", {{"mesh", mesh}});
  EXPECT_TRUE(read_head(many.file.glb()));
  EXPECT_EQ(error_within(many.file.glb(), {.vertices = 1000}).code, Code::out_of_range);
}

TEST(Limits, OtherAccessorsAreReadAsFarAsTheyAreNeeded) {
  Square square;
  const int colours =
      square.file.add("accessors", {{"componentType", 5126}, {"count", 4e9}, {"type", "VEC4"}});
  square.primitive["attributes"]["COLOR_0"] = colours;
  EXPECT_EQ(read(square.glb()).pieces.at(0).mesh.positions.size(), 4u);
  Square skinned;
  skinned.primitive["attributes"]["JOINTS_0"] =
      skinned.file.accessor(std::vector<std::uint8_t>(16, 0), "VEC4");
  skinned.primitive["attributes"]["WEIGHTS_0"] =
      skinned.file.accessor(std::vector<float>(16, 1), "VEC4");
  const int bind =
      skinned.file.add("accessors", {{"componentType", 5126}, {"count", 4e9}, {"type", "MAT4"}});
  skinned.file.add("skins", {{"joints", {0}}, {"inverseBindMatrices", bind}});
  EXPECT_TRUE(read_head(skinned.glb({{"skin", 0}})));
}

TEST(Limits, TrianglesAndMoves) {
  Square square;
  square.primitive["indices"] =
      square.file.add("accessors", {{"componentType", 5125}, {"count", 4e9}, {"type", "SCALAR"}});
  EXPECT_THAT(error_of(square.glb()).message, HasSubstr("more than 2 million triangles"));
  Square moved;
  json targets = json::array(), names = json::array();
  for (int i = 0; i < 1000; ++i) {
    targets.push_back({{"POSITION", 0}});
    names.push_back("shape " + std::to_string(i));
  }
  moved.primitive["targets"] = targets;
  EXPECT_TRUE(read_head(moved.glb()));
  EXPECT_THAT(error_within(moved.glb(), {.moves = 10000}).message,
              HasSubstr("more than 10000 moves of vertices by morph targets"));
}

TEST(Limits, ValuesOfItsJson) {
  std::string text = R"({"asset":{"version":"2.0"},"extras":[)";
  for (int i = 0; i < 1'000'001; ++i) text += "0,";
  text += "0]}";
  EXPECT_THAT(error_of(Bytes(text.begin(), text.end())).message,
              HasSubstr("more than 1 million values"));
  // Commas of texts are none.
  text = R"({"asset":{"version":"2.0"},"extras":"\")" + std::string(2'000'000, ',') + "\"}";
  EXPECT_EQ(error_of(Bytes(text.begin(), text.end())).code, Code::not_found);
}

TEST(Limits, ACutFileSaysAtWhichByte) {
  Bytes file = Square().glb();
  const std::string whole = std::to_string(file.size());
  file.resize(301);
  const Error error = error_of(file);
  EXPECT_EQ(error.code, Code::truncated);
  EXPECT_THAT(error.describe(), HasSubstr("ends too early, after byte 301 of " + whole));
  EXPECT_THAT(error.describe(), Not(HasSubstr("bit")));
}

class HeadFiles : public testing::Test {
 protected:
  // A .gltf in folder "head" whose buffer is the URI; what is left out or wrong.
  std::string says(const std::string& uri) {
    Square square;
    square.glb();
    test::spill(folder() / "a.gltf", square.file.gltf(uri));
    const auto source = read_head_file(folder() / "a.gltf");
    return source ? "" : source.error().describe();
  }
  fs::path folder() const {
    fs::create_directories(fs::path(dir_ / "head"));
    return dir_ / "head";
  }
  Bytes buffer() const {
    Square square;
    square.glb();
    return square.file.binary;
  }

  const test::TempDir dir_;
};

TEST_F(HeadFiles, BesideItOrBelow) {
  fs::create_directories(folder() / "sub");
  test::write_bytes(folder() / "sub" / "a.bin", buffer());
  EXPECT_EQ(says("sub/a.bin"), "");
  fs::create_symlink("sub/a.bin", folder() / "link.bin");
  EXPECT_EQ(says("link.bin"), "");
  EXPECT_THAT(says("none.bin"), HasSubstr("there is no file"));
}

TEST_F(HeadFiles, NoLinkLeadsOut) {
  test::write_bytes(dir_ / "secret.bin", buffer());
  fs::create_symlink(dir_ / "secret.bin", folder() / "link.bin");
  EXPECT_THAT(says("link.bin"), HasSubstr("is outside the folder"));
  fs::create_directory_symlink(fs::path(dir_ / "."), folder() / "up");
  EXPECT_THAT(says("up/secret.bin"), HasSubstr("is outside the folder"));
  EXPECT_THAT(says("../secret.bin"), HasSubstr("is outside the folder"));
}

TEST_F(HeadFiles, NothingThatHasNoEndOrNeverBegins) {
  ASSERT_EQ(mkfifo((folder() / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(says("pipe"), HasSubstr("not a regular file"));
  fs::create_directories(folder() / "sub");
  EXPECT_THAT(says("sub"), HasSubstr("is a folder"));
  ASSERT_EQ(mkfifo((folder() / "pipe.glb").c_str(), 0600), 0);
  EXPECT_FALSE(read_head_file(folder() / "pipe.glb"));
  fs::create_symlink("/dev/zero", folder() / "zero.glb");
  EXPECT_EQ(read_head_file(folder() / "zero.glb").error().code, Code::syntax);
}

TEST_F(HeadFiles, LargeOnesAreNotRead) {
  std::ofstream(folder() / "large.glb") << "no glTF";
  fs::resize_file(folder() / "large.glb", std::uintmax_t(1) << 32);
  EXPECT_EQ(read_head_file(folder() / "large.glb").error().code, Code::syntax);
  std::ofstream(folder() / "large.glb", std::ios::binary)
      << std::string("glTF\2\0\0\0\0\0\0\xF0", 12);
  fs::resize_file(folder() / "large.glb", 0xF0000000);
  EXPECT_THAT(read_head_file(folder() / "large.glb").error().message,
              HasSubstr("more than 256 million bytes"));
  std::ofstream(folder() / "large.gltf") << "{";
  fs::resize_file(folder() / "large.gltf", std::uintmax_t(1) << 32);
  EXPECT_THAT(read_head_file(folder() / "large.gltf").error().message,
              HasSubstr("more than 256 million bytes"));
  std::ofstream(folder() / "large.bin") << "";
  fs::resize_file(folder() / "large.bin", std::uintmax_t(1) << 32);
  EXPECT_THAT(says("large.bin"), HasSubstr("more than 256 million bytes"));
}

// What another program makes of a head comes by a pipe.
TEST_F(HeadFiles, PipesAreReadToTheirEnd) {
  ASSERT_EQ(mkfifo((folder() / "pipe.glb").c_str(), 0600), 0);
  const Bytes file = Square().glb();
  // Opened for reading, too: so the writer does not wait, and the reader finds it.
  std::fstream pipe(folder() / "pipe.glb", std::ios::in | std::ios::out | std::ios::binary);
  pipe.write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size()));
  pipe.flush();
  EXPECT_TRUE(read_head_file(folder() / "pipe.glb"));
}

}  // namespace limits_test
}  // namespace animeme::gltf
