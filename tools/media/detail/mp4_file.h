// A plain MPEG-4 file of tracks in memory: contents first, one sample a chunk, samples of all
// tracks in the order of their times. Source: tools/media/containers.md, section 1.5.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

struct Mp4Sample {
  std::vector<std::uint8_t> bytes;
  std::int64_t duration = 0;  ///< in the track's time scale
  bool sync = true;
};

struct Mp4Track {
  unsigned id = 0;
  std::string handler;              ///< "vide", "soun", "sdsm", "odsm"
  std::string name;                 ///< of the handler
  std::vector<std::uint8_t> entry;  ///< the sample entry, a whole box
  std::uint32_t timescale = 0;
  std::int64_t start = 0;   ///< time of the first sample; negative: so much is skipped (priming)
  std::int64_t length = 0;  ///< what is shown, without what is skipped
  bool presented = true;    ///< false: scene and objects
  unsigned width = 0, height = 0;
  std::vector<unsigned> references;  ///< `mpod`
  std::vector<Mp4Sample> samples;
};

struct Mp4Movie {
  std::uint32_t timescale = 1000;
  std::vector<std::uint8_t> initial_object_descriptor;
  std::vector<Mp4Track> tracks;
};

/// Brand mp42. Error: out_of_range (4 GB or more).
Result<std::vector<std::uint8_t>> write_movie(const Mp4Movie& movie);

}  // namespace animeme::media
