// What the animeme of an occurrence is a sum of: its phone's own curve and small corrections, each
// learned for a kind of neighbourhood. Source: dam/lipsync.md, section 2, and dam/README.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "dam/model/model.h"

namespace animeme::dam {

/// Terms of one kind have `orders` Legendre coefficients; `ridge` holds each (in frames).
struct TermInfo {
  RefinedTerm term;
  std::uint32_t orders;
  std::array<double, kRefinedOrders> ridge;
};

inline constexpr TermInfo kTermInfo[] = {
    {RefinedTerm::phone, 5, {15, 600, 1200, 1800, 2400}},
    {RefinedTerm::class_left, 3, {50, 50, 100}},
    {RefinedTerm::class_right, 3, {50, 50, 100}},
    {RefinedTerm::phone_left, 3, {50, 50, 100}},
    {RefinedTerm::phone_right, 3, {50, 50, 100}},
    {RefinedTerm::duration, 3, {8, 8, 16}},
    {RefinedTerm::class_left_2, 2, {50, 50}},
    {RefinedTerm::class_right_2, 2, {50, 50}},
    {RefinedTerm::phone_class, 5, {0.05, 3, 7, 10, 13}},
    {RefinedTerm::left, 3, {8, 8, 16}},
    {RefinedTerm::right, 3, {8, 8, 16}},
    {RefinedTerm::triphone, 3, {5, 5, 10}},
};
inline constexpr std::size_t kTermCount = std::size(kTermInfo);

/// The neighbourhood of an occurrence: phones as indices of Model::phones, kRestContext: rest.
struct Neighbourhood {
  std::int32_t phone = 0;
  std::int32_t left = kRestContext, right = kRestContext;
  std::int32_t left_2 = kRestContext, right_2 = kRestContext;
  double duration = 0;  ///< seconds
};

/// One term of an occurrence; a scale of 0: it has none of this kind.
struct TermUse {
  std::uint32_t key = 0;
  double scale = 1;
};

/// The terms of an occurrence, one of each kind, in the order of kTermInfo.
std::array<TermUse, kTermCount> terms_of(std::span<const PhoneModel> phones,
                                         const Neighbourhood& here);

/// Largest key a model of so many phones can have, for checks.
std::uint32_t largest_key(RefinedTerm term, std::size_t phones);

/// The phone that a key names; none for keys of classes.
std::optional<std::uint32_t> phone_of_key(RefinedTerm term, std::uint32_t key);
/// The same key, which must name a phone, for a phone that has another number.
std::uint32_t key_with_phone(RefinedTerm term, std::uint32_t key, std::uint32_t phone);

/// Of the triphones of a corpus, those that say something of their own: the most frequent of those
/// with a few examples. Each costs unknowns, and rich text has more of them than memory.
inline constexpr std::size_t kMostTriphones = 512, kLeastTriphones = 3;

}  // namespace animeme::dam
