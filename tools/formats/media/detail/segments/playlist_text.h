// The texts around segments: HLS playlists and DASH descriptions, written and read. No files.
// Source: tools/formats/media/containers.md, sections 2.2 and 4.3; RFC 8216; ISO/IEC 23009-1.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"
#include "tools/formats/media/track_labels.h"

namespace animeme::media {

/// One segment of a rendition that is being written.
struct Segment {
  std::string name;
  std::int64_t time = 0;      ///< presentation time in the rendition's scale; the first is 0
  std::int64_t duration = 0;  ///< > 0
  std::int64_t bytes = 0;
};

/// A track as segments in a folder.
struct SegmentedTrack {
  bool face = false;            ///< else sound
  std::string name;             ///< "face" or "sound": begins the names of its files
  std::string codecs;           ///< RFC 6381: "mp4s.20" or "mp4v.20.61", "mp4a.40.2", "opus"
  std::uint32_t timescale = 0;  ///< ticks a second
  int sample_rate = 0;          ///< of sound
  int channels = 0;
  TrackLabels labels;      ///< empty: nothing is said
  bool is_default = true;  ///< of the tracks of its kind
  std::string init;        ///< name of the initialization segment
  std::vector<Segment> segments;
};

/// A text of its own playlist, beside the others.
struct SidecarText {
  std::string playlist;      ///< its reference
  std::string name;          ///< what players list it as
  std::string language;      ///< empty: unknown
  std::string speaker = {};  ///< of several; empty: none
};

/// `folder` is where the segments lie, seen from the playlist: "talk_hls".
///
/// The top playlist: the sound is the one variant, so that any player plays it; the face is a
/// rendition that no variant asks for. A face alone is the variant. With labels, sounds are a group
/// of audio renditions, and faces one of video renditions, by LANGUAGE. Texts, whose playlists lie
/// in `folder`, too, are subtitles that nobody is shown unasked.
std::string hls_master(const std::vector<SegmentedTrack>& tracks, const std::string& folder,
                       const std::vector<SidecarText>& texts = {});

/// The playlist of a text in one file that lasts so many seconds.
std::string hls_text(const std::string& file, double seconds);

/// The playlist of a track, beside its segments.
std::string hls_media(const SegmentedTrack& track);

/// An MPD: one adaptation set a track. That of the face has an EssentialProperty, which tells
/// clients that do not know it to leave the set alone. Labels are `lang` and a role, main or dub.
std::string dash_description(const std::vector<SegmentedTrack>& tracks, const std::string& folder);

/// Names of files, relative to that of the playlist.
struct Rendition {
  std::string init;                   ///< empty: none
  std::vector<std::string> segments;  ///< in order
};

/// What an HLS playlist refers to: other playlists (a master playlist) or segments.
struct HlsPlaylist {
  std::vector<std::string> playlists;  ///< of face, sound and pictures
  std::vector<SidecarText> texts;
  Rendition rendition;
};

inline constexpr std::size_t kMostSegments = 100000;

/// Reads either kind. Errors: syntax (line), unsupported (byte ranges, encryption, more than one
/// initialization segment), out_of_range (more than kMostSegments).
Result<HlsPlaylist> read_hls(std::string_view text);

/// The first representation of each adaptation set of an MPD with one period: segment templates
/// with numbers or times, or segment lists. Errors: syntax (line), unsupported (several periods,
/// single files, documents with a DTD, live descriptions), out_of_range (as read_hls()).
Result<std::vector<Rendition>> read_dash(std::string_view text);

}  // namespace animeme::media
