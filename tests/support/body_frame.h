// Body frames for tests, by BAP numbers and values.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <utility>

#include "codec/syntax/plane.h"

namespace animeme::test {

inline fba::BodyFrame body_frame(std::int64_t number,
                                 std::initializer_list<std::pair<int, int>> values) {
  fba::BodyFrame frame;
  frame.number = number;
  for (const auto& [bap, value] : values) {
    frame.mask.set(std::size_t(bap));
    frame.value[std::size_t(bap)] = value;
  }
  return frame;
}

}  // namespace animeme::test
