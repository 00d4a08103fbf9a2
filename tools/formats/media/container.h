/// @file
/// Reading faces from containers, and probing files.
///
///     Result<Container> talk = read_container("talk.mp4");
///     if (!talk) return talk.error();
///     fba::join_access_units(talk->face);       // the raw stream
///
/// The format is detected by content. mp4 (also fragmented, mov), Matroska, MPEG-TS (stream type
/// 0x10, and 0x06 that begins with an FBA code) and NUT can carry a face. A name that ends in .m3u8
/// or .mpd is a playlist of segments (HLS, DASH), which are read as well: only regular files in its
/// folder or below, 1 GB in total. Safe for untrusted input: no other file or address is opened,
/// memory and time stay bounded.
/// Source: tools/formats/media/containers.md, sections 1.2, 1.3, 2.3, 3.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/repair.h"
#include "fap/result.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/track_labels.h"

/// Sound, containers and live transports.
namespace animeme::media {

/// A sound track as its header describes it.
struct AudioInfo {
  std::string codec;          ///< FFmpeg's name: "aac", "opus", "pcm_s16le" ...
  int sample_rate = 0;        ///< Hz
  int channels = 0;           ///< as decoded: 1 for our own mono AAC
  double duration = 0;        ///< seconds; 0: not stated
  std::int64_t bit_rate = 0;  ///< bits a second; 0: not stated
};

/// A face with its times, and what else the file contains.
struct Container {
  std::string format;  ///< "mp4", "mov", "matroska", "mpegts", "nut", "hls", "dash"
  /// Units byte for byte; configurations repeated before planes (TS) are stripped. `intra` comes
  /// from the plane header. Time 0 is sample 0 of read_audio() for the same file, to one tick of
  /// the container's clock (times are negative if the face begins before the sound); a file without
  /// sound keeps its own times (TS: first unit at 0). Durations reach to the next unit; the last
  /// one is that of the container, or else that of the previous unit. timescale is the container's:
  /// exact in mp4, 1000 in mkv, 90000 in TS.
  fba::AccessUnits face;
  /// Profile and level of the configuration, 0x61..0x64 for faces; 0: not given.
  std::uint8_t visual_profile = 0;
  std::optional<AudioInfo> audio;  ///< the best sound track
  /// With ReadOptions::repair: planes that are missing, or were left out since they are damaged.
  /// The plane before them lasts until the next intact one, and skips as many frames.
  std::vector<fba::Damage> damage;
  /// Anomalies that did not prevent reading, one sentence each.
  std::vector<std::string> warnings;
};

/// Limits for reading.
struct ReadOptions {
  /// More face data is rejected (an index can refer to the same bytes repeatedly).
  std::size_t max_bytes = std::size_t(1) << 28;
  std::size_t max_units = 4'000'000;  ///< 15 hours at 72 planes a second
  /// Decodes all planes and leaves out what is damaged, fba::repair_units(): see
  /// Container::damage. Otherwise units are as they are in the file, and what is missing is a
  /// warning.
  bool repair = false;
};

/// Reads the face. Damage does not affect the intact parts of a file: a broken or truncated unit is
/// dropped, with the predictive planes after it up to the next intra plane, and a warning is added.
/// Errors: not_found (no file, or no face in it), io, truncated (empty), syntax (not a media file;
/// no readable intra plane), unsupported (a format that cannot carry a face, or a raw FBA stream),
/// out_of_range (limits, memory).
Result<Container> read_container(const std::string& path, const ReadOptions& options = {});

/// The same from memory.
Result<Container> read_container(std::span<const std::uint8_t> file,
                                 const ReadOptions& options = {});

/// What stream_face() has handed over.
struct FaceSummary {
  std::string format;               ///< as Container::format
  std::uint8_t visual_profile = 0;  ///< as Container::visual_profile
  std::uint32_t timescale = 1;      ///< ticks per second
  std::size_t units = 0;            ///< number of access units
  std::int64_t start = 0;           ///< of the first one, ticks, as Container::face
  std::int64_t end = 0;             ///< of the last one
};

/// Takes an access unit and the decoder configuration. Of the unit's times only the duration is
/// that of Container::face: where the sound begins is not known yet.
using TakeUnit =
    std::function<Result<void>(const fba::AccessUnit&, std::span<const std::uint8_t> config)>;

/// Hands over the units of read_container(), with ReadOptions::repair, one after the other, so that
/// memory does not grow with them (but for the table of an mp4, some 70 bytes a unit). nullopt:
/// there is something to repair or to warn of, or the file is a playlist: what was handed over is
/// void, and read_container() tells more. Errors: those of read_container() and of `take`.
Result<std::optional<FaceSummary>> stream_face(const std::string& path, const TakeUnit& take);

/// The best audio track as it is coded, AAC or Opus, packet by packet. Time 0 is sample 0 of
/// read_audio(); times from coarse clocks (mkv, TS) are restored where packets follow each other.
/// Damaged packets are dropped. Errors: not_found (no file, no audio track), io, truncated, syntax
/// (nothing can be read), unsupported (another codec; a format that FFmpeg does not support),
/// out_of_range (over 1 GB, memory).
Result<EncodedAudio> read_encoded_audio(const std::string& path);

/// The same from memory.
Result<EncodedAudio> read_encoded_audio(std::span<const std::uint8_t> file);

/// Content of a track.
enum class TrackKind : std::uint8_t { face, audio, video, text, other };

/// "face", "audio", "video", "text" or "other".
const char* name_of(TrackKind kind);

/// One track, from headers.
struct TrackInfo {
  TrackKind kind = TrackKind::other;  ///< detected by content
  std::string codec;                  ///< "fba" for a face, else FFmpeg's name
  std::string tag;              ///< four-character code of mp4 and similar formats; may be empty
  std::uint32_t timescale = 0;  ///< ticks a second; 0: not an integer
  double start = 0;             ///< seconds, on the clock of the file
  double duration = 0;          ///< seconds; 0: not stated
  std::int64_t bit_rate = 0;    ///< bits a second; 0: not stated
  std::int64_t samples = 0;     ///< access units or packets; 0: not stated
  int sample_rate = 0;          ///< audio
  int channels = 0;             ///< audio
  int width = 0;                ///< video
  int height = 0;               ///< video
  double pixel_aspect = 1;      ///< video: width of a displayed pixel to its height
  double frame_rate = 0;        ///< video and face, frames a second; 0: not stated
  std::uint8_t visual_profile = 0;        ///< face; 0: not given
  std::vector<std::uint8_t> face_config;  ///< face; empty: in band
  std::string name;                       ///< text: as TextTrack::name
  std::string language;                   ///< text: as TextTrack::language
  TrackLabels labels;                     ///< language and speaker, of any kind
  bool is_default = false;                ///< players choose it
};

/// Contents of a file, from its headers.
struct ContainerInfo {
  std::string format;       ///< as in Container, or any other name of FFmpeg: "wav", "mp3" ...
  double duration = 0;      ///< seconds; 0: unknown
  std::int64_t bytes = -1;  ///< of the file; -1: unknown
  std::vector<TrackInfo> tracks;      ///< in the order of the file
  std::vector<std::string> warnings;  ///< one sentence each

