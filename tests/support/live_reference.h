// The reference streams as presentations for live transports.
#pragma once

#include <filesystem>

#include "tests/support/live_loop.h"
#include "tests/support/reference_streams.h"

namespace animeme::test {

/// The first 60 planes; no units if they cannot be split.
inline Presentation reference(const std::filesystem::path& base) {
  const auto units = fba::split_access_units(read_bytes(with(base, ".fba")));
  return units ? presentation(*units, 60) : Presentation{};
}

/// Calls `check(show, number)` for all of them, numbered from 0: without sound, with AAC, with
/// Opus, in turn. Stops at a fatal failure; how many there were.
template <class Check>
int for_each_reference(const Check& check) {
  int count = 0;
  for (const auto& base : reference_streams()) {
    SCOPED_TRACE(base.filename());
    Presentation show = reference(base);
    if (show.units.empty()) continue;
    if (count % 3 == 1) add_sound(show, aac_format(), unsigned(count));
    if (count % 3 == 2) add_sound(show, opus_format(), unsigned(count));
    check(show, count);
    if (testing::Test::HasFatalFailure()) break;
    ++count;
  }
  return count;
}

}  // namespace animeme::test
