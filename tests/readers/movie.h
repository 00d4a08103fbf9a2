// The samples of an MP4 by its own tables, whole movies and fragments, and what is wrong with them.
// Source: ISO 14496-12.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/readers/boxes.h"

namespace animeme::test {

struct MovieSample {
  std::size_t offset = 0;
  std::size_t size = 0;
  std::int64_t time = 0;  ///< of decoding, ticks of the track
  std::int64_t duration = 0;
  bool sync = true;
};

struct MovieEdit {
  std::uint64_t duration = 0;    ///< ticks of the movie
  std::int64_t media_time = -1;  ///< ticks of the track; -1: nothing is shown
};

struct MovieTrack {
  std::uint32_t id = 0;
  std::string handler;
  std::string entry;
  std::uint32_t timescale = 0;
  std::uint64_t media_duration = 0;  ///< ticks of the track
  std::uint64_t duration = 0;        ///< ticks of the movie
  std::vector<MovieEdit> edits;
  std::vector<MovieSample> samples;

  /// Seconds at which media time `time` is shown, by the edit list: leading pause, then one piece.
  double shown_at(std::int64_t time, std::uint32_t movie_timescale) const {
    double pause = 0;
    for (const MovieEdit& edit : edits) {
      if (edit.media_time >= 0) {
        time -= edit.media_time;
        break;
      }
      pause += double(edit.duration) / movie_timescale;
    }
    return pause + double(time) / timescale;
  }
};

struct Movie {
  std::uint32_t timescale = 0;
  std::uint64_t duration = 0;  ///< ticks
  std::vector<MovieTrack> tracks;
  /// One sentence for each rule that is broken: boxes that do not fit, tables that do not agree,
  /// durations that differ, samples outside of mdat or on top of each other, unused bytes in mdat,
  /// fragments that are not in order.
  std::vector<std::string> errors;

  const MovieTrack* track(const std::string& handler) const {
    for (const MovieTrack& track : tracks) {
      if (track.handler == handler) return &track;
    }
    return nullptr;
  }
};

Movie read_movie(const BoxFile& file);

}  // namespace animeme::test
