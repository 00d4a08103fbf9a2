/// @file
/// The data model: one coded instant (Frame) and a clip of them (Sequence).
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

#include "fap/rate.h"

/// Facial animation parameters: data, tables, text.
namespace animeme::fap {

inline constexpr int kFapCount = 68;       ///< FAPs are numbered 1..68
inline constexpr int kFirstLowLevel = 3;   ///< FAP 1 and 2 are high-level
inline constexpr int kLowLevelCount = 66;  ///< FAP 3..68

/// A set of FAPs. The index is the FAP number, bit 0 is never used.
using Mask = std::bitset<kFapCount + 1>;

/// FAP 1. Shown mouth shape = viseme1 * blend/63 + viseme2 * (1 - blend/63).
/// Source: fap/semantics.md, section 4.
struct Viseme {
  std::int32_t select1 = 0;  ///< 0..14, see kVisemes in tables.h
  std::int32_t select2 = 0;  ///< 0..14
  std::int32_t blend = 0;    ///< 0..63, weight of select1
  bool def = false;          ///< the low-level FAPs of this frame define the viseme

  friend bool operator==(const Viseme&, const Viseme&) = default;
};

/// FAP 2. Shown = expression1 * intensity1/63 + expression2 * intensity2/63.
/// Source: fap/semantics.md, section 5.
struct Expression {
  std::int32_t select1 = 0;     ///< 0..6, see kExpressions in tables.h
  std::int32_t intensity1 = 0;  ///< 0..63
  std::int32_t select2 = 0;     ///< 0..6
  std::int32_t intensity2 = 0;  ///< 0..63
  bool init_face = false;       ///< the neutral face may be re-initialised first
  bool def = false;             ///< the low-level FAPs of this frame define the expression

  friend bool operator==(const Expression&, const Expression&) = default;
};

/// One coded instant. A plain value: 300-odd bytes, no heap.
///
/// `mask` says which FAPs are present. A receiver keeps the last value of an absent FAP (or
/// interpolates it), so an absent FAP is not the same as a FAP of value 0.
struct Frame {
  std::int64_t number = 0;  ///< running number at the sequence's rate; gaps are skipped frames
  Mask mask;                ///< the FAPs that are present
  /// value[n] is FAP n in FAP units: 1/1024 of its FAPU, or 1e-5 rad for angles.
  /// Index 0..2 are not used. Values of absent FAPs are 0 in frames made by Animeme.
  std::array<std::int32_t, kFapCount + 1> value{};
  Viseme viseme;          ///< meaningful if mask[1]
  Expression expression;  ///< meaningful if mask[2]

  /// Sets low-level FAP `fap` (3..68) and marks it as present.
  void set(int fap, std::int32_t v) {
    mask.set(std::size_t(fap));
    value[std::size_t(fap)] = v;
  }

  friend bool operator==(const Frame&, const Frame&) = default;
};

/// A clip. Frame numbers ascend strictly; frame k is shown at frames[k].number / rate seconds.
struct Sequence {
  Rate rate;                  ///< frames per second
  std::vector<Frame> frames;  ///< by ascending number
  std::string name;           ///< free text for people; written as one word

  /// Seconds from the start of frame number 0 to the end of the last frame.
  double duration() const {
    return frames.empty() ? 0.0 : rate.seconds(double(frames.back().number + 1));
  }

  friend bool operator==(const Sequence&, const Sequence&) = default;
};

}  // namespace animeme::fap
