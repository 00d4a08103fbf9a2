// Where the fragments of a finished mp4 lie and how long they last, so that readers need not go
// through them to know. Source: ISO/IEC 14496-12, sections 8.8 (fragments), 8.16.3 (sidx).
#pragma once

#include <cstdint>
#include <vector>

#include "tools/formats/media/detail/mp4/boxes.h"

namespace animeme::media {

class FragmentIndex {
 public:
  /// `moov`: the whole box.
  explicit FragmentIndex(Bytes moov);

  /// The next fragment: its whole `moof` box, and the bytes from there to the next one.
  void add(Bytes moof, std::uint64_t size);

  bool empty() const { return sizes_.empty(); }
  /// Length of the longest track as it is presented, in the time scale of the movie: what mehd
  /// says.
  std::uint64_t duration() const;
  /// An index (sidx) of each track, to be put in front of the first fragment. Empty: there are more
  /// fragments than the 65535 that one holds, or one of 2 GB.
  std::vector<std::uint8_t> boxes() const;

 private:
  struct Part {  // of a track, in one fragment
    bool there = false;
    bool sync = false;       // begins with a sync sample
    std::int64_t begin = 0;  // presentation, ticks of the track
  };
  struct Track {
    std::uint32_t id = 0, timescale = 1;
    std::int64_t shift = 0;  // from media time to presentation
    std::uint32_t default_duration = 0, default_flags = 0;
    std::int64_t end = 0;
    std::vector<Part> parts;  // one a fragment
  };
  void add_track(Bytes moov, const Box& trak);
  void add_part(Bytes moof, const Box& traf);

  std::uint32_t movie_timescale_ = 1;
  std::vector<Track> tracks_;
  std::vector<std::uint64_t> sizes_;  // of the fragments
};

}  // namespace animeme::media
