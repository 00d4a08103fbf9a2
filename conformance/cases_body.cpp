// Generated cases: the body, alone and with a face.
#include "conformance/case_builder.h"
#include "conformance/features.h"

namespace animeme::conformance {
namespace {

void group_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  for (int first = 1; first <= fba::kBodyGroupCount; first += 4) {
    CaseBuilder b(seed, "body_groups_" + two_digits(first),
                  "body groups " + std::to_string(first) + " to " + std::to_string(first + 3) +
                      " with mask types 0, 1 and 3",
                  "values run by group and by position in the group, not by BAP number");
    for (int turn = 0; turn < 3; ++turn) {
      fba::BodySettings body = some_body_groups({}, 1);
      for (int k = 0; k < 4; ++k) {
        const int types[] = {3, 1, 0};
        set_type(body, first + k, types[(turn + k) % 3], b.random());
      }
      b.add(intra_body(body));
      b.add(predictive(fba::ObjectMask::body));
    }
    out.push_back(b.finish());
  }
  CaseBuilder all(seed, "body_all_groups", "all 296 body parameters");
  fba::BodySettings body = some_body_groups({}, 1);
  for (int group = 1; group <= fba::kBodyGroupCount; ++group)
    set_type(body, group, 3, all.random());
  all.add(intra_body(body));
  for (int k = 0; k < 3; ++k) all.add(predictive(fba::ObjectMask::body));
  out.push_back(all.finish());
}

void coding_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  {
    CaseBuilder b(seed, "body_quant_all", "all 32 body quantiser indices, 0 is no quantisation",
                  "the index stands for 0, 1, 2, 3, 5, 7 ... 127");
    b.spread = 5;
    for (int quant = 0; quant < 32; ++quant) {
      b.add(intra_body(some_body_groups({1, 9}, quant, 31)));
      b.add(predictive(fba::ObjectMask::body));
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "body_range_flags", "each of the 16 sets of range flags after a full one",
                  "body ranges have no defaults in the known codec; they are always sent first");
    fba::BodySettings body = some_body_groups({1, 2, 3}, 3);
    b.add(intra_body(body));
    for (int flags = 0; flags < 16; ++flags) {
      for (std::size_t bit = 0; bit < 4; ++bit)
        body.send_range[bit] = ((flags >> (3 - bit)) & 1) != 0;
      for (auto& set : body.range) set.fill(std::uint8_t(2 + flags % 5));
      b.add(intra_body(body));
      b.add(predictive(fba::ObjectMask::body));
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "body_range_kept", "the body quantiser changes and ranges are not resent",
                  "the ranges keep their number of levels; what the standard wants is unknown");
    fba::BodySettings body = some_body_groups({1, 2}, 4, 9);
    b.add(intra_body(body));
    b.add(predictive(fba::ObjectMask::body));
    body.send_range.fill(false);
    body.bap_quant = 2;
    b.add(intra_body(body));
    b.add(predictive(fba::ObjectMask::body));
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "body_stuffing", "body values at their highest symbols: stuffed zero runs");
    b.spread = 1860;
    b.add(intra_body(some_body_groups({1, 2, 3, 4, 5}, 1, 31)), Levels::highest);
    for (int k = 0; k < 4; ++k) b.add(predictive(fba::ObjectMask::body), Levels::mostly_high);
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "body_time", "temporal header of a body without a face",
                  "rate, time code and skipped frames");
    for (int k = 0; k < 12; ++k) {
      PlaneSpec plane = k % 4 == 0 ? intra_body(some_body_groups({17, 18, 19}, 1))
                                   : predictive(fba::ObjectMask::body);
      if (plane.intra) plane.temporal.rate = fba::CodedRate{14, 15, true};
      if (plane.intra) plane.temporal.time_code = fba::TimeCode{0, 1, std::uint8_t(k)};
      if (k % 2 == 1) plane.temporal.skip = std::uint32_t(k * k);
      b.add(plane);
    }
    out.push_back(b.finish());
  }
}

void both_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  {
    CaseBuilder b(seed, "both_in_each_plane", "face and body in each plane, masks change for both");
    for (int k = 0; k < 3; ++k) {
      fba::FaceSettings face = some_faps({1, 3, 4, 5}, 1 + k);
      set_type(face, 8, k + 1, b.random());
      fba::BodySettings body = some_body_groups({1, 2}, 1 + k);
      set_type(body, 3 + k, 1, b.random());
      b.add(intra_both(face, body));
      for (int p = 0; p < 3; ++p) b.add(predictive(fba::ObjectMask::face_and_body));
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "both_in_turn", "planes with a face, a body, both and nothing in turn",
                  "each part continues from its own last plane");
    b.add(intra_both(some_faps({3, 4, 5, 6, 48}, 1), some_body_groups({1, 19}, 1)));
    for (int k = 0; k < 24; ++k) b.add(predictive(fba::ObjectMask(b.random().range(0, 3))));
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(
        seed, "both_intra_apart", "intra planes of the face and of the body apart",
        "an intra plane of one part leaves settings, models and values of the other alone");
    b.add(intra_face(some_faps({3, 4, 5}, 1)));
    b.add(predictive());
    b.add(intra_body(some_body_groups({2, 3}, 1)));
    for (int k = 0; k < 3; ++k) b.add(predictive(fba::ObjectMask::face_and_body));
    b.add(intra_face(some_faps({3, 4, 5, 6, 7}, 3)));
    for (int k = 0; k < 3; ++k) b.add(predictive(fba::ObjectMask::face_and_body));
    b.add(intra_body(some_body_groups({4}, 6)));
    for (int k = 0; k < 3; ++k) b.add(predictive(fba::ObjectMask::face_and_body));
    out.push_back(b.finish());
  }
}

}  // namespace

void make_body_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  group_cases(seed, out);
  coding_cases(seed, out);
  both_cases(seed, out);
}

}  // namespace animeme::conformance
