// Two lists of numbered frames, both ascending, walked side by side. Internal.
#pragma once

namespace animeme::fap {

/// Calls `both(a, b)` for frames of one number, `one(frame)` for those that only one list has.
template <class Frames, class One, class Both>
void walk_side_by_side(const Frames& a, const Frames& b, const One& one, const Both& both) {
  auto left = a.begin();
  auto right = b.begin();
  while (left != a.end() || right != b.end()) {
    if (right == b.end() || (left != a.end() && left->number < right->number)) {
      one(*left++);
    } else if (left == a.end() || right->number < left->number) {
      one(*right++);
    } else {
      both(*left++, *right++);
    }
  }
}

}  // namespace animeme::fap
