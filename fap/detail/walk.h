// Two rows of numbered frames, both ascending, walked side by side. Internal.
#pragma once

#include <cstddef>

namespace animeme::fap {

/// Calls `both(a, b)` for frames of one number, `only_a(frame)` and `only_b(frame)` for those that
/// one row alone has. `next_a()` and `next_b()` give a pointer to the next frame, which is good
/// until the next call; null: there is none.
template <class NextA, class NextB, class OnlyA, class OnlyB, class Both>
void walk_side_by_side(NextA&& next_a, NextB&& next_b, const OnlyA& only_a, const OnlyB& only_b,
                       const Both& both) {
  const auto* a = next_a();
  const auto* b = next_b();
  while (a != nullptr || b != nullptr) {
    if (b == nullptr || (a != nullptr && a->number < b->number)) {
      only_a(*a);
      a = next_a();
    } else if (a == nullptr || b->number < a->number) {
      only_b(*b);
      b = next_b();
    } else {
      both(*a, *b);
      a = next_a();
      b = next_b();
    }
  }
}

/// The frames of a list, for walk_side_by_side().
template <class Frames>
auto each_of(const Frames& frames) {
  return [&frames, at = std::size_t(0)]() mutable {
    return at < frames.size() ? &frames[at++] : nullptr;
  };
}

}  // namespace animeme::fap
