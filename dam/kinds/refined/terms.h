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
    {RefinedTerm::phone, 5, {1, 20, 40, 60, 80}},
    {RefinedTerm::class_left, 3, {20, 20, 40}},
    {RefinedTerm::class_right, 3, {20, 20, 40}},
    {RefinedTerm::phone_left, 3, {20, 20, 40}},
    {RefinedTerm::phone_right, 3, {20, 20, 40}},
    {RefinedTerm::duration, 3, {20, 20, 40}},
    {RefinedTerm::class_left_2, 2, {20, 20}},
    {RefinedTerm::class_right_2, 2, {20, 20}},
    {RefinedTerm::phone_class, 5, {0.5, 10, 20, 30, 40}},
};
inline constexpr std::size_t kTermCount = std::size(kTermInfo);

/// The neighbourhood of an occurrence: phones as indices of Model::phones, kRestContext: rest.
struct Neighbourhood {
  std::int32_t phone = 0;
  std::int32_t left = kRestContext, right = kRestContext;
  std::int32_t left_2 = kRestContext, right_2 = kRestContext;
  double duration = 0;  ///< seconds
};

/// One term of an occurrence.
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

}  // namespace animeme::dam
