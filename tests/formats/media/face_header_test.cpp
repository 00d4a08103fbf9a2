#include "tools/formats/media/detail/tracks/face_header.h"

#include <gtest/gtest.h>

#include "tools/formats/media/detail/mp4/mp4_fix.h"

namespace animeme::media {
namespace face_header_test {

using Bytes = std::vector<std::uint8_t>;

TEST(VisualHeaders, BothForms) {
  const VisualHeaders full =
      read_visual_headers(Bytes{0, 0, 1, 0xB0, 0x62, 0, 0, 1, 0xB5, 0x89, 0x47});
  EXPECT_EQ(full.kind, VisualKind::face);
  EXPECT_EQ(full.profile, 0x62);
  EXPECT_EQ(full.size, 11u);
  const VisualHeaders body_version =
      read_visual_headers(Bytes{0, 0, 1, 0xB0, 0x63, 0, 0, 1, 0xB5, 0x91, 0x47});
  EXPECT_EQ(body_version.kind, VisualKind::face);
  const VisualHeaders short_form = read_visual_headers(Bytes{0, 0, 1, 0xB5, 0x23});
  EXPECT_EQ(short_form.kind, VisualKind::face);
  EXPECT_EQ(short_form.profile, 0);
  EXPECT_EQ(short_form.size, 5u);
}

TEST(VisualHeaders, UserDataIsSkipped) {
  const VisualHeaders headers = read_visual_headers(
      Bytes{0,    0,    1,    0xB0, 0x61, 0, 0,    1,   0xB2, 'h', 'i', 0,    0,   1,
            0xB5, 0x89, 0x47, 0,    0,    1, 0xB2, 'x', 0,    0,   1,   0xBA, 0x7F});
  EXPECT_EQ(headers.kind, VisualKind::face);
  EXPECT_EQ(headers.size, 22u);
}

TEST(VisualHeaders, VideoAndOtherThings) {
  EXPECT_EQ(read_visual_headers(Bytes{0, 0, 1, 0xB0, 1, 0, 0, 1, 0xB5, 0x89, 0x13}).kind,
            VisualKind::other);
  EXPECT_EQ(read_visual_headers(Bytes{0, 0, 1, 0xB5, 0x09}).kind, VisualKind::other);
  EXPECT_EQ(read_visual_headers(Bytes{0, 0, 1, 0xB5, 0x89}).kind, VisualKind::unknown);
  EXPECT_EQ(read_visual_headers(Bytes{0, 0, 1, 0xB5}).kind, VisualKind::unknown);
  EXPECT_EQ(read_visual_headers(Bytes{0, 0, 1, 0x20, 0x89, 0x47}).kind, VisualKind::unknown);
  EXPECT_EQ(read_visual_headers({}).size, 0u);
}

TEST(LooksLikeFace, ByConfigurationOrCode) {
  EXPECT_TRUE(looks_like_face(Bytes{0, 0, 1, 0xBA, 0x7F}));
  EXPECT_TRUE(looks_like_face(Bytes{0, 0, 1, 0xBB, 0x27}));
  EXPECT_TRUE(looks_like_face(Bytes{0, 0, 1, 0xB5, 0x23, 0, 0, 1, 0xBA}));
  EXPECT_FALSE(looks_like_face(Bytes{0, 0, 1, 0xB5, 0x09, 0, 0, 1, 0xBA}));
  EXPECT_FALSE(looks_like_face(Bytes{0, 0, 1, 0x01, 0, 0, 1, 0x20})) << "MPEG-4 video object";
  EXPECT_FALSE(looks_like_face(Bytes{0, 0, 1, 0xB6, 0x10}));
  EXPECT_FALSE(looks_like_face({}));
}

TEST(IsIntra, AllWaysToBeginAUnit) {
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xBA, 0x7F, 0, 0, 1, 0xBB, 0x80}), true);
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xBB, 0x80}), true);
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xBB, 0x7F}), false);
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xBA, 0x80}), true) << "no plane code";
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0x01, 0x7F, 0, 0, 1, 0x03, 0x80}), true) << "old codes";
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0x03, 0x00}), false);
}

TEST(IsIntra, NoPlaneNoAnswer) {
  EXPECT_EQ(read_is_intra({}), std::nullopt);
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xBB}), std::nullopt);
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xBA, 0x7F}), std::nullopt);
  EXPECT_EQ(read_is_intra(Bytes{0x80, 0, 0, 1, 0xBB, 0x80}), std::nullopt);
  EXPECT_EQ(read_is_intra(Bytes{0, 0, 1, 0xB1}), std::nullopt) << "end code";
}

void append_box(Bytes& out, const char* type, const Bytes& content) {
  const std::size_t size = content.size() + 8;
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(std::uint8_t(size >> shift));
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), content.begin(), content.end());
}

Bytes box(const char* type, const Bytes& content) {
  Bytes out;
  append_box(out, type, content);
  return out;
}

Bytes moov_with(const char* entry, std::size_t fields, const Bytes& descriptor) {
  Bytes esds = {0, 0, 0, 0};
  esds.insert(esds.end(), descriptor.begin(), descriptor.end());
  Bytes inner(fields);
  append_box(inner, "btrt", Bytes(12));
  append_box(inner, "esds", esds);
  Bytes stsd(8);
  append_box(stsd, entry, inner);
  return box("moov", box("trak", box("mdia", box("minf", box("stbl", box("stsd", stsd))))));
}

TEST(EsIds, AnyLengthOfLength) {
  for (const Bytes& descriptor :
       {Bytes{3, 3, 0xAB, 0xCD, 0}, Bytes{3, 0x80, 3, 0xAB, 0xCD, 0},
        Bytes{3, 0x80, 0x80, 3, 0xAB, 0xCD, 0}, Bytes{3, 0x80, 0x80, 0x80, 3, 0xAB, 0xCD, 0}}) {
    for (const bool video : {true, false}) {
      const Bytes moov = moov_with(video ? "mp4v" : "mp4a", video ? 78 : 28, descriptor);
      const std::vector<std::size_t> found = find_es_ids(moov);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_EQ(moov[found[0]], 0xAB);
      EXPECT_EQ(moov[found[0] + 1], 0xCD);
    }
  }
}

TEST(EsIds, BrokenBoxesArePassedOver) {
  const Bytes moov = moov_with("mp4v", 78, {3, 3, 0xAB, 0xCD, 0});
  for (std::size_t size = 0; size < moov.size(); ++size) {
    EXPECT_TRUE(find_es_ids(std::span(moov).first(size)).empty());
  }
  EXPECT_TRUE(find_es_ids(moov_with("mp4v", 78, {4, 3, 0xAB, 0xCD, 0})).empty());
  EXPECT_TRUE(find_es_ids(moov_with("mp4v", 78, {3, 3, 0xAB})).empty());
  for (std::size_t at = 0; at < moov.size(); ++at) {
    Bytes flipped = moov;
    flipped[at] ^= 0xFF;
    for (const std::size_t offset : find_es_ids(flipped)) EXPECT_LE(offset + 2, flipped.size());
  }
}

}  // namespace face_header_test
}  // namespace animeme::media
