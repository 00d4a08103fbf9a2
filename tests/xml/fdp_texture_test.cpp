// Textures of Xface files: ours written and read, those of others, and what is left out with a
// note.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "fap/head/srgb.h"
#include "fap/head/wrl.h"
#include "fap/xml/detail/tga.h"
#include "fap/xml/fdp.h"
#include "tests/head/head_support.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tests/support/temp_dir.h"
#include "tests/xml/deltas.h"

namespace animeme::test {
namespace fdp_texture_test {

using head::FdpFiles;
using head::Head;
using head::Mesh;
using head::Vec3;
using head::detail::read_tga;
using head::detail::TgaPicture;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const FdpFiles& files_of(const std::string& name) {
  static std::map<std::string, FdpFiles> made;
  auto found = made.find(name);
  if (found == made.end()) {
    // Regions take long and are tested elsewhere.
    found = made.emplace(name, *head::write_fdp(head_of(name), rig_of(name),
                                                {.name = name, .regions = 1}))
                .first;
  }
  return found->second;
}

// The files of a head, the mesh without its list of colours: only the textures tell.
head::LoadMeshFile textures_only(const std::string& name) {
  return [=](const std::string& wanted) -> Result<std::string> {
    const FdpFiles& files = files_of(name);
    if (wanted == name + ".wrl") {
      std::string wrl = files.wrl;
      for (auto at = wrl.find("color Color"); at != wrl.npos; at = wrl.find("color Color")) {
        wrl.erase(at, wrl.find(" ] }", at) + 4 - at);
      }
      return wrl;
    }
    for (const head::FdpTexture& texture : files.textures) {
      if (texture.name == wanted) return texture.content;
    }
    return make_error(Code::not_found, "there is no file " + wanted);
  };
}

// Of 255.
struct ColourError {
  double rms = 0;
  double largest = 0;
  std::size_t count = 0;

