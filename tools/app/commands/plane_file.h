/// @file
/// A raw FBA stream that is decoded as often as wanted, with a piece of it in memory at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "codec/decode/decoder.h"
#include "fap/result.h"

namespace animeme::tools {

/// A stream in a file, or in memory.
class PlaneFile {
 public:
  /// A stream in memory.
  explicit PlaneFile(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
  /// A stream in a file.
  explicit PlaneFile(std::string path) : path_(std::move(path)) {}

  /// The same stream in memory: several streams one behind the other as one, or without what is
  /// damaged (damage.h). nullopt: there is nothing to repair, or that is impossible, or --strict
  /// was given and it is damaged. `name` is that of the file in warnings.
  std::optional<PlaneFile> repaired(const std::string& name) const;

  /// Is this a file (no pipe, not standard input) with such a stream?
  static bool can_read(const std::string& path);

  using Take = std::function<Result<void>(const fba::Plane&)>;  ///< an error ends the reading
  /// All planes from the first on; the errors and warnings are those of fba::decode(), those of
  /// `take`, and io.
  Result<void> for_each(const Take& take, std::vector<std::string>* warnings = nullptr) const;

 private:
  friend class PlaneReader;
  std::string path_;  // empty: bytes_
  std::vector<std::uint8_t> bytes_;
};

/// Goes through a stream once.
class PlaneReader {
 public:
  explicit PlaneReader(const PlaneFile& file);  ///< which has to outlive the reader
  ~PlaneReader();

  /// The next plane, good until the next call; null behind the last one. Errors as for_each().
  Result<const fba::Plane*> next();
  /// So far, a hundred at most: "bit N: sentence".
  const std::vector<std::string>& warnings() const;
  const fba::StreamInfo& info() const;  ///< of the first object; known with the first plane
  std::size_t bytes() const;            ///< of the stream, when next() has given null

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::tools
