// Numbers of a file: accessors of any component type, normalised or not, sparse or not.
#pragma once

#include <cstdint>
#include <vector>

#include "fap/head/vector.h"
#include "tools/view/gltf/detail/file.h"

namespace animeme::gltf {

/// Element count of an accessor. Error: syntax.
Result<std::size_t> count_of(const File& file, std::size_t accessor);

/// The numbers of the first `most` elements, `components` for each (1..4, 16). Integers that are
/// not normalised stay what they are. Errors: syntax (no such accessor, another type, beyond its
/// buffer, not finite), out_of_range (see Budget::take_elements()).
Result<std::vector<float>> read_floats(const File& file, std::size_t accessor,
                                       std::size_t components, std::size_t most);

/// The same as whole numbers from 0 on: indices (1) and joints (4). Floats are no whole numbers.
Result<std::vector<std::uint32_t>> read_wholes(const File& file, std::size_t accessor,
                                               std::size_t components, std::size_t most);

/// Vectors that are not 0, with their numbers, which ascend.
struct Moves {
  std::vector<std::uint32_t> vertices;
  std::vector<head::Vec3> deltas;
};

/// What a morph target moves; taken from the budget. A sparse accessor is read as fast as it is
/// short.
Result<Moves> read_moves(const File& file, std::size_t accessor, std::size_t vertices);

}  // namespace animeme::gltf