  void add(Vec3 linear_is, Vec3 linear_was) {
    const Vec3 d = (head::srgb_of_linear(linear_is) - head::srgb_of_linear(linear_was)) * 255.0f;
    rms += double(dot(d, d)) / 3;
    largest =
        std::max({largest, double(std::abs(d.x)), double(std::abs(d.y)), double(std::abs(d.z))});
    ++count;
  }
  double mean() const { return std::sqrt(rms / double(std::max<std::size_t>(count, 1))); }
};

class FdpTexture : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Heads, FdpTexture, ::testing::Values("woman", "man", "child"));

// What the README says.
TEST_P(FdpTexture, ColoursComeBackFromTheTexturesAlone) {
  const auto source = head::read_fdp(files_of(GetParam()).fdp, textures_only(GetParam()));
  ASSERT_TRUE(source) << source.error().describe();
  EXPECT_THAT(source->notes, Each(Not(HasSubstr("texture"))));
  const auto back = head::assemble(*source);
  ASSERT_TRUE(back) << back.error().describe();
  double rms = 0, largest = 0;  // of the worst parts
  for (std::size_t p = 0; p < head::kPartCount; ++p) {
    const Mesh& was = head_of(GetParam()).parts[p];
    const Mesh& is = back->parts[p];
    ASSERT_EQ(is.colours.size(), was.colours.size()) << head::kPartNames[p];
    ColourError error;
    for (std::size_t v = 0; v < is.colours.size(); ++v) error.add(is.colours[v], was.colours[v]);
    EXPECT_LT(error.mean(), 1.0) << head::kPartNames[p];
    EXPECT_LT(error.largest, 4) << head::kPartNames[p];
    largest = std::max(largest, error.largest);
    rms = std::max(rms, error.mean());
  }
  std::printf("%s: colours of vertices from textures are off by %.2f of 255 (RMS), at most %.1f\n",
              GetParam().c_str(), rms, largest);
}

// Within a triangle the texture runs as the colours of its corners do.
TEST_P(FdpTexture, NothingElseIsSeenBetweenTheVertices) {
  const auto load = textures_only(GetParam());
  const auto pieces = head::read_wrl(files_of(GetParam()).wrl);
  ASSERT_TRUE(pieces);
  std::istringstream in(files_of(GetParam()).wrl);
  std::string word;
  std::size_t p = 0;
  double rms = 0, largest = 0;
  TgaPicture picture;
  while (in >> word) {
    if (word == "url") {
      in >> word;
      picture = *read_tga(*load(word.substr(1, word.size() - 2)));
    }
    if (word != "texCoord") continue;
    while (word != "[") in >> word;
    std::vector<head::TexturePlace> places;
    while (word != "]") {
      head::TexturePlace place;
      in >> place.u >> place.v >> word;
      places.push_back(place);
    }
    const Mesh& mesh = (*pieces)[p++].mesh;
    ASSERT_EQ(places.size(), mesh.positions.size());
    ColourError error;
    for (const head::Triangle& t : mesh.triangles) {
      head::TexturePlace middle;
      Vec3 colour;
      for (const std::uint32_t v : t) {
        middle.u += places[v].u / 3;
        middle.v += places[v].v / 3;
        colour += head::srgb_of_linear(mesh.colours[v]) * (1 / 3.0f);
      }
      error.add(head::detail::colour_at(picture, middle), head::linear_of_srgb(colour));
    }
    EXPECT_LT(error.mean(), 1.0) << p;
    EXPECT_LT(error.largest, 8) << p;
    largest = std::max(largest, error.largest);
    rms = std::max(rms, error.mean());
  }
  EXPECT_EQ(p, pieces->size());
  std::printf("%s: within triangles by %.2f, at most %.1f\n", GetParam().c_str(), rms, largest);
}

// The player takes sides of 2 to 512, powers of two, three bytes per texel after 18 bytes of
// header.
TEST_P(FdpTexture, EachIsATgaThatXfaceTakes) {
  EXPECT_THAT(files_of(GetParam()).textures, SizeIs(head::kPartCount));
  for (const head::FdpTexture& texture : files_of(GetParam()).textures) {
    const std::string& bytes = texture.content;
    EXPECT_EQ(bytes.substr(0, 3), std::string("\0\0\2", 3)) << texture.name;
    const auto word = [&](std::size_t i) {
      return std::uint8_t(bytes[i]) + 256 * std::uint8_t(bytes[i + 1]);
    };
    for (const std::size_t at : {12u, 14u}) {
      const int side = word(at);
      EXPECT_TRUE(side >= 2 && side <= 512 && (side & (side - 1)) == 0) << side;
    }
    EXPECT_EQ(bytes[16], 24);
    EXPECT_EQ(bytes[17], 0);  // the first texel is the lower left one
    EXPECT_EQ(bytes.size(), 18 + 3 * std::size_t(word(12)) * std::size_t(word(14)));
    EXPECT_THAT(texture.name, Not(HasSubstr(" ")));
    EXPECT_THAT(files_of(GetParam()).wrl, HasSubstr("url \"" + texture.name + "\" }"));
  }
}

// A reader by others, if there is one.
TEST(FdpTextureReaders, FfmpegSeesTheSameTexels) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  const TempDir dir;
  const head::FdpTexture& texture = files_of("child").textures[0];
  spill(dir / "t.tga", texture.content);
  const std::string command = "ffmpeg -v error -i '" + (dir / "t.tga") +
                              "' -f rawvideo -pix_fmt rgb24 '" + (dir / "t.rgb") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string rgb = slurp(dir / "t.rgb");
  const TgaPicture ours = *read_tga(texture.content);
  ASSERT_EQ(rgb.size(), ours.rgb.size());
  for (int y = 0; y < ours.height; ++y) {  // from the top there
    for (int i = 0; i < 3 * ours.width; ++i) {
      ASSERT_EQ(std::uint8_t(rgb[std::size_t(y * 3 * ours.width + i)]),
                ours.texel(0, ours.height - 1 - y)[i]);
    }
  }
}

// A picture of two texels side by side: a red one and a blue one.
std::string two_texels(int type, int descriptor, int depth, const std::string& texels) {
  std::string tga(18, '\0');
  tga[2] = char(type);
  tga[12] = 2;
  tga[14] = 1;
  tga[16] = char(depth);
  tga[17] = char(descriptor);
  return tga + texels;
}
const std::string kRed = {0, 0, char(255)};
const std::string kBlue = {char(255), 0, 0};

