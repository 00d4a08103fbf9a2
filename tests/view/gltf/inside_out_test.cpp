// Heads of others whose meshes are wound the other way: whole files, and piece by piece.
#include <gtest/gtest.h>

#include <algorithm>

#include "fap/head/obj.h"
#include "fap/head/point_list.h"
#include "tests/support/program.h"
#include "tests/support/shared.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {
namespace inside_out_test {

using head::Head;
using head::Source;
using head::Triangle;

void flip(head::Piece& piece) {
  for (Triangle& t : piece.mesh.triangles) std::swap(t[1], t[2]);
}

Head assembled(const Source& source, std::vector<std::string>& notes) {
  notes.clear();
  auto head = head::assemble(source, &notes);
  EXPECT_TRUE(head) << head.error().describe();
  return head ? std::move(*head) : Head{};
}

bool same_side(Triangle a, Triangle b) {
  return a == b || a == Triangle{b[1], b[2], b[0]} || a == Triangle{b[2], b[0], b[1]};
}

std::size_t inside_out(const Head& is, const Head& wanted) {
  std::size_t count = 0;
  for (std::size_t part = 0; part < head::kPartCount; ++part) {
    for (std::size_t t = 0; t < is.parts[part].triangles.size(); ++t) {
      count += same_side(is.parts[part].triangles[t], wanted.parts[part].triangles[t]) ? 0 : 1;
    }
  }
  return count;
}

// Flipped as a whole or piece by piece the head becomes the same. `odd`: meshes that have wrong
// triangles as they come.
void expect_turned(const Source& source, int odd, bool each) {
  const auto loud = [](const std::string& note) { return note.find("inside") != note.npos; };
  std::vector<std::string> notes;
  const Head right = assembled(source, notes);
  EXPECT_EQ(std::count_if(notes.begin(), notes.end(), loud), odd);
  for (std::size_t which = each ? 0 : source.pieces.size(); which <= source.pieces.size();
       ++which) {
    Source wrong = source;
    for (std::size_t p = 0; p < wrong.pieces.size(); ++p) {
      if (which == wrong.pieces.size() || which == p) flip(wrong.pieces[p]);
    }
    EXPECT_EQ(inside_out(assembled(wrong, notes), right), 0u)
        << (which < source.pieces.size() ? source.pieces[which].name : "all");
  }
}

TEST(InsideOut, Avatars) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "the reference data is not there";
  // One triangle in the hair of the second lies between all others the wrong way.
  for (const auto& [name, odd] : {std::pair("brunette-t.glb", 0), {"visemes_only.glb", 1}}) {
    const auto source = read_head_file((shared / "data/avatars" / name).string());
    ASSERT_TRUE(source) << source.error().describe();
    expect_turned(*source, odd, odd > 0);
  }
}

TEST(InsideOut, Ict) {
  const auto shared = test::shared_dir();
  if (shared.empty()) GTEST_SKIP() << "the reference data is not there";
  const auto folder = shared / "data/ict_facekit";
  const std::string text =
      test::run("gzip -dc " + test::quoted((folder / "generic_neutral_mesh.obj.gz").string()));
  auto file = head::read_obj(text);
  ASSERT_TRUE(file);
  auto rows = head::read_points(test::slurp(folder / "ict_feature_points.csv"));
  ASSERT_TRUE(rows) << rows.error().describe();
  auto points = head::points_on(*file, *rows);
  ASSERT_TRUE(points);
  Source source;
  source.pieces = std::move(file->pieces);
  source.points = std::move(*points);
  expect_turned(source, 0, true);
}

}  // namespace inside_out_test
}  // namespace animeme::gltf
