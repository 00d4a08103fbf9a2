/// @file
/// Timed text in a file: the words and phones that are spoken. Players show these tracks as
/// subtitles, selectable by name and language.
///
///     MuxInput input{.face = &units, .audio = &voice, .texts = &tracks};   // mux.h
///     Result<std::vector<TextTrack>> tracks = read_text_tracks("talk.mp4");
///
/// Source: tools/formats/media/containers.md, section 2.5.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

/// A text and the time when it is shown.
struct TextCue {
  double start = 0;  ///< seconds, >= 0; 0 is sample 0 of the sound
  double end = 0;    ///< seconds, > start
  std::string text;  ///< UTF-8, not empty; lines end with '\n', which readers make a blank
  /// Content of the cue in WebVTT, with tags such as times of words; empty: `text`.
  std::string webvtt;

  friend bool operator==(const TextCue&, const TextCue&) = default;
};

/// Name of the track that people read; others hold words and phones for programs. In mp4 this one
/// is a subtitle track whatever MuxOptions::text_track says.
inline constexpr std::string_view kCaptionTrack = "captions";

/// A sequence of texts.
struct TextTrack {
  std::string name;              ///< name in players: "words"; may be empty
  std::string language = "und";  ///< three letters (ISO 639-2, terminological); "zxx": none
  std::vector<TextCue> cues;     ///< ascending, without overlap

  friend bool operator==(const TextTrack&, const TextTrack&) = default;
};

/// Limits for reading.
struct TextLimits {
  std::size_t most_tracks = 32;       ///< further ones are skipped
  std::size_t most_cues = 2'000'000;  ///< in total: a day of phones
  std::size_t most_bytes = 1 << 26;   ///< of text in total
  std::size_t longest_text = 1000;    ///< bytes; longer text is truncated between characters
};

/// Whether write_container() can write text to a file of this name: .mp4, .mkv, and .m3u8 (as a
/// separate WebVTT file).
bool takes_text(const std::string& path);

/// Whether a file that begins with these bytes (12 suffice) may have text for read_text_tracks():
/// mp4 and related formats, Matroska, HLS.
bool may_hold_text(std::span<const std::uint8_t> beginning);

/// All tracks of timed text (mp4), SubRip or WebVTT (mkv), or WebVTT in one piece (HLS) in file
/// order, without style tags, including empty ones. Times as for read_container(): from sample 0 of
/// the sound. Cues that end before it, or have no length or no text, are dropped, and a cue ends
/// when the next one begins. Texts and names are cleaned by clean_text(). Without tracks the list
/// is empty. Safe for untrusted input. Errors: not_found (no file), io, truncated (empty), syntax
/// (no media file), unsupported (a format without may_hold_text()), out_of_range (limits, memory).
Result<std::vector<TextTrack>> read_text_tracks(const std::string& path,
                                                const TextLimits& limits = {});

/// The same from memory.
Result<std::vector<TextTrack>> read_text_tracks(std::span<const std::uint8_t> file,
                                                const TextLimits& limits = {});

/// Converts text to one clean line of UTF-8: invalid UTF-8 becomes U+FFFD; sequences of control
/// characters, line ends and blanks become one blank; bidirectional control characters are removed.
/// Truncated to `longest` bytes between characters.
std::string clean_text(std::string_view text, std::size_t longest = TextLimits{}.longest_text);

}  // namespace animeme::media