  /// The first track of a kind, nullptr: there is none.
  const TrackInfo* first(TrackKind kind) const {
    for (const TrackInfo& track : tracks) {
      if (track.kind == kind) return &track;
    }
    return nullptr;
  }
};

/// Probes any media file. Errors: as read_container(), but a missing face or another format is not
/// an error.
Result<ContainerInfo> probe(const std::string& path);

/// The same from memory.
Result<ContainerInfo> probe(std::span<const std::uint8_t> file);

/// Extracts the best audio track of `in`. By the extension of `out`:
///   .wav                  decoded to 16 bits, mono, the file's sample rate (see read_audio())
///   .m4a .mp4             copied: aac, alac (m4a), mp3, opus (mp4); priming stays in the edit list
///   .aac                  copied: aac; the format cannot mark the first 1024 samples as priming
///   .opus .ogg            copied: opus, vorbis (ogg), flac (ogg)
///   .mka                  copied: any codec that Matroska supports
///   .mp3 .flac            copied: the codec of that name
/// Copied packets keep their bytes; time begins at 0 even if the track begins later.
/// Errors: those of reading; unsupported (extension, or a codec that does not fit: the message says
/// what to use); io (writing). No file is left behind after a failure.
Result<void> extract_audio(const std::string& in, const std::string& out);

}  // namespace animeme::media
