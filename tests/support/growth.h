// How the time of work grows with its size, without a bound in seconds.
#pragma once

#include <ctime>

#include <algorithm>
#include <cstddef>

#include "tests/support/sanitized.h"

namespace animeme::test {

// Four times as much takes four times as long where each part is looked at once, sixteen times
// where each part looks at all others: a ratio above the middle of both says which.
constexpr double kMoreThanLinear = 8;

// CPU time of this thread in seconds: other programs do not count.
inline double cpu_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Time of work(4 * size) by the time of work(size). Below `quick` seconds it is 1: so short a time
// says nothing of growth. The least of several times counts, and a ratio that looks like too much
// is measured again, since what other programs take of the caches is not ours. Under the address
// sanitizer, which has costs of its own, the work is done once for its findings.
template <typename Work>
double growth(Work&& work, std::size_t size, double quick = 0.1) {
  const auto least = [&](std::size_t of, int times) {
    double seconds = 1e9;
    for (int i = 0; i < times; ++i) {
      const double begun = cpu_seconds();
      work(of);
      seconds = std::min(seconds, cpu_seconds() - begun);
    }
    return seconds;
  };
  if (kAddressSanitizer) {
    work(size);
    return 1;
  }
  double longer = least(4 * size, 1);
  if (longer < quick) return 1;
  double shorter = least(size, 2);
  for (int again = 0; again < 4 && longer > kMoreThanLinear * shorter; ++again) {
    longer = std::min(longer, least(4 * size, 1));
    shorter = std::min(shorter, least(size, 2));
  }
  return longer / shorter;
}

}  // namespace animeme::test
