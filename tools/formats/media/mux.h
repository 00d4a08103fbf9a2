/// @file
/// Writing a face and its sound to one file.
///
///     MuxInput input{.face = &units, .audio = &voice};
///     Result<MuxResult> written = write_container("talk.mp4", input);
///
/// The caller keeps access units and sound; they are not modified. Samples are encoded as mono, the
/// sound of a file in one or two channels; coded sound is copied unchanged. Time 0 of the face is
/// sample 0 of the sound. Files are written whole or not at all, and the same input gives the same
/// bytes (with the same FFmpeg on the same machine; other versions of its encoders may round
/// differently). Source: tools/formats/media/containers.md, sections 2.1, 2.2, 3.1, 3.2.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/unit_reader.h"
#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/pcm.h"
#include "tools/formats/media/stored.h"
#include "tools/formats/media/text_track.h"
#include "tools/formats/media/track_labels.h"
#include "tools/formats/media/video.h"

namespace animeme::media {

/// Contents of the file: face, sound, pictures, or any of them.
struct MuxInput {
  const fba::AccessUnits* face = nullptr;  ///< nullptr: sound only
  /// The face in place of `face`, read while it is written, so that memory does not grow with it
  /// (but for the table of an mp4 in one piece, of which FFmpeg keeps 140 bytes a unit). Not for
  /// HLS, DASH, Systems presentations and MuxOptions::shared_seconds. nullptr: none.
  fba::UnitReader* face_units = nullptr;
  const Pcm* audio = nullptr;  ///< samples to be coded; nullptr: none
  /// A sound file (see AudioReader) that is decoded and coded while it is written, so that memory
  /// does not grow with it; two channels stay two, more become two; nullptr: none.
  const std::string* audio_file = nullptr;
  /// Coded sound to be copied, packet by packet; nullptr: none.
  const EncodedAudio* encoded = nullptr;
  /// The same, read while it is written, so that memory does not grow with it (but in Systems
  /// presentations). nullptr: none. One of these four at most.
  StoredAudio* stored = nullptr;
  /// Video for players without FBA support; nullptr: none. It becomes the first track, and the face
  /// track is then disabled by default. In .mp4, .mkv and .webm (VP9), not in Systems
  /// presentations.
  const EncodedVideo* video = nullptr;
  /// Text tracks, the last ones of the file, in this order; nullptr: none. Players do not show them
  /// by default; see also MuxOptions::text_track. For files of takes_text(), not for Systems
  /// presentations. Cleaned by clean_text().
  const std::vector<TextTrack>* texts = nullptr;
  /// Language of face, sound and texts, and who speaks; empty: the file does not tell.
  TrackLabels labels = {};
  /// The same in further languages, or of further people: each a face, a sound, texts, or any of
  /// them, with labels of its own. Faces of one person stand for each other, as do its sounds and
  /// its texts of one name (mp4: alternate groups); the first of a kind is the default. Neither
  /// pictures nor another list in them. In .mp4, .mkv, .m3u8 and .mpd, and up to six languages
  /// without speakers in .ts.
  std::vector<MuxInput> more = {};
  /// Visual profile and level for the file's own table of contents (mp4 `iods`): 0x61..0x64.
  /// 0: as in the face's configuration, 0x61 if that has none.
  std::uint8_t visual_profile = 0;

