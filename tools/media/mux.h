// Writing a face and its sound into one file.
//
//     MuxInput input{.face = &units, .audio = &voice};
//     Result<void> written = write_container("talk.mp4", input);
//
// Access units and sound stay the caller's; nothing is changed in them. The sound is encoded as
// AAC-LC, mono. Time 0 of the face is sample 0 of the sound. Files are written whole or not at
// all, and the same input gives the same bytes (with the same FFmpeg on the same machine; other
// versions of its AAC encoder may round differently). Source: containers, sections 2.1, 3.1, 3.2.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "codec/access_unit.h"
#include "fap/result.h"
#include "tools/media/pcm.h"

namespace animeme::media {

/// What goes into the file; at least one of the two.
struct MuxInput {
  const fba::AccessUnits* face = nullptr;  ///< nullptr: sound only
  const Pcm* audio = nullptr;              ///< nullptr: no sound
  /// Visual profile and level for the file's own table of contents (mp4 `iods`): 0x61..0x64.
  /// 0: as in the face's configuration, 0x61 if that has none.
  std::uint8_t visual_profile = 0;
};

struct MuxOptions {
  /// Bits a second of the AAC track, 8000..320000. AAC allows at most 6 bits a sample, so
  /// 64000 becomes 48000 at 8 kHz.
  int audio_bit_rate = 64000;
  /// mp4: contents before data, so that a player can begin while it loads.
  bool faststart = true;
  /// mp4: a complete MPEG-4 Systems presentation with a scene of a face and a sound, an object
  /// stream and the initial object descriptor; for players and tools of MPEG-4 Systems. It is made
  /// in memory, with the contents first, and limited to 4 GB.
  bool systems = false;
  /// Called with 0..1 from time to time, at last with 1; empty: not wanted.
  std::function<void(double)> progress = {};
};

/// MPEG-4 file: brand mp42, `iods` with profile bytes, face as handler `vide`, entry `mp4v`, with
/// `esds` (object type 0x20, ES_ID 0, bufferSizeDB and maximum bit rate from the data) and sync
/// table; exact media time scale (times a whole factor if it is below 10000); AAC priming in the
/// edit list, so sound and face agree to the sample. A sample rate that AAC lacks is resampled to
/// the next higher one it has.
/// Errors: invalid_argument (nothing to write; no units; configuration not of a face; an empty
/// unit; times not ascending or negative; durations not positive; empty sound; bit rate), io
/// (folder missing, disk full ...), unsupported (this FFmpeg lacks the AAC encoder), out_of_range
/// (memory).
Result<void> write_mp4(const std::string& path, const MuxInput& input,
                       const MuxOptions& options = {});

/// The same by extension: .mp4 .m4a (m4a: sound only) .mkv .mka .ts.
/// mkv: times are rounded to 1 ms and everything is moved by the AAC priming (21.3 ms at 48 kHz),
/// face against sound at most 0.5 ms off. ts: configuration in front of each intra plane,
/// stream type 0x10, the same common shift, 90 kHz clock, 188 bytes or more for each plane.
/// Further error: unsupported (another extension; a face in .m4a or .mka; a Systems presentation
/// that is no mp4 or has no face).
Result<void> write_container(const std::string& path, const MuxInput& input,
                             const MuxOptions& options = {});

}  // namespace animeme::media
