/// @file
/// split_access_units() unit by unit, for streams that are long.
///
///     Result<UnitReader> units = UnitReader::open(stream);
///     if (!units) return units.error();
///     for (;;) {
///       Result<const AccessUnit*> unit = units->next();
///       if (!unit) return unit.error();
///       if (*unit == nullptr) break;
///       use(**unit);
///     }
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "codec/decode/access_unit.h"
#include "fap/result.h"

namespace animeme::fba {

/// What is known of all units before the first one is given.
struct UnitSummary {
  std::vector<std::uint8_t> config;  ///< as AccessUnits::config
  std::uint32_t timescale = 1;       ///< as AccessUnits::timescale
  std::size_t units = 0;             ///< number of units
  std::size_t bytes = 0;             ///< of all units
  std::size_t largest = 0;           ///< bytes of the largest unit
  std::int64_t peak_bits = 0;        ///< most bits in any second that begins with a unit
  std::int64_t first_duration = 0;   ///< of the first unit, ticks
  std::int64_t end = 0;              ///< of the last unit, ticks
};

/// Gives bytes of a stream from an offset on: fills the span and returns how many were written; 0:
/// the stream ends there. Its errors are passed on.
using ReadStreamAt =
    std::function<Result<std::size_t>(std::uint64_t offset, std::span<std::uint8_t>)>;

/// Units that are kept somewhere else with their times.
struct UnitSource {
  std::function<Result<bool>(AccessUnit&)> next;  ///< fills it; false: there are no more
  std::function<Result<void>()> rewind;           ///< next() gives the first unit again
};

/// Gives the units of a raw stream, or of a source, again and again.
class UnitReader {
 public:
  /// Reads the stream for the first time, with some 100 kB of it in memory. Errors: those of
  /// split_access_units() and of `read`.
  static Result<UnitReader> open(ReadStreamAt read);
  /// The same from memory, which is borrowed.
  static Result<UnitReader> open(std::span<const std::uint8_t> stream);
  /// Reads a source for the first time. Its units have positive durations and ascending times from
  /// 0 on. Errors: those of `source`; truncated (there is no unit).
  static Result<UnitReader> open(std::vector<std::uint8_t> config, std::uint32_t timescale,
                                 UnitSource source);
  UnitReader(UnitReader&&) noexcept;  ///< movable
  UnitReader& operator=(UnitReader&&) noexcept;
  ~UnitReader();

  const UnitSummary& summary() const;  ///< of all units
  /// The next unit, valid until the next call; null: there are no more.
  Result<const AccessUnit*> next();
  /// next() gives the first unit again.
  void rewind();

 private:
  friend Result<AccessUnits> split_access_units(std::span<const std::uint8_t> stream);
  struct Impl;
  explicit UnitReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace animeme::fba