  bool has_face() const { return face != nullptr || face_units != nullptr; }  ///< either
  /// Members that give a sound; at most one may.
  int sounds() const {
    return int(audio != nullptr) + int(audio_file != nullptr) + int(encoded != nullptr) +
           int(stored != nullptr);
  }
  /// Of coded sound that is copied; null: there is none.
  const AudioFormat* coded_format() const;
};

/// Type of the face track in mp4, HLS and DASH.
enum class FaceTrackType : std::uint8_t {
  /// Timed metadata: handler `meta`, sample entry `mp4s`. Players and converters skip it.
  metadata,
  /// MPEG-4 video, as ISO/IEC 14496-14 specifies: handler `vide`, sample entry `mp4v`, for MPEG-4
  /// readers that expect it. FFmpeg and GStreamer try to decode it as video and fail.
  video,
};

/// Type of the text tracks in mp4.
enum class TextTrackType : std::uint8_t {
  /// 3GPP timed text, sample entry `tx3g`: players list it. The ffmpeg program cannot copy it to
  /// Matroska: `-c copy out.mkv` needs `-c:s srt` or `-sn` as well.
  subtitles,
  /// The same samples as timed metadata, sample entry `mett`: read_text_tracks() reads it, players
  /// do not list it.
  metadata,
};

/// How a container is written.
struct MuxOptions {
  AudioSettings audio;  ///< how MuxInput::audio or MuxInput::audio_file is coded
  /// Receives one sentence for each anomaly of MuxInput::audio_file; nullptr: none.
  std::vector<std::string>* warnings = nullptr;
  /// mp4, HLS, DASH: type of the face track. A Systems presentation always has a video track.
  FaceTrackType face_track = FaceTrackType::metadata;
  /// mp4: type of the text tracks, except the one named kCaptionTrack, which is of subtitles.
  TextTrackType text_track = TextTrackType::subtitles;
  /// mp4: moov before mdat, so that a player can start while it loads.
  bool faststart = true;
  /// mp4: self-contained fragments, so that a reader can start while the file is still being
  /// written or sent. Each intra plane also begins a fragment.
  bool fragmented = false;
  /// Maximum length of a fragment, and minimum of a segment of HLS and DASH except the last;
  /// 0.02..600.
  double fragment_seconds = 1;
  /// ts: planes that begin within so many seconds share a PES packet, which takes at least 188
  /// bytes, and tables are written every 0.5 s, or with each packet, instead of every 0.1 s; 0..2.
  /// Several planes in a packet are legal and supported here, but not by every reader. 0: one
  /// packet per plane.
  double shared_seconds = 0;
  /// mp4: a complete MPEG-4 Systems presentation with a scene of a face and a sound, an object
  /// stream and the initial object descriptor; for players and tools of MPEG-4 Systems. It is made
  /// in memory, with the contents first, and limited to 4 GB. Sound: AAC.
  bool systems = false;
  /// Called before each packet, once every track has half a second: returning true ends the file
  /// early but complete. Not called for Systems presentations, which are written at once. Empty:
  /// never.
  std::function<bool()> stop = {};
  /// Called with 0..1 from time to time, finally with 1; may be empty.
  std::function<void(double)> progress = {};
};

/// Result of writing.
struct MuxResult {
  double seconds = 0;        ///< end of the longer track in the file
  double sound_seconds = 0;  ///< length of the sound, as far as it was written; 0: none
  bool stopped = false;      ///< MuxOptions::stop ended it: the file holds the first `seconds` only
};

/// The default codec for a file of this name: Opus for .opus, .webm and .weba, which do not support
/// AAC, else AAC.
AudioCodec usual_codec(const std::string& path);

/// MPEG-4 file: brand mp42, `iods` with profile bytes and tracks, face as MuxOptions::face_track
/// says, with `esds` (object type 0x20, ES_ID 0, bufferSizeDB and maximum bit rate from the data)
/// and sync table; exact media time scale (times a whole factor if it is below 10000);
/// priming of the sound in the edit list, so sound and face agree to the sample. A sample rate
/// that the codec lacks is resampled (see AudioEncoder).
/// Errors: invalid_argument (nothing to write; no units; configuration not of a face; an empty unit
/// or packet; times not ascending or negative; durations not positive; empty sound; bit rate; sound
/// given twice; fragment length; cues of a text not ascending, or without a length; a label that is
/// no tag), those of
/// AudioReader for a sound file, io (folder missing, disk full ...), unsupported (this FFmpeg lacks
/// the encoder; Opus in a Systems presentation), out_of_range (memory).
Result<MuxResult> write_mp4(const std::string& path, const MuxInput& input,
                            const MuxOptions& options = {});

/// The same by extension:
///   .mp4                 face, AAC or Opus
///   .mkv                 face, AAC or Opus; times are rounded to 1 ms, and with AAC everything is
///                        moved by its priming (21.3 ms at 48 kHz); face against sound at most
///                        0.5 ms off
///   .ts                  face, AAC; configuration in front of each intra plane, stream type 0x10
///   with an MPEG-4 video descriptor, the same common shift plus 1.4 s, 90 kHz
///                        clock, 188 bytes or more for each plane, but see
///                        MuxOptions::shared_seconds
///   .m3u8 .mpd           HLS or DASH: face and sound as fragmented mp4 segments, each a rendition
///                        of its own, in a folder beside the file ("talk_hls", "talk_dash"), which
///                        is replaced if it holds such segments only. The sound is what a player
///                        finds that knows no faces. A segment begins with an intra plane and lasts
///                        MuxOptions::fragment_seconds or longer; face and sound as in mp4
///   .m4a                 sound alone: AAC
///   .mka                 sound alone: AAC or Opus
///   .webm .weba .opus    sound alone: Opus
/// Further errors: unsupported (another extension, "-"; a face or a codec that the format does not
/// take; a Systems presentation or fragments that are no mp4), io (the folder of segments holds
/// other files).
Result<MuxResult> write_container(const std::string& path, const MuxInput& input,
                                  const MuxOptions& options = {});

/// The segment folder of a playlist, "talk_hls" for talk.m3u8; "" for other files.
std::string segment_folder(const std::string& path);

/// Checks that the segment folder of this playlist can be created or replaced. Errors: io.
Result<void> try_segments(const std::string& path);

}  // namespace animeme::media
