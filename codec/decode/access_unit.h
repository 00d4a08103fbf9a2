/// @file
/// Access units: an FBA stream split into planes that each start byte aligned behind a plane start
/// code, as in containers and packets. Source: tools/formats/media/containers.md, section 1.3.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fap/result.h"

namespace animeme::fba {

/// One plane with its start code, ready to be a container sample or a packet.
struct AccessUnit {
  std::vector<std::uint8_t> bytes;  ///< start code, plane, stuffing to the byte boundary
  bool intra = false;               ///< a receiver can start here
  std::int64_t time = 0;            ///< presentation (= decoding) time, in units of 1/timescale s
  std::int64_t duration = 0;        ///< > 0, same units

  friend bool operator==(const AccessUnit&, const AccessUnit&) = default;
};

/// A whole stream in the form that is written to and read from every container.
struct AccessUnits {
  /// Decoder configuration: visual object sequence and visual object header, usually 11 bytes.
  std::vector<std::uint8_t> config;
  std::uint32_t timescale = 25000;  ///< ticks per second, exact for the stream's plane rate
  std::vector<AccessUnit> units;    ///< one per plane, in order

  friend bool operator==(const AccessUnits&, const AccessUnits&) = default;
};

/// Re-packs a raw stream (as in a .fba file, with or without plane start codes and headers) into
/// access units: parses plane by plane, never scans for start codes. The first unit begins with
/// the object start code. Errors: those of the Decoder; a stream without a single plane is
/// Code::truncated.
Result<AccessUnits> split_access_units(std::span<const std::uint8_t> stream);

/// Joins the units to a raw stream and appends the end code 000001B1. The stream begins with the
/// object start code, as old decoders require; `with_headers` writes `config` in front instead.
std::vector<std::uint8_t> join_access_units(const AccessUnits& units, bool with_headers = false);

/// The end code, 000001B1, behind the joined units.
std::span<const std::uint8_t> end_code();

}  // namespace animeme::fba
