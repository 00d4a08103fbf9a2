#include "dam/kinds/refined/terms.h"

#include <algorithm>
#include <cmath>

#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

constexpr std::uint32_t kClasses = 256;  // a key is own * kClasses + class of the neighbour

constexpr double kOnset = 0.3;  // seconds

/// Silence, vowel, or anything else.
std::uint32_t kind_of_class(std::uint32_t phone_class) {
  switch (PhoneClass(phone_class)) {
    case PhoneClass::silence:
      return 0;
    case PhoneClass::open_vowel:
    case PhoneClass::mid_vowel:
    case PhoneClass::close_front:
    case PhoneClass::rounded_vowel:
      return 1;
    default:
      return 2;
  }
}

/// How much longer a phone lasts than usual.
double longer_by(const PhoneModel& phone, double duration) {
  return std::clamp(std::log(duration / phone.duration), -1.0, 1.0);
}

std::uint32_t class_at(std::span<const PhoneModel> phones, std::int32_t phone) {
  if (phone < 0) return std::uint32_t(PhoneClass::silence);
  return std::min(phones[std::size_t(phone)].context_class, kClasses - 1);
}

}  // namespace

std::array<TermUse, kTermCount> terms_of(std::span<const PhoneModel> phones,
                                         const Neighbourhood& here) {
  const auto phone = std::uint32_t(here.phone);
  const PhoneModel& own = phones[phone];
  const std::uint32_t own_class = class_at(phones, here.phone);
  const auto by_class = [&](std::int32_t other) {
    return TermUse{own_class * kClasses + class_at(phones, other), 1};
  };
  const auto by_phone = [&](std::int32_t other) {
    return TermUse{phone * kClasses + class_at(phones, other), 1};
  };
  const std::uint32_t kind = kind_of_class(own_class);
  const auto by_kind = [&](std::int32_t other) {
    return other < 0 || phones.size() > kClasses
               ? TermUse{0, 0}
               : TermUse{kind * kClasses + std::uint32_t(other), 1};
  };
  const double longer = longer_by(own, here.duration);
  const bool followed = here.right >= 0 && here.next_duration > 0;
  const double next_longer =
      followed ? longer_by(phones[std::size_t(here.right)], here.next_duration) : 0;
  const bool spoken = here.since >= 0;
  const auto alone = [](std::int32_t other) {
    return other < 0 ? TermUse{0, 0} : TermUse{std::uint32_t(other), 1};
  };
  TermUse triphone{0, 0};
  if (here.left >= 0 && here.right >= 0 && phones.size() <= kClasses)
    triphone = {
        (std::uint32_t(here.left) * kClasses + phone) * kClasses + std::uint32_t(here.right), 1};
  return {TermUse{phone, 1},
          by_class(here.left),
          by_class(here.right),
          by_phone(here.left),
          by_phone(here.right),
          TermUse{phone, longer},
          by_class(here.left_2),
          by_class(here.right_2),
          TermUse{own_class, 1},
          alone(here.left),
          alone(here.right),
          triphone,
          by_kind(here.left),
          by_kind(here.right),
          TermUse{class_at(phones, here.left) * kClasses + class_at(phones, here.right), 1},
          TermUse{own_class, longer},
          here.left < 0 ? TermUse{0, 0} : TermUse{std::uint32_t(here.left), longer},
          TermUse{phone, next_longer},
          TermUse{0, spoken ? std::min(here.since, kLongestSince) : 0},
          TermUse{0, spoken ? std::exp(-here.since / kOnset) : 0}};
}

double SpeechClock::since(double start, double end, bool silence) {
  if (silence) return -1;
  if (start - ended_ >= kSpeechBreak) begun_ = start;
  ended_ = end;
  return start - begun_;
}

std::uint32_t largest_key(RefinedTerm term, std::size_t phones) {
  switch (term) {
    case RefinedTerm::phone:
    case RefinedTerm::duration:
    case RefinedTerm::left:
    case RefinedTerm::right:
    case RefinedTerm::left_duration:
    case RefinedTerm::next_duration:
      return std::uint32_t(phones) - 1;
    case RefinedTerm::triphone:
      return kClasses * kClasses * kClasses - 1;
    case RefinedTerm::phone_class:
    case RefinedTerm::class_duration:
      return kClasses - 1;
    case RefinedTerm::kind_left:
    case RefinedTerm::kind_right:
      return 2 * kClasses + std::uint32_t(phones) - 1;
    case RefinedTerm::since:
    case RefinedTerm::onset:
      return 0;
    case RefinedTerm::phone_left:
    case RefinedTerm::phone_right:
      return std::uint32_t(phones) * kClasses - 1;
    default:
      return kClasses * kClasses - 1;
  }
}

std::optional<std::uint32_t> phone_of_key(RefinedTerm term, std::uint32_t key) {
  switch (term) {
    case RefinedTerm::phone:
    case RefinedTerm::duration:
    case RefinedTerm::left:
    case RefinedTerm::right:
    case RefinedTerm::left_duration:
    case RefinedTerm::next_duration:
      return key;
    case RefinedTerm::phone_left:
    case RefinedTerm::phone_right:
      return key / kClasses;
    case RefinedTerm::kind_left:
    case RefinedTerm::kind_right:
      return key % kClasses;
    default:
      return std::nullopt;
  }
}

std::uint32_t key_with_phone(RefinedTerm term, std::uint32_t key, std::uint32_t phone) {
  switch (term) {
    case RefinedTerm::phone_left:
    case RefinedTerm::phone_right:
      return phone * kClasses + key % kClasses;
    case RefinedTerm::kind_left:
    case RefinedTerm::kind_right:
      return key / kClasses * kClasses + phone;
    default:
      return phone;
  }
}

}  // namespace animeme::dam
