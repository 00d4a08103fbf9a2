/// @file
/// FBA streams written a second time, straight from the description: levels in, bits and the
/// values that a decoder must give out. It can also write what is not allowed.
/// Source: codec/bitstream.md, sections 1 to 7.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/syntax/plane.h"
#include "conformance/segment_writer.h"
#include "fap/frame.h"

namespace animeme::conformance {

/// The seven values of FAP 1 and 2 in coding order.
enum High : std::uint8_t {
  kSelect1,
  kSelect2,
  kBlend,
  kExpression1,
  kIntensity1,
  kExpression2,
  kIntensity2,
  kHighCount
};

/// True for a viseme or expression that is chosen: these are not quantised.
bool is_selection(int which);

/// The start code in front of a plane, if any.
enum class StartCode : std::uint8_t { none, plane, old_plane };

/// What is wrong with a plane.
enum class Damage : std::uint8_t {
  none,
  dct_face,     ///< fba_object_coding_type 1
  dct_body,     ///< the same for the body
  marker,       ///< marker number `damage_at` of the plane is 0
  rate_zero,    ///< a frame rate of 0 is sent
  body_type2,   ///< body group `damage_at` (from 0) has mask type 2
  stuffed_bit,  ///< the first stuffed bit is 0
};

/// A plane as it is coded: levels, not values.
struct PlaneSpec {
  bool intra = false;                                   ///< is_intra
  fba::ObjectMask object_mask = fba::ObjectMask::face;  ///< fba_object_mask
  StartCode start_code = StartCode::none;               ///< start code before the plane
  /// Start codes of another object before the plane, with its headers: the object before ends.
  std::vector<std::uint8_t> object_start;
  fba::TemporalHeader temporal;  ///< rate, time code, skipped frames
  fba::FaceSettings face;        ///< intra planes with a face
  fba::BodySettings body;        ///< intra planes with a body
  /// Levels: the value in steps in an intra plane, else the difference in steps. Selections have
  /// step 1.
  std::array<std::int32_t, kHighCount> high{};
  std::array<std::int32_t, fap::kFapCount + 1> fap{};  ///< levels by FAP number
  std::array<std::int32_t, fba::kBapCount + 1> bap{};  ///< levels by BAP number
  bool viseme_def = false,                             ///< one bit each, sent with FAP 1
      init_face = false,                               ///< sent with FAP 2
      expression_def = false;                          ///< sent with FAP 2
  Damage damage = Damage::none;                        ///< none: the plane is right
  int damage_at = 0;  ///< which of several places, where there are several
};

/// What a decoder has after a plane: coded values only.
struct Expected {
  bool intra = false;                                      ///< is_intra
  fba::ObjectMask object_mask = fba::ObjectMask::nothing;  ///< fba_object_mask
  fap::Frame face;                                         ///< coded FAPs
  fba::BodyFrame body;                                     ///< coded BAPs
  std::size_t bit_begin = 0,                               ///< first bit of the header
      bit_end = 0;                                         ///< behind the last bit
};

/// True if 23 zeros stand where the next start code would be if the object ended before this plane:
/// a decoder then takes it for the end (codec/bitstream.md, section 1), and an encoder must not
/// write it. Planes behind a plane start code cannot be mistaken. `bit` holds the stream.
bool looks_like_the_end(const std::vector<std::uint8_t>& bit, std::size_t plane_begin);

/// True if 22 zeros stand within the 14 bits that a decoder looks ahead behind a segment: those
/// bits belong to the next field.
bool zeros_behind_segment(const CoderTrace& trace, const std::vector<std::uint8_t>& bit);
/// True if a start code prefix stands at a byte border between two bits of a stream.
bool start_code_inside(std::span<const std::uint8_t> bytes, std::size_t begin, std::size_t end);

/// Writes planes behind an object start code.
class StreamWriter {
 public:
  /// Writes the object start code.
  explicit StreamWriter(std::uint32_t object_code = fba::kObjectStart);

  /// Levels have to lie in the ranges in force (codec/bitstream.md, section 3.2); see levels().
  Expected write(const PlaneSpec& plane);
  /// Range of the level of a FAP or BAP in force for a plane: as after write() of `plane`'s
  /// settings. First lowest, second highest.
  struct Range {
    int low,   ///< lowest level
        high;  ///< highest level
  };
  Range fap_range(const PlaneSpec& plane, std::size_t fap) const;  ///< FAP 3..68
  Range bap_range(const PlaneSpec& plane, std::size_t bap) const;  ///< BAP 1..296
  /// Largest level of a high-level value in an intra plane.
  int high_range(const PlaneSpec& plane, int which) const;
  /// Last values.
  std::int32_t high_value(int which) const { return high_.value[std::size_t(which)]; }
  std::int32_t fap_value(std::size_t fap) const { return face_.value[fap]; }  ///< FAP 3..68
  /// Those of the last intra plane.
  const fba::FaceSettings& face_settings() const { return face_settings_; }
  /// Those of the last intra plane.
  const fba::BodySettings& body_settings() const { return body_settings_; }

  Bits& bits() { return bits_; }                      ///< what was written so far
  const CoderTrace& trace() const { return trace_; }  ///< traps on the way
  /// Stuffing and the end code are put behind the planes.
  std::vector<std::uint8_t> finish();

 private:
  // Ranges, models and values of the FAPs or BAPs, by number.
  struct Family {
    std::array<std::vector<int>, 4> range;  // levels, all >= 0
    std::vector<Frequencies> model;         // P planes
    std::vector<std::int32_t> value;
    bool known = false;
  };
  struct HighFamily {
    std::array<Frequencies, kHighCount> model;
    std::array<std::int32_t, kHighCount> value{};
  };

  void marker(const PlaneSpec& plane);
  void temporal(const PlaneSpec& plane);
  void write_face(const PlaneSpec& plane, Expected& expected);
  void write_body(const PlaneSpec& plane, Expected& expected);
  void face_header(const PlaneSpec& plane);
  void body_header(const PlaneSpec& plane);
  template <class Settings>
  void write_ranges(const PlaneSpec& plane, const Settings& settings);
  template <class Settings>
  void install(Family& family, const Settings& settings);
  void write_high(const PlaneSpec& plane, int first, int last);
  template <class Settings, class Levels>
  void write_values(const PlaneSpec& plane, Family& family, const Settings& settings,
                    const Levels& levels);

  Bits bits_;
  CoderTrace trace_;
  bool bad_stuffing_ = false;
  int markers_ = 0;
  std::int64_t number_ = 0;
  fba::FaceSettings face_settings_;
  fba::BodySettings body_settings_;
  Family face_, body_;
  HighFamily high_;
};

}  // namespace animeme::conformance
