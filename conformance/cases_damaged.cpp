// Generated cases: streams that break a rule, each with the output that a decoder can still give.
#include "conformance/case_builder.h"

namespace animeme::conformance {
namespace {

using Bytes = std::vector<std::uint8_t>;

fba::FaceSettings face_settings() {
  fba::FaceSettings face = some_faps({1, 3, 4, 5, 6, 7, 8, 16, 17, 48, 49, 50}, 1, 31);
  return face;
}

PlaneSpec with_code(PlaneSpec plane) {
  plane.start_code = StartCode::plane;
  return plane;
}

// Planes 0 to 2, the damaged plane 3, a plane that is lost with it, and planes 5 and 6 behind a
// start code.
void around(CaseBuilder& b, PlaneSpec damaged, Levels levels = Levels::random) {
  const bool both = damaged.object_mask == fba::ObjectMask::face_and_body;
  const auto good = [&] {
    return both ? intra_both(face_settings(), some_body_groups({1, 2}, 1))
                : intra_face(face_settings());
  };
  b.add(with_code(good()));
  for (int k = 0; k < 2; ++k) b.add(predictive(damaged.object_mask));
  b.add(with_code(damaged), levels);
  b.add(predictive(damaged.object_mask));
  b.add(with_code(good()));
  b.add(predictive(damaged.object_mask));
}
const std::vector<int> kAround = {0, 1, 2, 5, 6};

PlaneSpec damaged_plane(Damage damage, int at = 0, bool both = false) {
  PlaneSpec plane =
      both ? intra_both(face_settings(), some_body_groups({1, 2}, 1)) : intra_face(face_settings());
  plane.damage = damage;
  plane.damage_at = at;
  return plane;
}

std::vector<std::string> features(const char* damage, bool recovers) {
  return {std::string("damage.") + damage, recovers ? "recovery.next_intra" : "recovery.nothing"};
}

void in_the_plane(std::uint64_t seed, std::vector<MadeCase>& out) {
  struct One {
    const char* name;
    const char* title;
    PlaneSpec plane;
    const char* error;
    const char* feature;
    bool ignored;  // a decoder that does not look decodes everything
  };
  PlaneSpec time_code = damaged_plane(Damage::marker, 0);
  time_code.temporal.time_code = fba::TimeCode{1, 2, 3};
  const One table[] = {
      {"bad_dct_face", "a face plane with fba_object_coding_type 1 (DCT)",
       damaged_plane(Damage::dct_face), "unsupported", "dct", false},
      {"bad_dct_body", "a body part with fba_object_coding_type 1 (DCT)",
       damaged_plane(Damage::dct_body, 0, true), "unsupported", "dct", false},
      {"bad_marker_in_masks", "a marker bit among the masks is 0", damaged_plane(Damage::marker, 4),
       "syntax", "marker", true},
      {"bad_marker_in_ranges", "a marker bit among the ranges is 0",
       damaged_plane(Damage::marker, 20), "syntax", "marker", true},
      {"bad_marker_in_time_code", "the marker bit of a time code is 0", time_code, "syntax",
       "marker", true},
      {"bad_rate_zero", "a frame rate of 0", damaged_plane(Damage::rate_zero), "syntax",
       "rate_zero", true},
      {"bad_body_type_2", "a body group has mask type 2, which is not allowed",
       damaged_plane(Damage::body_type2, 1, true), "syntax", "body_type2", false},
  };
  for (const One& one : table) {
    CaseBuilder b(seed, one.name, one.title,
                  "the plane and the predictive one behind it are lost; the next intra plane "
                  "stands behind a plane start code");
    around(b, one.plane);
    out.push_back(b.finish_damaged(b.writer().finish(), kAround, {one.error},
                                   features(one.feature, true), one.ignored));
  }
  {
    CaseBuilder b(seed, "bad_stuffed_bit", "the bit after 22 zeros is not the stuffed 1");
    around(b, damaged_plane(Damage::stuffed_bit), Levels::highest);
    out.push_back(b.finish_damaged(b.writer().finish(), kAround, {"syntax"},
                                   features("stuffed_bit", true), true));
  }
  {
    CaseBuilder b(seed, "bad_dct_only", "all planes are DCT coded: nothing can be decoded");
    b.add(damaged_plane(Damage::dct_face));
    b.add(predictive());
    out.push_back(
        b.finish_damaged(b.writer().finish(), {}, {"unsupported"}, features("dct", false)));
  }
  {
    CaseBuilder b(seed, "bad_intra_before_predictive",
                  "a damaged intra plane, then predictive planes behind start codes",
                  "these build on what was lost: only the next intra plane can be decoded");
    b.add(with_code(intra_face(some_faps({3, 4}, 1))));
    b.add(predictive());
    b.add(with_code(damaged_plane(Damage::marker, 3)));
    for (int k = 0; k < 3; ++k) b.add(with_code(predictive()));
    b.add(with_code(intra_face(some_faps({3, 4}, 1))));
    b.add(with_code(predictive()));
    out.push_back(b.finish_damaged(b.writer().finish(), {0, 1, 6, 7}, {"syntax"},
                                   features("marker", true), true));
  }
}

// Bits of planes first..last-1, put into `to`.
void copy_planes(CaseBuilder& b, int first, int last, Bits& to) {
  const std::vector<std::uint8_t>& bit = b.writer().bits().bit;
  const auto begin = bit.begin() + std::ptrdiff_t(b.expected()[std::size_t(first)].bit_begin);
  const auto end = bit.begin() + std::ptrdiff_t(b.expected()[std::size_t(last - 1)].bit_end);
  to.bit.insert(to.bit.end(), begin, end);
}

void begin_object(Bits& bits) { bits.put(fba::kObjectStart, 32); }
void begin_plane(Bits& bits) {
  bits.stuff();
  bits.put(fba::kPlaneStart, 32);
}
Bytes end_object(Bits& bits) {
  bits.stuff();
  bits.put(fba::kSequenceEnd, 32);
  return bits.bytes();
}

void between_planes(std::uint64_t seed, std::vector<MadeCase>& out) {
  // Two intra planes with their predictive ones: 0 1 2 and 3 4 5.
  const auto fill = [](CaseBuilder& b) {
    for (int k = 0; k < 2; ++k) b.add_group(face_settings(), 2);
  };
  {
    CaseBuilder b(seed, "bad_garbage_between", "bytes FF between planes",
                  "read as a plane they are predictive with a body, and there was no body");
    fill(b);
    Bits bits;
    begin_object(bits);
    copy_planes(b, 0, 3, bits);
    bits.stuff();
    bits.put(0xFFFFFFFF, 32);
    bits.put(0xFFFFFFFF, 32);
    begin_plane(bits);
    copy_planes(b, 3, 6, bits);
    out.push_back(b.finish_damaged(end_object(bits), CaseBuilder::indices(0, 6), {"syntax"},
                                   features("garbage", true)));
  }
  {
    CaseBuilder b(seed, "bad_predictive_first", "the stream begins with predictive planes");
    fill(b);
    Bits bits;
    begin_object(bits);
    copy_planes(b, 1, 3, bits);
    begin_plane(bits);
    copy_planes(b, 3, 6, bits);
    out.push_back(b.finish_damaged(end_object(bits), CaseBuilder::indices(3, 6), {"syntax"},
                                   features("predictive_first", true)));
  }
  {
    CaseBuilder b(seed, "bad_body_without_intra", "a predictive plane has a body that never began");
    fill(b);
    Bits bits;
    begin_object(bits);
    copy_planes(b, 0, 3, bits);
    bits.put(0b0100, 4);   // predictive, mask 2, no skip
    bits.put(0x5A5A, 16);  // a segment of something
    begin_plane(bits);
    copy_planes(b, 3, 6, bits);
    out.push_back(b.finish_damaged(end_object(bits), CaseBuilder::indices(0, 6), {"syntax"},
                                   features("predictive_first", true)));
  }
}

void cut_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const auto cut = [&](const char* name, const char* title, auto where) {
    CaseBuilder b(seed, name, title, "all planes before the cut are whole");
    b.spread = 1860;
    for (int k = 0; k < 2; ++k) b.add_group(all_faps(1, 31), 2);
    Bytes bytes = b.writer().finish();
    const Expected& plane = b.expected()[3];
    bytes.resize(where(plane));
    out.push_back(b.finish_damaged(std::move(bytes), CaseBuilder::indices(0, 3), {"truncated"},
                                   features("truncated", false)));
  };
  cut("bad_cut_in_header", "the stream ends in the masks of an intra plane",
      [](const Expected& plane) { return plane.bit_begin / 8 + 5; });
  cut("bad_cut_in_ranges", "the stream ends in the ranges of an intra plane",
      [](const Expected& plane) { return plane.bit_begin / 8 + 60; });
  cut("bad_cut_in_values", "the stream ends in the values of a plane",
      [](const Expected& plane) { return plane.bit_end / 8 - 12; });
  {
    CaseBuilder b(seed, "bad_no_end_code", "the stream ends behind its last plane without end code",
                  "all planes are whole; whether more of them were cut off cannot be known");
    b.add_group(face_settings(), 4);
    b.writer().bits().stuff();
    out.push_back(b.finish_damaged(b.writer().bits().bytes(), CaseBuilder::indices(0, 5),
                                   {"truncated"}, features("no_end_code", false)));
  }
}

void no_stream_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const auto one = [&](const char* name, const char* title, Bytes bytes, const char* error,
                       const char* feature) {
    CaseBuilder b(seed, name, title);
    out.push_back(b.finish_damaged(std::move(bytes), {}, {error}, features(feature, false)));
  };
  one("bad_video_object", "headers of a video object, not of a face",
      {0, 0, 1, 0xB0, 0x01, 0, 0, 1, 0xB5, 0x0B, 0, 0, 1, 0x00, 0, 0, 1, 0x20, 0x88, 0x84},
      "unsupported", "foreign_object");
  one("bad_text_file", "a text file", {'2', '.', '1', ' ', 'n', 'o', ' ', 'f', 'b', 'a', '\n'},
      "syntax", "not_fba");
  one("bad_empty_file", "a file of no bytes", {}, "truncated", "not_fba");
}

}  // namespace

void make_damaged_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  in_the_plane(seed, out);
  between_planes(seed, out);
  cut_cases(seed, out);
  no_stream_cases(seed, out);
}

}  // namespace animeme::conformance
