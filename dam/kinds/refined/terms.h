// What the animeme of an occurrence is a sum of: its phone's own curve and small corrections, each
// learned for a kind of neighbourhood. Source: dam/lipsync.md, section 2, and dam/README.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "dam/model/model.h"
#include "dam/script/phones.h"

namespace animeme::dam {

/// Terms of one kind have `orders` Legendre coefficients; `ridge` holds each (in frames).
struct TermInfo {
  RefinedTerm term;
  std::uint32_t orders;
  std::array<double, kRefinedOrders> ridge;
};

inline constexpr TermInfo kTermInfo[] = {
    {RefinedTerm::phone, 5, {26, 670, 1300, 2800, 3700}},
    {RefinedTerm::class_left, 3, {110, 62, 190}},
    {RefinedTerm::class_right, 3, {92, 61, 64}},
    {RefinedTerm::phone_left, 3, {13, 25, 25}},
    {RefinedTerm::phone_right, 3, {81, 70, 45}},
    {RefinedTerm::duration, 3, {35, 45, 67}},
    {RefinedTerm::class_left_2, 2, {26, 150}},
    {RefinedTerm::class_right_2, 2, {5.3, 58}},
    {RefinedTerm::phone_class, 5, {0.05, 3.2, 9.9, 15, 14}},
    {RefinedTerm::left, 3, {11, 24, 13}},
    {RefinedTerm::right, 3, {17, 6.2, 59}},
    {RefinedTerm::triphone, 3, {31, 6.3, 30}},
    {RefinedTerm::kind_left, 3, {100, 25, 140}},
    {RefinedTerm::kind_right, 3, {16, 32, 53}},
    {RefinedTerm::between, 3, {170, 87, 230}},
    {RefinedTerm::class_duration, 3, {5.5, 79, 26}},
    {RefinedTerm::left_duration, 2, {12, 36}},
    {RefinedTerm::next_duration, 2, {9.8, 93}},
    {RefinedTerm::since, 1, {0.67}},
    {RefinedTerm::onset, 1, {1.5}},
};
inline constexpr std::size_t kTermCount = std::size(kTermInfo);

/// The neighbourhood of an occurrence: phones as indices of Model::phones, kRestContext: rest.
struct Neighbourhood {
  std::int32_t phone = 0;
  std::int32_t left = kRestContext, right = kRestContext;
  std::int32_t left_2 = kRestContext, right_2 = kRestContext;
  double duration = 0;       ///< seconds
  double next_duration = 0;  ///< seconds of the phone behind; 0: there is none
  double since = -1;         ///< seconds since the speech began; below 0: this is silence
};

/// Walks through the occurrences of a script in their order and computes the time since the start
/// of speech: Neighbourhood::since. It restarts after kSpeechBreak seconds of silence.
class SpeechClock {
 public:
  double since(double start, double end, bool silence);

 private:
  double begun_ = 0, ended_ = -1e9;  // seconds
};
inline constexpr double kSpeechBreak = 0.2;

/// Whether a phone is silence.
inline bool is_silence(std::span<const PhoneModel> phones, std::int32_t phone) {
  return phones[std::size_t(phone)].context_class == std::uint32_t(PhoneClass::silence);
}

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

/// Limits of the triphones with their own terms: the most frequent of those with a few examples.
/// Each costs unknowns, and a large corpus has more of them than fit into memory.
inline constexpr std::size_t kMostTriphones = 512, kLeastTriphones = 3;

}  // namespace animeme::dam