TEST(Tga, KindsThatPeopleHave) {
  const std::vector<std::uint8_t> wanted = {255, 0, 0, 0, 0, 255};
  const auto expect = [&](const std::string& bytes, const char* trouble) {
    const auto picture = read_tga(bytes);
    ASSERT_TRUE(picture) << picture.error().describe();
    EXPECT_EQ(picture->rgb, wanted);
    EXPECT_THAT(picture->trouble, HasSubstr(trouble));
  };
  const char* const kOneHigh = "powers of two";
  expect(two_texels(2, 0, 24, kRed + kBlue), kOneHigh);
  expect(two_texels(2, 0x10, 24, kBlue + kRed), kOneHigh);
  expect(two_texels(2, 0, 32, kRed + "\x7f" + kBlue + "\x01"), kOneHigh);
  expect(two_texels(10, 0, 24, "\x01" + kRed + kBlue), kOneHigh);
  expect(two_texels(10, 0, 24, std::string("\0", 1) + kRed + "\x80" + kBlue), kOneHigh);
  std::string comment = two_texels(2, 0, 24, "note" + kRed + kBlue);
  comment[0] = 4;
  expect(comment, kOneHigh);
  const auto grey = read_tga(two_texels(3, 0, 8, "\x10\x20"));
  ASSERT_TRUE(grey);
  EXPECT_EQ(grey->rgb, (std::vector<std::uint8_t>{16, 16, 16, 32, 32, 32}));
  // Two rows, given from the top.
  std::string rows = two_texels(2, 0x20, 24, kBlue + kRed);
  rows[12] = 1;
  rows[14] = 2;
  expect(rows, "powers of two");
  std::string square = two_texels(2, 0x20, 24, kRed + kBlue + kRed + kBlue);
  square[14] = 2;
  EXPECT_THAT(read_tga(square)->trouble, HasSubstr("lower left"));
  square[17] = 0;
  EXPECT_THAT(read_tga(square)->trouble, IsEmpty());
  const TgaPicture again = *read_tga(write_tga(*read_tga(square)));
  EXPECT_EQ(again.rgb, read_tga(square)->rgb);
  EXPECT_EQ(write_tga(again), square);
}

TEST(Tga, DamagedOnesAreRefusedWithASentence) {
  const auto expect = [](const std::string& bytes, Code code, const char* text) {
    const auto picture = read_tga(bytes);
    ASSERT_FALSE(picture);
    EXPECT_EQ(picture.error().code, code);
    EXPECT_THAT(picture.error().message, HasSubstr(text));
  };
  const std::string good = two_texels(2, 0, 24, kRed + kBlue);
  for (std::size_t n = 0; n < good.size(); ++n) {
    expect(good.substr(0, n), Code::truncated, "ends");
  }
  const std::string runs = two_texels(10, 0, 24, "\x81" + kRed);
  for (std::size_t n = 18; n < runs.size(); ++n) expect(runs.substr(0, n), Code::truncated, "ends");
  expect(two_texels(1, 0, 8, "ab"), Code::unsupported, "uncompressed TGA");
  expect(two_texels(2, 0, 16, "abcd"), Code::unsupported, "uncompressed TGA");
  expect(two_texels(2, 0, 25, kRed + kBlue), Code::unsupported, "uncompressed TGA");
  expect("\x89PNG\r\n\x1a\n--------------", Code::unsupported, "uncompressed TGA");
  std::string huge = good;
  huge[12] = huge[13] = huge[14] = huge[15] = char(255);
  expect(huge, Code::out_of_range, "65535 x 65535");
  std::string nothing = good;
  nothing[12] = 0;
  expect(nothing, Code::out_of_range, "0 x 1");
}

// The mask of nine points with a texture on its face: left half red, right half blue.
class TexturedMask : public ::testing::Test {
 protected:
  head::Source read(const std::string& more, const std::string& texture,
                    const std::string& url = "face.tga") const {
    asked_.clear();
    const auto load = [&](const std::string& name) -> Result<std::string> {
      asked_.push_back(name);
      if (name == "face.tga") return texture;
      if (name != "mask.wrl") return make_error(Code::not_found, "there is no file " + name);
      return replaced(data_file("heads/mask.wrl"), "Shape { geometry IndexedFaceSet {",
                      "Shape { appearance Appearance { texture ImageTexture { url \"" + url +
                          "\" } } geometry IndexedFaceSet { " + more);
    };
    auto source = head::read_fdp(data_file("heads/mask.fdp"), load);
    EXPECT_TRUE(source) << source.error().describe();
    return source ? std::move(*source) : head::Source{};
  }
  static std::string square() {
    std::string tga = two_texels(2, 0, 24, kRed + kBlue + kRed + kBlue);
    tga[14] = 2;
    return tga;
  }
  static constexpr const char* kPlaces =
      "texCoord TextureCoordinate { point [ .25 .5, .25 .5, .25 .5, .75 .5, .25 .5, 1.75 .5, .25 "
      ".5, .5 .5, -.25 .5 ] }";
  mutable std::vector<std::string> asked_;
};

