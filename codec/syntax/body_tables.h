/// @file
/// Tables of the body part of an FBA stream. Source: codec/bitstream.md, section 7.
#pragma once

#include <array>
#include <cstdint>

namespace animeme::fba {

inline constexpr int kBapCount = 296;       ///< 186 of the standard and 110 extension BAPs
inline constexpr int kBodyGroupCount = 24;  ///< 19 of the standard and 5 extension groups

/// Number of BAPs in each group, in coding order.
extern const std::array<std::uint8_t, kBodyGroupCount> kBodyGroupSizes;
/// BAP numbers (1..296) in coding order.
extern const std::array<std::uint16_t, kBapCount> kBapOrder;
/// Quantiser steps in coding order: 1e-5 rad, millimetres for BAP 181..183. These are the steps of
/// the public codec, which the reference streams use; the document's table differs (64, 128, 256,
/// 512). They scale decoded values only, never the parsing.
extern const std::array<std::uint16_t, kBapCount> kBapSteps;
/// Factor of the step and divisor of the ranges, by the 5-bit index of the plane; entry 0 (no
/// quantisation) counts as 1.
extern const std::array<std::uint8_t, 32> kBapScale;

}  // namespace animeme::fba
