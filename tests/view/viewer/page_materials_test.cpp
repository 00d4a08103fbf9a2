// Materials on the page: it shows what the software renderer shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/png_writer.h"
#include "tests/view/viewer/page_support.h"
#include "tools/view/render/scene.h"
#include "tools/view/viewer/detail/bytes.h"

namespace animeme::test {
namespace page_materials_test {

using head::Material;
using head::Part;

head::Texture texture(int width, std::vector<std::uint8_t> rgba, head::TexelKind kind) {
  const int height = int(rgba.size()) / 4 / width;
  Bytes file = png_of(rgba, width);
  return {std::make_shared<const head::Picture>(head::Texels{width, height, std::move(rgba)}, kind,
                                                std::move(file), "image/png"),
          head::Wrap::clamp, head::Wrap::clamp};
}

// Dots and stripes, so that a place which is wrong is seen.
std::vector<std::uint8_t> pattern() {
  std::vector<std::uint8_t> rgba;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool stripe = x / 8 % 2 == 0;
      rgba.insert(rgba.end(), {std::uint8_t(stripe ? 220 : 90), std::uint8_t(y / 16 % 2 * 90 + 70),
                               std::uint8_t(40 + 3 * y), std::uint8_t(stripe ? 255 : 100)});
    }
  }
  return rgba;
}

void add_corners(head::Mesh& mesh, std::uint16_t material) {
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const head::Vec3 p = mesh.positions[v];
    mesh.corners.push_back({v, {}, {0.5f + p.x / 24, 0.5f - p.y / 24}, {255, 255, 255, 255}});
  }
  mesh.facets = mesh.triangles;
  mesh.materials.assign(mesh.facets.size(), material);
}

const TestHead& head_with_material() {
  static const TestHead made = [] {
    TestHead out;
    std::vector<Material>& materials = out.head.materials;
    const head::Texture base = texture(64, pattern(), head::TexelKind::colour);
    for (int i = 0; i < 5; ++i) materials.emplace_back().base = base;
    materials[0].roughness = 0.5f;
    std::vector<std::uint8_t> bumps;
    for (int i = 0; i < 16; ++i) {
      bumps.insert(bumps.end(), {std::uint8_t(i % 2 == 0 ? 150 : 100), 128, 240, 255});
    }
    materials[0].normal = texture(4, std::move(bumps), head::TexelKind::value);
    materials[1].shading = head::Shading::toon;
    materials[1].shade = {0.1f, 0.05f, 0.2f};
    materials[2].shading = head::Shading::unlit;
    materials[3].alpha_mode = head::AlphaMode::blend;
    // As many files have it: all of it blends, and nothing shines through.
    materials[4].alpha_mode = head::AlphaMode::blend;
    std::vector<std::uint8_t> full = pattern();
    for (std::size_t i = 3; i < full.size(); i += 4) full[i] = 255;
    materials[4].base = texture(64, std::move(full), head::TexelKind::colour);
    materials[4].base.wrap_u = materials[4].base.wrap_v = head::Wrap::mirror;
    add_corners(out.head.part(Part::hair), 4);
    for (head::Corner& c : out.head.part(Part::hair).corners) {
      const head::Vec3 p = out.head.part(Part::hair).positions[c.vertex];
      c.uv = {p.z / 3, p.x / 9};  // what lies behind looks otherwise
    }
    add_corners(out.head.part(Part::skin), 0);
    for (const Part part : {Part::left_eye, Part::right_eye}) add_corners(out.head.part(part), 1);
    add_corners(out.head.part(Part::body), 2);
    add_corners(out.head.part(Part::brows), 3);
    out.rig = head::make_rig(out.head);
    return out;
  }();
  return made;
}

// Until its textures are decoded, a head is not shown: it would be a white statue.
TEST(PageMaterials, AreWaitedFor) {
  NEEDS_BROWSER();
  const TempDir dir;
  const auto opacities = [&](const TestHead& h) {
    const std::string html =
        page_of_head(h,
                     "const canvas = document.getElementById('face');\n"
                     "const seen = () => getComputedStyle(canvas).opacity;\n"
                     "const view = new HeadView(canvas, readModel(bytes));\n"
                     "view.show({3: 100});\n"
                     "const before = seen();\n"
                     "await view.ready;\n"
                     "window.result = [before, seen(), String(view.camera.zoom)];");
    const Json report = report_of("live", html, dir);
    EXPECT_EQ(said(report), std::vector<std::string>());
    return report.value("result", std::vector<std::string>());
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(opacities(head_with_material()), ElementsAre("0", "1", "1"));
  EXPECT_THAT(opacities(test_head()), ElementsAre("1", "1", "1"));
}

TEST(PageMaterials, LookAsTheRenderersDo) {
  NEEDS_BROWSER();
  const TempDir dir;
  const TestHead& h = head_with_material();
  const std::string html = make({{moving_clip(), 0, "clip"}}, {}, {}, h);
  const Json report = report_of("picture", html, dir);
  ASSERT_TRUE(report.contains("width"));
  EXPECT_EQ(said(report), std::vector<std::string>());
  const int width = report["width"], height = report["height"];
  const head::Pose pose = head::pose(h.rig, {});
  constexpr std::uint32_t kNone = 0x00FF00;
  const render::Image image = render::render(
      render::scene_of(h.head, h.rig, pose), render::look_at(h.head, 20),
      {.width = width, .height = height, .background_top = kNone, .background_bottom = kNone});
  const Bytes page = read_bytes(dir.file("picture.rgb"));
  ASSERT_EQ(page.size(), std::size_t(width) * std::size_t(height) * 3);
  double sum = 0;
  std::size_t count = 0, far = 0;
  for (std::size_t i = 0; i < page.size() / 3; ++i) {
    const std::uint8_t* p = &image.rgba[i * 4];
    if (p[0] == 0 && p[1] == 255 && p[2] == 0) continue;
    ++count;
    int most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const int apart = std::abs(int(p[k]) - int(page[i * 3 + k]));
      sum += apart;
      most = std::max(most, apart);
    }
    far += most > 32 ? 1 : 0;
  }
  ASSERT_GT(count, std::size_t(width * height / 10));
  RecordProperty("mean", std::to_string(sum / double(count) / 3));
  RecordProperty("far", std::to_string(double(far) / double(count)));
  EXPECT_LT(sum / double(count) / 3, 4);
  EXPECT_LT(double(far) / double(count), 0.05);  // at contours, of which hair has many
}

TEST(PageMaterials, APictureIsInThePageOnce) {
  const TestHead& h = head_with_material();
  const std::vector<std::uint8_t> plain = viewer::pack_head(test_head().head, test_head().rig);
  const std::vector<std::uint8_t> packed = viewer::pack_head(h.head, h.rig);
  const Bytes& file = h.head.materials[0].base.picture->file();
  std::size_t found = 0;
  for (auto at = packed.begin();;) {
    at = std::search(at, packed.end(), file.begin(), file.end());
    if (at == packed.end()) break;
    ++found;
    ++at;
  }
  EXPECT_EQ(found, 1u);
  EXPECT_EQ(std::search(plain.begin(), plain.end(), file.begin(), file.end()), plain.end());
}

}  // namespace page_materials_test
}  // namespace animeme::test
