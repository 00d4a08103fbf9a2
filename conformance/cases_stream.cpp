// Generated cases: start codes, headers, time, ends.
#include "conformance/case_builder.h"

namespace animeme::conformance {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes start_code(std::uint8_t last) { return {0, 0, 1, last}; }

void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

fba::FaceSettings lips() { return some_faps({3, 4, 5, 6, 7, 16, 17}, 1); }

void start_code_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  struct Way {
    const char* name;
    const char* title;
    StartCode (*code)(int plane, bool intra);
  };
  const Way ways[] = {
      {"plane_codes_none", "no plane start codes", [](int, bool) { return StartCode::none; }},
      {"plane_codes_intra", "plane start codes before intra planes",
       [](int, bool intra) { return intra ? StartCode::plane : StartCode::none; }},
      {"plane_codes_all", "plane start codes before all planes",
       [](int, bool) { return StartCode::plane; }},
      {"plane_codes_old", "old plane start codes before all planes",
       [](int, bool) { return StartCode::old_plane; }},
      {"plane_codes_mixed", "new, old and no plane start codes in turn",
       [](int plane, bool) { return StartCode(plane % 3); }},
  };
  for (const Way& way : ways) {
    CaseBuilder b(seed, way.name, way.title);
    for (int k = 0; k < 24; ++k) {
      PlaneSpec plane = k % 8 == 0 ? intra_face(lips()) : predictive();
      plane.start_code = way.code(k, plane.intra);
      b.add(plane);
    }
    out.push_back(b.finish());
  }
  CaseBuilder old(seed, "object_code_old", "object start code 00000101 of the 1999 edition", "",
                  fba::kOldObjectStart);
  old.add_group(lips(), 4);
  out.push_back(old.finish(false));
}

void header_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const Bytes sequence = {0, 0, 1, 0xB0, 0x61};
  // Type 4: 0 0100, then 011 as stuffing. With verid and priority: 1 0001 001, 0100 and 0111.
  const Bytes object_short = {0, 0, 1, 0xB5, 0x23};
  const Bytes object_verid = {0, 0, 1, 0xB5, 0x89, 0x47};
  Bytes user = start_code(0xB2);
  append(user, {'m', 'a', 'd', 'e', 0, 0, 2, 'x'});
  const auto one = [&](const char* name, const char* title, std::vector<Bytes> parts) {
    CaseBuilder b(seed, name, title, "the headers of a system stream, fba_bitstream, 1");
    for (const Bytes& part : parts) append(b.headers, part);
    b.add_group(lips(), 4);
    out.push_back(b.finish(false));
  };
  one("header_sequence", "visual object sequence and visual object in front",
      {sequence, object_short});
  one("header_verid", "a visual object header with verid and priority", {sequence, object_verid});
  one("header_user_data", "user data behind both headers", {sequence, user, object_short, user});
  one("header_object_only", "a visual object header without a sequence", {object_short});
}

void time_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  struct RateCase {
    const char* name;
    fba::CodedRate rate;
  };
  for (const RateCase& one :
       {RateCase{"rate_12_5", {12, 8, false}}, RateCase{"rate_0_1_16", {0, 1, false}},
        RateCase{"rate_29_97", {30, 0, true}}, RateCase{"rate_59_94", {60, 0, true}},
        RateCase{"rate_7_3_16_offset", {7, 3, true}},
        RateCase{"rate_255_15_16", {255, 15, false}}}) {
    CaseBuilder b(seed, one.name,
                  "frame rate " + std::to_string(one.rate.frame_rate) + " and " +
                      std::to_string(one.rate.sixteenths) + "/16" +
                      (one.rate.frequency_offset ? ", times 1000/1001" : ""));
    for (int k = 0; k < 4; ++k) {
      PlaneSpec plane = k == 0 ? intra_face(lips()) : predictive();
      if (k == 0) plane.temporal.rate = one.rate;
      b.add(plane);
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "rate_never_sent", "no frame rate is sent: 30 holds");
    for (int k = 0; k < 2; ++k) {
      PlaneSpec plane = intra_face(lips());
      plane.temporal.rate.reset();
      b.add(plane);
      b.add(predictive());
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "rate_changes", "another frame rate at each intra plane",
                  "the expected text has the first one");
    for (const int rate : {25, 50, 10}) {
      PlaneSpec plane = intra_face(lips());
      plane.temporal.rate = fba::CodedRate{std::uint8_t(rate), 0, false};
      b.add(plane);
      b.add(predictive());
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "time_codes", "time codes in intra planes, 0:00:00 to 31:63:63",
                  "frame numbers do not follow time codes");
    for (const fba::TimeCode code :
         {fba::TimeCode{0, 0, 0}, fba::TimeCode{0, 0, 1}, fba::TimeCode{1, 2, 3},
          fba::TimeCode{23, 59, 59}, fba::TimeCode{31, 63, 63}}) {
      PlaneSpec plane = intra_face(lips());
      plane.temporal.time_code = code;
      b.add(plane);
      b.add(predictive());
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "skip_every_kind", "skipped frames: 0 to 31, 44, 45, 46, 300 and none",
                  "15 is written as 15 and 0; the skip counts after the plane that carries it");
    for (int k = 0; k < 36; ++k) {
      PlaneSpec plane = k % 5 == 0 ? intra_face(lips()) : predictive();
      const int skips[] = {44, 45, 46, 300};
      plane.temporal.skip = std::uint32_t(k < 32 ? k : skips[k - 32]);
      b.add(plane);
    }
    for (int k = 0; k < 2; ++k) b.add(predictive());
    out.push_back(b.finish());
  }
}

