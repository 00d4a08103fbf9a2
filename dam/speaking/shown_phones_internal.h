// Which visemes the phones of a script show. Not installed API.
#pragma once

#include <vector>

#include "dam/script/phones.h"
#include "dam/script/script.h"

namespace animeme::dam::internal {

/// A phone of a script.
struct ShownPhone {
  double start = 0, end = 0;       // seconds
  int first = 0, last = 0;         // visemes, 0: silence; of two each is shown half the time
  const PhoneInfo* own = nullptr;  // null: unknown, or an HH, which takes that of the next sound
};

/// All phones of a script, in order.
std::vector<ShownPhone> shown_phones(const Script& script);

}  // namespace animeme::dam::internal
