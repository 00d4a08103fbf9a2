/// @file
/// One FBA object plane as data: its headers, masks, ranges and decoded values.
/// Source: codec/bitstream.md, sections 2, 3 and 7.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "codec/syntax/body_tables.h"
#include "fap/frame.h"
#include "fap/tables.h"

namespace animeme::fba {

// Start codes (codec/bitstream.md, section 1).
inline constexpr std::uint32_t kSequenceStart = 0x000001B0;   ///< followed by the profile byte
inline constexpr std::uint32_t kSequenceEnd = 0x000001B1;     ///< ends a raw stream
inline constexpr std::uint32_t kUserData = 0x000001B2;        ///< to be skipped
inline constexpr std::uint32_t kVisualObject = 0x000001B5;    ///< visual object header
inline constexpr std::uint32_t kObjectStart = 0x000001BA;     ///< fba_object_start_code
inline constexpr std::uint32_t kPlaneStart = 0x000001BB;      ///< before any plane, optional
inline constexpr std::uint32_t kOldObjectStart = 0x00000101;  ///< of drafts, still accepted
inline constexpr std::uint32_t kOldPlaneStart = 0x00000103;   ///< of drafts, still accepted

/// Whether a start code begins a plane, of the standard or of its drafts.
constexpr bool is_plane_start(std::uint32_t code) {
  return code == kPlaneStart || code == kOldPlaneStart;
}
/// Whether a start code begins an object, of the standard or of its drafts.
constexpr bool is_object_start(std::uint32_t code) {
  return code == kObjectStart || code == kOldObjectStart;
}

/// fba_object_mask: content of a plane.
enum class ObjectMask : std::uint8_t { nothing = 0, face = 1, body = 2, face_and_body = 3 };

/// Face or face_and_body.
inline bool has_face(ObjectMask mask) { return (std::uint8_t(mask) & 1) != 0; }
/// Body or face_and_body.
inline bool has_body(ObjectMask mask) { return (std::uint8_t(mask) & 2) != 0; }

/// Mask type of a group (codec/bitstream.md, section 3.1): the value of parameters that are not
/// coded.
enum class MaskType : std::uint8_t {
  none = 0,         ///< nothing of the group is coded, all keep their value
  hold = 1,         ///< coded by mask, the others keep their value
  interpolate = 2,  ///< coded by mask, the others are interpolated by the decoder
  all = 3,          ///< all are coded
};

/// The four kinds of level ranges, in the order of the stream.
enum RangeKind : std::uint8_t { kIntraMax, kIntraMin, kPredictiveMax, kPredictiveMin };

/// frame_rate, seconds, frequency_offset: (frame_rate + seconds/16), times 1000/1001 if offset.
struct CodedRate {
  std::uint8_t frame_rate = 25;   ///< 0..255
  std::uint8_t sixteenths = 0;    ///< 0..15, the field "seconds"
  bool frequency_offset = false;  ///< times 1000/1001

  /// Exact rate; not valid() if both parts are 0.
  fap::Rate rate() const {
    return fap::make_rate((16U * frame_rate + sixteenths) * (frequency_offset ? 1000U : 1U),
                          16U * (frequency_offset ? 1001U : 1U));
  }
  friend bool operator==(const CodedRate&, const CodedRate&) = default;
};

/// The rate in its coded form, nullopt if the stream cannot express it exactly. Expressible are
/// k/16 frames per second up to 255 15/16, and those times 1000/1001.
std::optional<CodedRate> code_rate(fap::Rate rate);

/// Time code of an intra plane.
struct TimeCode {
  std::uint8_t hours = 0;    ///< 0..31, valid 0..23
  std::uint8_t minutes = 0;  ///< 0..63, valid 0..59
  std::uint8_t seconds = 0;  ///< 0..63, valid 0..59
  friend bool operator==(const TimeCode&, const TimeCode&) = default;
};

/// Temporal header. The skip count applies after the plane that carries it (codec/bitstream.md,
/// section 10).
struct TemporalHeader {
  std::optional<CodedRate> rate;      ///< intra planes only
  std::optional<TimeCode> time_code;  ///< intra planes only
  std::optional<std::uint32_t> skip;  ///< frames skipped after this plane; 0 may be coded too
  friend bool operator==(const TemporalHeader&, const TemporalHeader&) = default;
};

/// The settings of the face from an intra plane to the next one.
struct FaceSettings {
  int fap_quant = 1;  ///< 0..31; 0: no quantisation, 1: the standard's steps
  std::array<MaskType, fap::kGroupCount> mask_type{};  ///< index = group number - 1
  fap::Mask mask;                    ///< coded FAPs; must agree with the mask types
  bool male = false;                 ///< fba_suggested_gender
  std::array<bool, 4> send_range{};  ///< by RangeKind: is_i_new_max .. is_p_new_min
  /// By RangeKind and FAP: the 5-bit number m, range = m*60/fap_quant levels (0..31, 31: 1860).
  /// Used for coded low-level FAPs of the sets that are sent.
  std::array<std::array<std::uint8_t, fap::kFapCount + 1>, 4> range{};
};

/// The same for the body. BAPs are indexed by number (1..296).
struct BodySettings {
  int bap_quant = 1;                                  ///< 0..31, index into kBapScale
  std::array<MaskType, kBodyGroupCount> mask_type{};  ///< interpolate is not allowed
  std::bitset<kBapCount + 1> mask;                    ///< by BAP number; bit 0 is not used
  bool male = false;                                  ///< fba_suggested_gender
  std::array<bool, 4> send_range{};                   ///< as FaceSettings::send_range
  /// As FaceSettings::range, by BAP number.
  std::array<std::array<std::uint8_t, kBapCount + 1>, 4> range{};
};

/// Decoded body parameters: 1e-5 rad, millimetres for BAP 181..183.
struct BodyFrame {
  std::int64_t number = 0;  ///< running number at the stream's rate; gaps are skipped frames
  std::bitset<kBapCount + 1> mask;                  ///< which BAPs were coded, by number
  std::array<std::int32_t, kBapCount + 1> value{};  ///< by BAP number; 0 where not coded
  friend bool operator==(const BodyFrame&, const BodyFrame&) = default;
};

/// Divisor of ranges and factor of steps for a fap_quant (0 counts as 1).
inline int fap_scale(int fap_quant) { return fap_quant == 0 ? 1 : fap_quant; }
/// The same for a body quantiser index.
inline int bap_scale(int bap_quant) {
  return kBapScale[std::size_t(bap_quant)] == 0 ? 1 : kBapScale[std::size_t(bap_quant)];
}

/// Largest level of viseme_blend and the intensities at a fap_quant (codec/bitstream.md, section
/// 6).
inline int blend_range(int fap_quant) {
  return fap_quant == 0 ? 63 : (63 + fap_quant / 2) / fap_quant;
}

}  // namespace animeme::fba
