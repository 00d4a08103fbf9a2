// Faces and texts of an mp4 as timed metadata tracks. libavformat writes them as MPEG-4 video and
// as subtitles; converters try to decode the former, and the ffmpeg program cannot copy the latter
// to Matroska. Source: tools/formats/media/containers.md, section 1.6.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/formats/media/detail/mp4/box_writer.h"
#include "tools/formats/media/detail/mp4/boxes.h"
#include "tools/formats/media/mux.h"

namespace animeme::media {

/// What one track of a file of several languages says besides.
struct TrackMark {
  std::string tag;     ///< language as BCP 47 has it; empty: none
  unsigned group = 0;  ///< of tracks that stand for each other; 0: none
};

/// Track types of faces and texts in a file.
struct TrackTypes {
  FaceTrackType face = FaceTrackType::metadata;
  TextTrackType text = TextTrackType::subtitles;
  std::vector<TrackMark> marks = {};  ///< of all tracks in their order; empty: they have none
};

/// A `moov` with these marks: `elng` behind `mdhd`, and alternate groups in `tkhd`.
std::vector<std::uint8_t> marked_moov(Bytes moov, const std::vector<TrackMark>& marks);

/// Whether `types` asks to convert this `trak` of libavformat to metadata: a face (handler `vide`,
/// sample entry `mp4v`, configuration of a face) or a text (sample entry `tx3g`).
bool becomes_metadata(Bytes moov, const Box& trak, const TrackTypes& types);

/// Writes this `trak` with the handler `meta` and the media header `nmhd`. The sample entry of a
/// face becomes `mp4s` with the same `esds`, that of a text `mett` of type video/3gpp-tt.
void put_metadata(BoxWriter& out, Bytes moov, const Box& trak);

/// A metadata track whose content libavformat ignores.
struct MetadataTrack {
  std::uint32_t id = 0;
  bool face = false;                 ///< else a text in 3GPP samples
  std::vector<std::uint8_t> config;  ///< decoder configuration of a face; empty: in band
};

/// The certain and possible faces (sample entry `mp4s`) and the texts (sample entry `mett`) of a
/// whole `moov` box. Damaged boxes are skipped.
std::vector<MetadataTrack> metadata_tracks(Bytes moov);

/// The extended languages of a whole `moov` box, by the number of the track.
std::map<std::uint32_t, std::string> extended_languages(Bytes moov);

}  // namespace animeme::media
