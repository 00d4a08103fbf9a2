/// @file
/// Text in a file that is shown while it plays: what is said, and with which sounds. Such tracks
/// are subtitles to players that know nothing of faces, each a choice of their menu by name and
/// language.
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

/// A text and when it is shown.
struct TextCue {
  double start = 0;  ///< seconds, >= 0; 0 is sample 0 of the sound
  double end = 0;    ///< seconds, > start
  std::string text;  ///< UTF-8, not empty

  friend bool operator==(const TextCue&, const TextCue&) = default;
};

/// Texts one after the other.
struct TextTrack {
  std::string name;              ///< what players list it as: "words"; may be empty
  std::string language = "und";  ///< three letters (ISO 639-2, terminological); "zxx": none
  std::vector<TextCue> cues;     ///< ascending, without overlap

  friend bool operator==(const TextTrack&, const TextTrack&) = default;
};

/// Where reading stops.
struct TextLimits {
  std::size_t most_tracks = 32;       ///< further ones are left out
  std::size_t most_cues = 2'000'000;  ///< in all: a day of phones
  std::size_t most_bytes = 1 << 26;   ///< of text in all
  std::size_t longest_text = 1000;    ///< bytes; what is longer is cut between characters
};

/// Whether write_container() puts text into a file of this name: .mp4, .mkv, and .m3u8, beside
/// which it lies as WebVTT.
bool takes_text(const std::string& path);

/// Whether a file that begins with these bytes (12 will do) may have text that read_text_tracks()
/// finds: mp4 and its relatives, Matroska, HLS.
bool may_hold_text(std::span<const std::uint8_t> beginning);

/// All tracks of timed text (mp4), SubRip or WebVTT (mkv), or WebVTT in one piece (HLS) in the
/// order of the file, without their marks of style; those without a text, too. Times as for
/// read_container(): from sample 0 of the sound; what ends before that is left out, as is what has
/// no length or no text, and a cue ends with the next one at the latest. Each text and name is as
/// clean_text() leaves it. No tracks: an empty list. Safe for untrusted input. Errors: not_found
/// (no file), io, truncated (empty), syntax (no media file), unsupported (another format than
/// may_hold_text() tells), out_of_range (limits, memory).
Result<std::vector<TextTrack>> read_text_tracks(const std::string& path,
                                                const TextLimits& limits = {});

/// The same from memory.
Result<std::vector<TextTrack>> read_text_tracks(std::span<const std::uint8_t> file,
                                                const TextLimits& limits = {});

/// One line of UTF-8 for people: what is no UTF-8 becomes U+FFFD; control characters, line ends and
/// blanks become one blank between what they part; marks that turn the direction of writing are
/// left out. Cut to `longest` bytes between characters.
std::string clean_text(std::string_view text, std::size_t longest = TextLimits{}.longest_text);

}  // namespace animeme::media
