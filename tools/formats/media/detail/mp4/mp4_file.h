// A plain MPEG-4 file of tracks in memory: contents first, one sample a chunk, samples of all
// tracks in the order of their times; or its contents alone, in front of fragments. Source:
// tools/formats/media/containers.md, section 1.5.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/detail/mp4/box_writer.h"

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
  std::uint32_t fragment_duration = 0;  ///< of samples in fragments that do not say it
};

struct Mp4Movie {
  std::string brands = "mp42isom";  ///< the first is the major one
  std::uint32_t timescale = 1000;
  std::vector<std::uint8_t> initial_object_descriptor;  ///< empty: none
  bool fragments = false;                               ///< fragments follow
  std::vector<Mp4Track> tracks;
};

/// Begins a sample entry of any kind; one of sound (`type` "mp4a" or "Opus").
void begin_entry(BoxWriter& out, std::string_view type);
void begin_sound_entry(BoxWriter& out, std::string_view type, unsigned channels, int sample_rate);

/// What is in front of the samples, for tracks that have none or fragments of them.
std::vector<std::uint8_t> write_contents(const Mp4Movie& movie);

/// Error: out_of_range (4 GB or more).
Result<std::vector<std::uint8_t>> write_movie(const Mp4Movie& movie);

}  // namespace animeme::media