void object_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  CaseBuilder b(seed, "plane_without_anything", "planes with object mask 0 between others",
                "such a plane has no temporal header and no values but counts as a frame");
  for (int k = 0; k < 13; ++k) {  // at the end it could be taken for stuffing
    PlaneSpec plane = k % 6 == 0 ? intra_face(lips()) : predictive();
    if (k % 3 == 2) plane = predictive(fba::ObjectMask::nothing);
    if (k == 8) plane.intra = true;
    b.add(plane);
  }
  out.push_back(b.finish());

  CaseBuilder empty(seed, "mask_nothing_coded", "faces without a single FAP: empty segments 01");
  for (int k = 0; k < 2; ++k) {
    fba::FaceSettings face = some_faps({}, 1 + k);
    if (k == 1) face.mask_type.fill(fba::MaskType::hold);  // masks that are all 0
    empty.add_group(face, 3);
  }
  out.push_back(empty.finish());
}

// Two objects with headers, one behind the other: the loop of the standard's visual object
// sequence. The second one says all of its own.
void joined_object_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const Bytes both_headers = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x23};
  CaseBuilder b(seed, "object_again", "two objects with headers, one behind the other",
                "frames are counted on; ranges and values of the first object end with it");
  b.headers = both_headers;
  b.add_group(lips(), 11);
  PlaneSpec second = intra_face(some_faps({3, 19, 20, 31, 32, 48, 49, 50}, 4));
  second.object_start = both_headers;
  append(second.object_start, start_code(fba::kObjectStart & 0xFF));
  b.add(second);
  for (int k = 0; k < 12; ++k) b.add(predictive());
  out.push_back(b.finish(false));
}

// Cases whose last plane ends where it has to for the test.
void end_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const auto until = [&](const char* name, const char* title, const char* note, std::size_t rest,
                         auto finish) {
    CaseBuilder b(seed, name, title, note);
    b.add_group(lips(), 2);
    while (b.writer().bits().bit.size() % 8 != rest) b.add(predictive());
    out.push_back(finish(b));
  };
  const auto plain = [](CaseBuilder& b) { return b.finish(); };
  until("end_aligned", "the last plane ends at a byte border: a whole byte of stuffing, 7F", "", 0,
        plain);
  until("end_one_bit_left", "one bit is left for the stuffing: a single 0", "", 7, plain);
  until("end_seven_bits_left", "seven bits are left for the stuffing", "", 1, plain);
  until("end_without_stuffing", "at a byte border the end code follows at once",
        "written by no known encoder; a tolerant decoder sees the end code", 0, [](CaseBuilder& b) {
          b.writer().bits().put(fba::kSequenceEnd, 32);
          return b.finish_with(b.writer().bits().bytes());
        });
  until("end_bytes_behind", "bytes behind the end code", "they are to be ignored", 3,
        [](CaseBuilder& b) {
          std::vector<std::uint8_t> bytes = b.writer().finish();
          append(bytes, {0x00, 0xFF, 0xA5, 0x00, 0x00, 0x01});
          return b.finish_with(std::move(bytes));
        });
  {
    CaseBuilder b(seed, "end_code_missing", "access units one after the other, without an end code",
                  "each plane behind a start code and stuffed to the byte border");
    for (int k = 0; k < 6; ++k) {
      PlaneSpec plane = k == 0 ? intra_face(lips()) : predictive();
      plane.start_code = StartCode::plane;
      b.add(plane);
    }
    b.writer().bits().stuff();
    out.push_back(b.finish_with(b.writer().bits().bytes()));
  }
}

// Planes of 6 bits, which would fit into the byte in front of a start code.
void short_plane_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const auto begin = [&](const char* name, const char* title, const char* note) {
    CaseBuilder b(seed, name, title, note);
    b.add_group(some_faps({}, 1), 1);
    while (b.writer().bits().bit.size() % 8 > 1) b.add(predictive());
    return b;
  };
  const auto shorts = [](CaseBuilder& b) {
    b.writer().bits().put(0b0'01'0'01, 6);
    b.writer().bits().stuff();
  };
  {
    CaseBuilder b =
        begin("short_plane_skips_none", "a short plane at the end that skips 0 frames",
              "4 bits more take it across the byte border; without them it is stuffing");
    PlaneSpec plane = predictive();
    plane.temporal.skip = 0;
    b.add(plane);
    out.push_back(b.finish());
  }
  {
    CaseBuilder b = begin("short_plane_before_end", "a short plane whole in front of the end code",
                          "taken for stuffing, whatever its bits say: it is lost");
    shorts(b);
    b.writer().bits().put(fba::kSequenceEnd, 32);
    out.push_back(b.finish_with(b.writer().bits().bytes()));
  }
  {
    CaseBuilder b =
        begin("short_plane_before_intra", "a short plane whole in front of a plane start code",
              "taken for stuffing, whatever its bits say: it is lost");
    shorts(b);
    b.writer().bits().put(fba::kPlaneStart, 32);
    b.add_group(lips(), 3);
    out.push_back(b.finish(false));  // no encoder is to write this
  }
}

}  // namespace

void make_stream_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  start_code_cases(seed, out);
  header_cases(seed, out);
  time_cases(seed, out);
  object_cases(seed, out);
  joined_object_cases(seed, out);
  end_cases(seed, out);
  short_plane_cases(seed, out);
}

}  // namespace animeme::conformance
