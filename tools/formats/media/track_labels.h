/// @file
/// What tells the tracks of a file apart: the language of a face, its sound and its words, and who
/// speaks.
///
///     TrackScope scope(parse_track_labels("lang=de,speaker=Ann").value());
///     read_container("film.mp4");                // the German face of Ann
///
/// Source: tools/formats/media/containers.md, section 2.6.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::media {

/// Labels of a track. Empty: not known.
struct TrackLabels {
  std::string language;  ///< tag as BCP 47 has it, "de", "pt-BR"; at most 35 characters
  std::string code;      ///< the same in three letters (ISO 639-2, terminological), "deu"
  std::string speaker;   ///< name of the person, at most 60 bytes

  bool empty() const { return language.empty() && code.empty() && speaker.empty(); }  ///< nothing
  friend bool operator==(const TrackLabels&, const TrackLabels&) = default;
};

/// Cuts the first part of a list at its comma and takes it from `rest`. A comma or a backslash of a
/// name is behind a backslash: "speaker=Smith\, Ann".
std::string next_label(std::string_view& rest);

/// Reads "lang=de,speaker=Ann", both or one of them; `code` stays empty. Errors: invalid_argument
/// (another word, an empty value, a language that is no tag).
Result<TrackLabels> parse_track_labels(std::string_view text);

/// Checks a language tag: 2 to 8 letters, then parts of 1 to 8 letters and digits behind hyphens.
bool is_language_tag(std::string_view tag);

/// Whether a track with these labels is what `wanted` asks for: the same person, the language or a
/// narrower one (`pt` is also `pt-BR`). Where a file has three letters only, these are compared;
/// letters of any case.
bool is_wanted(const TrackLabels& wanted, const TrackLabels& track);

/// While it lives, all readers of this thread (read_container(), stream_face(), read_audio(),
/// AudioReader, read_encoded_audio(), extract_audio(), read_text_tracks()) see the tracks with
/// these labels alone: a face, a sound, words. Tracks without a language count as being in any, and
/// those without a name as of any person, if the file has no others of their kind. Nothing wanted:
/// the file's default. Scopes nest.
class TrackScope {
 public:
  explicit TrackScope(TrackLabels wanted);  ///< from now on
  ~TrackScope();                            ///< what was wanted before
  TrackScope(const TrackScope&) = delete;
  TrackScope& operator=(const TrackScope&) = delete;

 private:
  TrackLabels before_;
};

/// What the readers of this thread look for.
const TrackLabels& wanted_track();

}  // namespace animeme::media
