// What is left of the limits of a file while it is read, so that a few bytes that claim much, or
// are named again and again, cost little.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/view/gltf/read_head.h"

namespace animeme::gltf {

/// Each function takes from what is left. Errors: out_of_range, with the limit; then nothing is
/// taken.
class Budget {
 public:
  explicit Budget(const ReadLimits& limits);

  /// Of files beside the .gltf.
  Result<void> take_bytes(std::size_t count);
  /// Of a primitive. Small ones count as much as one of 100 vertices, for what they cost beside.
  Result<void> take_vertices(std::size_t count);
  Result<void> take_triangles(std::size_t count);
  /// Moves of one vertex by one shape; at least 100 for each shape.
  Result<void> take_moves(std::size_t count);
  Result<void> take_texels(std::size_t count);
  /// Elements of accessors that are read, however often.
  Result<void> take_elements(std::size_t count);

 private:
  ReadLimits limits_;
  ReadLimits left_;
  std::size_t triangles_ = 0;
  std::size_t elements_ = 0;
};

/// A number as people say it: 1500000 as "1.5 million".
std::string million_text(std::size_t count);

/// Error if the text of a file has more values than memory should be given to: out_of_range.
Result<void> check_values(std::string_view json);

}  // namespace animeme::gltf
