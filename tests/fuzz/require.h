/// @file
/// What a fuzz target demands of the code that it runs.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace animeme::test {

/// Ends the target, with the place of the call and `what`, where `condition` does not hold.
inline void require(bool condition, const char* what = "it does not hold",
                    const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (condition) return;
  std::fprintf(stderr, "%s:%d: required: %s\n", file, line, what);
  std::abort();
}

}  // namespace animeme::test