TEST_F(TexturedMask, VerticesGetTheColoursOfTheirPlaces) {
  const head::Source source = read(kPlaces, square());
  EXPECT_THAT(source.notes, Each(Not(HasSubstr("texture"))));
  const Mesh& mesh = source.pieces[0].mesh;
  ASSERT_THAT(mesh.colours, SizeIs(9));
  EXPECT_EQ(mesh.colours[0], (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.colours[3], (Vec3{0, 0, 1}));
  EXPECT_EQ(mesh.colours[5], (Vec3{0, 0, 1}));  // it repeats
  EXPECT_EQ(mesh.colours[8], (Vec3{0, 0, 1}));
  EXPECT_NEAR(mesh.colours[7].x, head::linear_of_srgb(0.5f), 1e-6);  // half way between
  EXPECT_NEAR(mesh.colours[7].z, head::linear_of_srgb(0.5f), 1e-6);
}

// A vertex at a seam has several places; its colour is their mean.
TEST_F(TexturedMask, CornersMayHaveTheirOwnPlaces) {
  std::string index = "texCoordIndex [ ";
  for (int t = 0; t < 10; ++t) index += t == 0 ? "1 0 0 -1 " : "0 0 0 -1 ";
  const head::Source source =
      read("texCoord TextureCoordinate { point [ .25 .5, .75 .5 ] } " + index + "]", square());
  const Mesh& mesh = source.pieces[0].mesh;
  ASSERT_THAT(mesh.colours, SizeIs(9));
  EXPECT_EQ(mesh.colours[8], (Vec3{1, 0, 0}));
  EXPECT_NEAR(mesh.colours[0].z, 0.25f, 1e-6);  // one of its four corners
}

TEST_F(TexturedMask, WhatCannotBeUsedIsLeftOutWithANote) {
  const auto expect = [&](const std::string& more, const std::string& texture,
                          const std::string& url, const char* text) {
    const head::Source source = read(more, texture, url);
    EXPECT_THAT(source.notes, Contains(HasSubstr(text))) << url;
    ASSERT_FALSE(source.pieces.empty());
    EXPECT_THAT(source.pieces[0].mesh.colours, IsEmpty());
    EXPECT_THAT(asked_, Each(::testing::AnyOf("mask.wrl", "face.tga", "none.tga")));
  };
  const char* const kOutside = "is not in the folder of the .fdp file; put it there";
  expect(kPlaces, square(), "../face.tga", kOutside);
  expect(kPlaces, square(), "../../etc/passwd", kOutside);
  expect(kPlaces, square(), "/etc/passwd", kOutside);
  expect(kPlaces, square(), "file:///etc/passwd", kOutside);
  expect(kPlaces, square(), "c:\\face.tga", kOutside);
  expect(kPlaces, square(), "none.tga", "there is no file none.tga");
  expect(kPlaces, square().substr(0, 25), "face.tga", "ends before its last row");
  expect(kPlaces, "GIF89a............", "face.tga", "uncompressed TGA");
  expect("", square(), "face.tga", "mask.wrl_0 is left out: the mesh has no texCoord");
  expect("texCoord TextureCoordinate { point [ 0 0, 1 1 ] }", square(), "face.tga",
         "names texture coordinate 3, but there are 2");
  expect(std::string(kPlaces) + " texCoordIndex [ 0 3 99 -1 ]", square(), "face.tga",
         "names texture coordinate 99, but there are 9");
  expect(std::string(kPlaces) + " texCoordIndex [ 0 3 2 -1 0 -1 ]", square(), "face.tga",
         "names texture coordinate -1");
  std::string compressed = two_texels(10, 0, 24, "\x83" + kRed);
  compressed[14] = 2;
  const head::Source shown = read(kPlaces, compressed);
  EXPECT_THAT(shown.notes, Contains(HasSubstr("Xface does not show")));
  EXPECT_EQ(shown.pieces[0].mesh.colours.at(0), (Vec3{1, 0, 0}));
}

}  // namespace fdp_texture_test
}  // namespace animeme::test
