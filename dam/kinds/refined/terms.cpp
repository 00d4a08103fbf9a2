#include "dam/kinds/refined/terms.h"

#include <algorithm>
#include <cmath>

#include "dam/script/phones.h"

namespace animeme::dam {
namespace {

constexpr std::uint32_t kClasses = 256;  // a key is own * kClasses + class of the neighbour

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
  const double longer = std::clamp(std::log(here.duration / own.duration), -1.0, 1.0);
  const auto alone = [](std::int32_t other) {
    return other < 0 ? TermUse{0, 0} : TermUse{std::uint32_t(other), 1};
  };
  TermUse triphone{0, 0};
  if (here.left >= 0 && here.right >= 0 && phones.size() <= kClasses)
    triphone = {
        (std::uint32_t(here.left) * kClasses + phone) * kClasses + std::uint32_t(here.right), 1};
  return {TermUse{phone, 1},     by_class(here.left),    by_class(here.right),
          by_phone(here.left),   by_phone(here.right),   TermUse{phone, longer},
          by_class(here.left_2), by_class(here.right_2), TermUse{own_class, 1},
          alone(here.left),      alone(here.right),      triphone};
}

std::uint32_t largest_key(RefinedTerm term, std::size_t phones) {
  switch (term) {
    case RefinedTerm::phone:
    case RefinedTerm::duration:
    case RefinedTerm::left:
    case RefinedTerm::right:
      return std::uint32_t(phones) - 1;
    case RefinedTerm::triphone:
      return kClasses * kClasses * kClasses - 1;
    case RefinedTerm::phone_class:
      return kClasses - 1;
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
      return key;
    case RefinedTerm::phone_left:
    case RefinedTerm::phone_right:
      return key / kClasses;
    default:
      return std::nullopt;
  }
}

std::uint32_t key_with_phone(RefinedTerm term, std::uint32_t key, std::uint32_t phone) {
  const bool beside = term == RefinedTerm::phone_left || term == RefinedTerm::phone_right;
  return !beside ? phone : phone * kClasses + key % kClasses;
}

}  // namespace animeme::dam
