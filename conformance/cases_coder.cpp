// Generated cases: corner cases of the arithmetic coder.
#include <algorithm>
#include <functional>

#include "conformance/case_builder.h"

namespace animeme::conformance {
namespace {

// True if a plane can be taken for the end of the object: no encoder may write that.
bool seems_to_end(CaseBuilder& b) {
  for (const Expected& plane : b.expected()) {
    if (looks_like_the_end(b.writer().bits().bit, plane.bit_begin)) return true;
  }
  return false;
}

using Fill = std::function<void(CaseBuilder&)>;
using Wanted = std::function<bool(CaseBuilder&)>;

// Tries one sequence of random numbers after the other until the stream has what is wanted.
void search(std::uint64_t seed, const std::string& name, const char* title, const char* note,
            const Fill& fill, const Wanted& wanted, std::vector<MadeCase>& out) {
  for (std::uint64_t turn = 0; turn < 4096; ++turn) {
    CaseBuilder probe(seed + (turn << 32), name, title, note);
    fill(probe);
    if (seems_to_end(probe) || !wanted(probe)) continue;
    CaseBuilder b(seed + (turn << 32), name, title, note);
    fill(b);
    MadeCase made = b.finish();
    made.info.origin = "conformance/make_cases --seed " + std::to_string(seed) + ", turn " +
                       std::to_string(turn) + " of a search";
    out.push_back(std::move(made));
    return;
  }
}

// A viseme segment, and then long zero runs of the low-level segment: highest symbols are 0 bits.
void viseme_before_zeros(CaseBuilder& b) {
  b.spread = 1860;
  const fba::FaceSettings face = some_faps({1, 3, 4, 5, 6, 7, 8, 9, 10}, 1, 31);
  b.add(intra_face(face), Levels::mostly_high);
  for (int k = 0; k < 3; ++k) b.add(predictive(), Levels::mostly_high);
}

void face_before_body_zeros(CaseBuilder& b) {
  b.spread = 1860;
  b.add(intra_both(some_faps({3, 4, 5, 6}, 1, 31), some_body_groups({1, 2}, 1, 31)),
        Levels::mostly_high);
  for (int k = 0; k < 3; ++k) {
    b.add(predictive(fba::ObjectMask::face_and_body), Levels::mostly_high);
  }
}

void stuffing_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  {
    CaseBuilder b(seed, "stuffing_highest", "every symbol the highest: 0 bits with stuffed 1s",
                  "from 1 FAP to all 68, in I and P");
    for (const auto& faps :
         {some_faps({3, 4}, 1, 31), some_faps({3, 4, 5, 6, 7, 8}, 1, 31), all_faps(1, 31)}) {
      b.add_group(faps, 2, Levels::highest);
    }
    out.push_back(b.finish());
  }
  for (int k = 0; k < 3; ++k) {
    CaseBuilder b(seed, "stuffing_mostly_high_" + std::to_string(k),
                  "mostly highest symbols: zero runs of any length around 22");
    b.spread = 1860;
    b.add_group(all_faps(1, 31), 6, Levels::mostly_high);
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "stuffing_lowest", "every symbol the lowest: 1 bits, nothing is stuffed");
    b.add_group(all_faps(1, 31), 3, Levels::lowest);
    out.push_back(b.finish());
  }
}

void border_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  const auto emulates = [](CaseBuilder& b) {
    Bits copy = b.writer().bits();
    while (copy.bit.size() % 8 != 0) copy.bit.push_back(1);
    const std::vector<std::uint8_t> bytes = copy.bytes();
    return std::any_of(b.expected().begin(), b.expected().end(), [&](const Expected& plane) {
      return start_code_inside(bytes, plane.bit_begin, plane.bit_end);
    });
  };
  const auto runs_on = [](CaseBuilder& b) {
    return zeros_behind_segment(b.writer().trace(), b.writer().bits().bit);
  };
  const char* emulation = "a start code prefix at a byte border inside a plane";
  const char* parse =
      "zero runs go on over segment borders; planes must be parsed, not searched for";
  search(seed, "start_code_inside_face", emulation, parse, viseme_before_zeros, emulates, out);
  search(seed, "start_code_inside_body", emulation, parse, face_before_body_zeros, emulates, out);
  const char* ahead = "22 zeros within the 14 bits that a decoder looks ahead behind a segment";
  const char* foreign =
      "those bits belong to the next field and are no missing stuffing (fba_bitstream, 4 and 15.1)";
  search(seed, "look_ahead_face", ahead, foreign, viseme_before_zeros, runs_on, out);
  search(seed, "look_ahead_body", ahead, foreign, face_before_body_zeros, runs_on, out);
}

}  // namespace

void make_coder_cases(std::uint64_t seed, std::vector<MadeCase>& out) {
  stuffing_cases(seed, out);
  border_cases(seed, out);
  {
    CaseBuilder b(seed, "halving_largest", "models of 3721 symbols reach 16383 and are halved",
                  "12,700 predictive planes of FAP 3 (3721 symbols), 4 (121) and 1");
    fba::FaceSettings face = some_faps({1, 3, 4}, 1, 31);
    face.range[fba::kPredictiveMax][4] = face.range[fba::kPredictiveMin][4] = 1;
    b.add(intra_face(face));
    for (int k = 0; k < 12700; ++k) {
      PlaneSpec plane = predictive();
      // Small steps back and forth: what is halved has been counted before.
      b.set_viseme(plane, (k / 97) % 15, 0, 63, false);
      plane.fap[3] = (k % 2 == 0 ? 1 : -1) * (k / 2000);
      plane.fap[4] = k % 50 == 0 ? b.random().range(-3, 3) : 0;
      b.add_exact(plane);
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "adaptive_skewed", "one symbol almost always, now and then another");
    b.add(intra_face(some_faps({3, 4, 5, 6}, 1, 1)), Levels::zero);
    for (int k = 0; k < 300; ++k) {
      PlaneSpec plane = predictive();
      for (const std::size_t fap : {3, 4, 5, 6}) {
        plane.fap[fap] = b.random().chance(3) ? b.random().range(-60, 60) : 0;
      }
      b.add_exact(plane);
    }
    out.push_back(b.finish());
  }
  {
    CaseBuilder b(seed, "intra_only", "intra planes alone: models never adapt");
    for (int k = 0; k < 10; ++k) b.add(intra_face(some_faps({1, 2, 3, 5, 8, 13, 21, 34, 55}, 1)));
    out.push_back(b.finish());
  }
}

}  // namespace animeme::conformance
