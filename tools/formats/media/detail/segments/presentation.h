// Segments in a folder, put together again: what a playlist on this machine refers to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/formats/media/container.h"

namespace animeme::media {

/// Is a file with this name a playlist (.m3u8) or a DASH description (.mpd)?
bool is_playlist(const std::string& path);

/// A text of a presentation, as it lies there.
struct PresentedText {
  std::string name, language;
  std::vector<std::uint8_t> file;
};

struct Presentation {
  const char* format = "hls";                         ///< or "dash"
  std::vector<std::vector<std::uint8_t>> renditions;  ///< each: initialization and segments
  std::vector<PresentedText> texts;                   ///< those that can be read (HLS)
};

/// Reads the playlist and all that it refers to. A closed room: only ordinary files in the folder
/// of the playlist or below it are opened, whatever names or symbolic links say, and not more than
/// 1 GB in all. Errors: not_found, io, syntax, truncated, unsupported, out_of_range.
Result<Presentation> read_presentation(const std::string& path);

/// The first rendition with a track of this kind that is wanted (track_labels.h), or else with one
/// without labels; nullptr: there is none.
const std::vector<std::uint8_t>* find_rendition(const Presentation& presentation, TrackKind kind);

/// The rendition with the sound. Errors: those of reading the presentation; not_found (silent).
Result<std::vector<std::uint8_t>> sound_of_playlist(const std::string& path);

/// Runs `read` on a file, or on the bytes of the sound if it is a playlist. Errors: those of `read`
/// and of sound_of_playlist().
template <class Read>
auto read_sound_of(const std::string& path, const Read& read) -> decltype(read(path)) {
  if (!is_playlist(path)) return read(path);
  const Result<std::vector<std::uint8_t>> sound = sound_of_playlist(path);
  if (!sound) return sound.error();
  return read(std::span<const std::uint8_t>(*sound));
}

/// A file name as a relative reference: other characters than letters, digits and -_.~/ as %XX.
std::string to_reference(const std::string& name);

/// Back again. Errors: syntax (damaged %XX), unsupported (an address, an absolute name, or one
/// that leads out of the folder).
Result<std::string> from_reference(const std::string& reference);

}  // namespace animeme::media
