/// @file
/// Cuts and joins streams plane by plane, without a change of any value.
///
///     animeme::fba::Splicer splicer;
///     for (const Plane& plane : first->planes) {             // frames 75 to 124 of a stream
///       const auto more = splicer.copy_frames(plane, 75, 125);
///       if (!more) return more.error();
///     }
///     splicer.begin_source();                                // and all of another one behind it
///     for (const Plane& plane : second->planes) splicer.copy(plane);
///     return splicer.finish();
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "codec/decode/decoder.h"
#include "codec/encode/encoder.h"
#include "fap/result.h"

namespace animeme::fba {

/// How many planes a Splicer wrote.
struct SpliceReport {
  std::size_t planes = 0;  ///< all
  /// Those whose bits are not the bits of their source: mostly from a cut to the next intra plane
  /// that sends all four sets of ranges.
  std::size_t recoded = 0;
  /// Planes with a value that differs from that of the source: one beyond +-1860 quantiser steps,
  /// which predictive planes reach and the intra plane of a cut does not, or one that an earlier
  /// intra plane coded with another quantiser and that is held since.
  std::size_t changed = 0;
};

/// Writes planes of decoded streams one after the other. A plane that follows the plane before it
/// in the same stream keeps its bits. At a cut the first plane becomes an intra plane that holds
/// everything that was coded so far, and the planes up to the next intra plane are coded again,
/// with the same quantiser, masks and ranges, so that their values stay. So are planes without face
/// and body unless each plane has a start code: decoders would take them for stuffing in front of
/// one.
///
/// Movable, not copyable, not thread safe. Memory does not grow with the stream, if take() is
/// called. Source: codec/bitstream.md, sections 2 to 5.
class Splicer {
 public:
  /// A stream without planes. Containers and packets need a start code before each plane.
  explicit Splicer(const StreamOptions& options = {});
  Splicer(Splicer&&) noexcept;  ///< movable
  Splicer& operator=(Splicer&&) noexcept;
  ~Splicer();

  /// The next plane belongs to another stream. It has to be an intra plane, as the first one of
  /// every stream is.
  void begin_source();

  /// The next plane of the source is left out, but later planes build on it.
  void pass(const Plane& plane);

  /// The next plane of the source is written, followed by `skip` frames in which it is held;
  /// without a number by those that the plane itself skips. Its time code is left out behind a cut.
  /// Errors: invalid_argument (a predictive plane without an intra plane of its kind before it),
  /// those of Encoder::write().
  Result<void> copy(const Plane& plane);
  Result<void> copy(const Plane& plane, std::uint32_t skip);  ///< likewise

  /// The same for the last plane that was given to pass() or copy(), once more: it is shown from a
  /// cut on that lies within the frames that it skips.
  Result<void> copy_last(std::uint32_t skip);

  /// The next plane is coded as an intra plane with everything that receivers show, for those that
  /// have received nothing before it, too. The planes behind it are coded again, as behind a cut.
  void refresh();

  /// From now on an intra plane of the source that changes nothing but ranges is coded as a
  /// predictive one where the ranges in force suffice, for receivers that lose nothing.
  void avoid_intra();

  /// A splicer that has seen the same planes of the source and has written none.
  Splicer fork() const;

  /// Calls these for the next plane of a source of which the frames from `first` up to `end`, by
  /// Plane::number, are wanted: a plane that is shown within them is written, as long as it is.
  /// The first of them is held for `hold` more frames. False: no later plane is wanted.
  Result<bool> copy_frames(const Plane& plane, std::int64_t first, std::int64_t end,
                           std::int64_t hold = 0);

  /// Whole bytes since the last call; with a start code before each plane they end with the plane.
  std::vector<std::uint8_t> take();
  /// The rest, and the end code.
  std::vector<std::uint8_t> finish();

  /// So far.
  const SpliceReport& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Streams one behind the other, as `cat a.fba b.fba` makes them: as one stream.
struct JoinedStreams {
  std::vector<std::uint8_t> stream;  ///< raw
  std::size_t count = 0;             ///< of the streams, at least 2
};

/// Joins the streams of a file, of which each ends with its end code. Decoders end at the first of
/// these codes. nullopt: there is one stream only, or one of them is damaged.
std::optional<JoinedStreams> join_streams(std::span<const std::uint8_t> bytes);

}  // namespace animeme::fba
