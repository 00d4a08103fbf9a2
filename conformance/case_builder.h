/// @file
/// Builds one generated case plane by plane. The expected values come from StreamWriter, that is
/// from the levels and the formula of codec/bitstream.md, section 5, and never from a decoder.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "conformance/case_file.h"
#include "conformance/random.h"
#include "conformance/stream_writer.h"

namespace animeme::conformance {

/// A case with the content of its files, by role.
struct MadeCase {
  Case info;                                   ///< what case.json will say
  std::map<std::string, std::string> content;  ///< bytes by role, see CaseFile
};

/// How levels are chosen within their ranges.
enum class Levels : std::uint8_t {
  random,       ///< all over the range, at most `spread` from 0
  zero,         ///< nearest to 0
  highest,      ///< the highest symbol: zero bits
  mostly_high,  ///< the highest symbol nine times of ten
  lowest,
};

/// One case in the making: planes go in, files and expected values come out.
class CaseBuilder {
 public:
  /// `note`: what to watch out for, may be empty.
  CaseBuilder(std::uint64_t seed, std::string name, std::string title, std::string note = {},
              std::uint32_t object_code = fba::kObjectStart);

  Random& random() { return random_; }                ///< of this case's own seed
  StreamWriter& writer() { return writer_; }          ///< for what add() cannot say
  int planes() const { return int(planes_.size()); }  ///< added so far
  /// Widest step of Levels::random.
  int spread = 40;

  /// Draws the levels and writes the plane; draws again where it would look like the end of the
  /// object.
  void add(const PlaneSpec& plane, Levels levels = Levels::random);
  /// Writes a plane whose levels are set. For FAP 1 and 2 see set_viseme(), set_expression().
  void add_exact(const PlaneSpec& plane);
  /// An intra plane with a face and `predictive` planes behind it.
  void add_group(const fba::FaceSettings& face, int predictive, Levels levels = Levels::random);
  /// Levels that lead to these values (blend and intensities in steps of fap_quant).
  void set_viseme(PlaneSpec& plane, int select1, int select2, int blend, bool def) const;
  /// Likewise; selections 0..6, intensities as levels.
  void set_expression(PlaneSpec& plane, int select1, int intensity1, int select2, int intensity2,
                      bool init_face, bool def) const;

  /// Bytes in front of the object start code.
  std::vector<std::uint8_t> headers;
  /// A correct case. `parameters`: an EPF and its sources are added where they can say it all.
  MadeCase finish(bool parameters = true);
  /// The same with other bytes at the end than stuffing and the end code.
  MadeCase finish_with(std::vector<std::uint8_t> bytes);

  /// A damaged case: `features` by hand, since nothing can be computed from such a stream. The
  /// planes of `intact` (indices) are those that can be had; with `ignored`, a decoder that does
  /// not check gets all planes right.
  MadeCase finish_damaged(std::vector<std::uint8_t> bytes, std::vector<int> intact,
                          std::vector<std::string> errors, std::vector<std::string> features,
                          bool ignored = false);
  /// The indices first..last-1 (empty if first >= last).
  static std::vector<int> indices(int first, int last);
  /// What a decoder must have, plane by plane.
  const std::vector<Expected>& expected() const { return expected_; }

 private:
  void set_high(PlaneSpec& plane, int which, std::initializer_list<int> targets) const;
  void draw_levels(PlaneSpec& plane, Levels levels);
  MadeCase start(std::vector<std::uint8_t> bytes) const;
  void add_text(MadeCase& made, const char* face_role, const char* body_role,
                const std::vector<int>& which) const;
  void add_parameters(MadeCase& made) const;

  Case info_;
  Random random_;
  StreamWriter writer_;
  std::vector<PlaneSpec> planes_;
  std::vector<Expected> expected_;
  std::vector<fap::Frame> source_face_;
  std::vector<fba::BodyFrame> source_body_;
};

/// Settings of an intra plane. All of them send the four range sets; m is the range in 60 levels.
fba::FaceSettings all_faps(int fap_quant, int m = 4);
/// Likewise, for single FAPs by number.
fba::FaceSettings some_faps(std::initializer_list<int> faps, int fap_quant, int m = 4);
/// Likewise, for groups of BAPs, from 1.
fba::BodySettings some_body_groups(std::initializer_list<int> groups, int bap_quant, int m = 4);
/// Gives a group (from 1) a mask type; bits of types 1 and 2 are drawn, not all of them the same.
void set_type(fba::FaceSettings& face, int group, int type, Random& random);
/// Likewise, for a body.
void set_type(fba::BodySettings& body, int group, int type, Random& random);

PlaneSpec intra_face(const fba::FaceSettings& face);  ///< an intra plane with a face alone
PlaneSpec intra_body(const fba::BodySettings& body);  ///< an intra plane with a body alone
/// An intra plane with both.
PlaneSpec intra_both(const fba::FaceSettings& face, const fba::BodySettings& body);
/// A predictive plane without levels.
PlaneSpec predictive(fba::ObjectMask object = fba::ObjectMask::face);

/// Every generated case, in the order of names. The same seed gives the same bytes anywhere.
std::vector<MadeCase> make_all_cases(std::uint64_t seed);

/// The parts of it.
void make_face_cases(std::uint64_t seed, std::vector<MadeCase>& out);
/// Likewise: FAP 1 and 2.
void make_high_level_cases(std::uint64_t seed, std::vector<MadeCase>& out);
/// Likewise: what an arithmetic decoder can trip over.
void make_coder_cases(std::uint64_t seed, std::vector<MadeCase>& out);
/// Likewise: headers, start codes, rates, time codes.
void make_stream_cases(std::uint64_t seed, std::vector<MadeCase>& out);
void make_body_cases(std::uint64_t seed, std::vector<MadeCase>& out);  ///< likewise: BAPs
/// Likewise: streams with errors.
void make_damaged_cases(std::uint64_t seed, std::vector<MadeCase>& out);

}  // namespace animeme::conformance
