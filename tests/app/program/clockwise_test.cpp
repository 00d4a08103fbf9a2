// Heads whose triangles are wound clockwise, as each kind of file that is read: the program turns
// them and says so.
#include <gmock/gmock.h>

#include <cstring>
#include <sstream>

#include "fap/head/vector.h"
#include "tests/app/program/commands.h"

namespace animeme::test {
namespace clockwise_test {

using ::testing::HasSubstr;

// Every second and third corner in lists of "a, b, c, -1" (VRML97) or "a b c -1" (XMT-A).
std::string lists_flipped(const std::string& text, const std::string& begin, char end) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t list = text.find(begin); list != text.npos; list = text.find(begin, at)) {
    list += begin.size();
    out += text.substr(at, list - at);
    at = text.find(end, list);
    std::string numbers = text.substr(list, at - list);
    std::replace(numbers.begin(), numbers.end(), ',', ' ');
    std::istringstream in(numbers);
    for (std::array<int, 4> n{}; in >> n[0] >> n[1] >> n[2] >> n[3];) {
      EXPECT_EQ(n[3], -1);
      for (const int i : {n[0], n[2], n[1], n[3]}) out += " " + std::to_string(i);
    }
    out += ' ';
  }
  return out + text.substr(at);
}

std::string obj_flipped(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string f, a, b, c;
    words >> f >> a >> b >> c;
    out += (f == "f" ? "f " + a + " " + c + " " + b : line) + "\n";
  }
  return out;
}

template <class Number>
void swap_corners(char* bytes, std::size_t count) {
  for (std::size_t i = 0; i + 2 < count; i += 3) {
    std::array<Number, 3> t;
    std::memcpy(t.data(), bytes + i * sizeof(Number), sizeof t);
    std::swap(t[1], t[2]);
    std::memcpy(bytes + i * sizeof(Number), t.data(), sizeof t);
  }
}

std::string glb_flipped(std::string glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, 4);
  const Json json = Json::parse(glb.substr(20, length));
  char* const binary = glb.data() + 20 + length + 8;
  for (const Json& mesh : json["meshes"]) {
    for (const Json& primitive : mesh["primitives"]) {
      const Json& accessor = json["accessors"][primitive["indices"].get<std::size_t>()];
      const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
      char* const first = binary + view.value("byteOffset", std::size_t(0)) +
                          accessor.value("byteOffset", std::size_t(0));
      const auto count = accessor["count"].get<std::size_t>();
      if (accessor["componentType"] == 5123) swap_corners<std::uint16_t>(first, count);
      if (accessor["componentType"] == 5125) swap_corners<std::uint32_t>(first, count);
    }
  }
  return glb;
}

// All parts are closed, so that their volumes tell where their outsides are.
double volume(const std::string& obj) {
  std::istringstream in(obj);
  std::vector<head::Vec3d> places(1);
  double sum = 0;
  for (std::string line; std::getline(in, line);) {
    head::Vec3d p;
    std::array<std::size_t, 3> t{};
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &p.x, &p.y, &p.z) == 3) places.push_back(p);
    if (std::sscanf(line.c_str(), "f %zu %zu %zu", &t[0], &t[1], &t[2]) != 3) continue;
    sum += dot(places.at(t[0]), cross(places.at(t[1]), places.at(t[2]))) / 6;
  }
  return sum;
}

TEST(Clockwise, EachKindOfFileIsTurned) {
  const TempDir dir;
  const struct {
    std::string head, mesh;  // the file with the triangles
    std::string (*flipped)(const std::string&);
  } kinds[] = {
      {"child.obj", "child.obj", obj_flipped},
      {"child.fdp", "child.wrl",
       [](const std::string& text) { return lists_flipped(text, " coordIndex [", ']'); }},
      {"child.xmt", "child.xmt",
       [](const std::string& text) { return lists_flipped(text, "_faces\" coordIndex=\"", '"'); }},
      {"child.glb", "child.glb", [](const std::string& text) { return glb_flipped(text); }}};
  double wanted = 0;
  for (const auto& kind : kinds) {
    succeeds({"head", "child", "-o", dir / kind.head});
    const std::string text = slurp(dir / kind.mesh);
    const std::string flipped = kind.flipped(text);
    ASSERT_NE(flipped, text);
    if (kind.head == "child.obj") {
      wanted = volume(text);
      EXPECT_NEAR(volume(flipped), -wanted, 0.1);
    }
    spill(dir / kind.mesh, flipped);
    std::vector<std::string> read = {"head", dir / kind.head, "-o", dir / "again.obj"};
    if (kind.head == "child.obj") read.insert(read.end(), {"--points", dir / "child.points.csv"});
    const auto turned = animeme(read);
    ASSERT_EQ(turned.exit_code, 0) << turned.err;
    EXPECT_THAT(turned.err, HasSubstr(": flipped all "));
    EXPECT_THAT(turned.err, HasSubstr(" inside-out triangles"));
    // Lengths of a .glb are found from its eyes.
    const double tolerance = kind.head == "child.glb" ? 0.1 : 0.001;
    EXPECT_NEAR(volume(slurp(dir / "again.obj")), wanted, tolerance * wanted) << kind.head;
  }
}

}  // namespace clockwise_test
}  // namespace animeme::test
