/// @file
/// Scripts and sounds from files, or from standard input for "-". Each error names its file, and so
/// does each warning, which goes to talk.warn.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/files/log.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/mux.h"
#include "tools/formats/media/pcm.h"
#include "tools/formats/media/text_track.h"

namespace animeme::speech {

/// Longest script that is spoken unless more is asked for: a phone of a day takes one line of text
/// and two gigabytes of curves.
inline constexpr double kMostSeconds = 3600;

/// How a script is read.
struct ScriptInput {
  dam::ScriptOptions reading;   ///< its format, tier, unit; nothing: by its content
  std::string language = "en";  ///< of words that come without phones
  double most_seconds = dam::kMaxScriptSeconds;  ///< longer ones are refused
};

/// A script of any format (tools/formats/scripts/script_text.h), or out of a media file that
/// carries words and phones (carried_script()). Words with times get their phones by pronunciation,
/// with a sentence to talk.say() that says so. Errors: those of tools::read_text_file(),
/// scripts::read_labels(), dam::make_script() and voice::words_to_phones(),
/// media::read_text_tracks(); out_of_range (it lasts more than `most_seconds`).
Result<dam::Script> read_script(const std::string& path, const ScriptInput& input = {},
                                const tools::Log& log = {}, bool* from_words = nullptr);
/// The same from its text; `path` is for messages. `from_words`, if not null, is told whether the
/// phones are guessed.
Result<dam::Script> parse_script(const std::string& text, const std::string& path,
                                 const ScriptInput& input = {}, const tools::Log& log = {},
                                 bool* from_words = nullptr);

/// Words and phones of a script as a media file carries them: for media::MuxInput::texts. Tracks
/// "words" in `language` (a tag as "de-at", or a code of espeak-ng; empty: not known) and "phones";
/// without one that has no text.
std::vector<media::TextTrack> carried_texts(const dam::Script& script, std::string_view language);

/// These tracks of a file; empty: it has none, or cannot be read again ("-", pipes). More text than
/// is read is told to talk.warn.
std::vector<media::TextTrack> carried_tracks(const std::string& path, const tools::Log& log = {});

/// They as a script again; nothing: there are none, or they cannot be used, which talk.warn is
/// told.
std::optional<dam::Script> carried_script(const std::string& path, const ScriptInput& input = {},
                                          const tools::Log& log = {});

/// A recording as samples of one channel; `sample_rate` 0: its own. Errors: those of
/// media::read_audio().
Result<media::Pcm> read_voice(const std::string& path, const tools::Log& log = {},
                              int sample_rate = 0);

/// A sound that goes into a file: coded already (with packets), or samples to be coded; one of
/// them.
struct SoundInput {
  std::optional<media::EncodedAudio> coded;  ///< nothing: `samples`
  std::optional<media::Pcm> samples;         ///< nothing: `coded`

  double seconds() const;  ///< length of whichever there is
  /// Names it in `input`, which borrows it.
  void give_to(media::MuxInput& input) const;
};

/// Whether sound of a codec may stay as it is coded.
using KeepCodec = std::function<bool(media::AudioCodec)>;

/// The best sound of a file: its packets if it is AAC or Opus and `keep` agrees, else samples.
/// Errors: those of media::read_encoded_audio() and media::read_audio(); not_found: no file, or no
/// sound in it.
Result<SoundInput> read_sound(const std::string& path, const KeepCodec& keep,
                              const tools::Log& log = {});

/// The same, coded with `settings` where it could not stay. Errors: also those of
/// media::encode_audio().
Result<media::EncodedAudio> read_coded_sound(const std::string& path, const KeepCodec& keep,
                                             const media::AudioSettings& settings,
                                             const tools::Log& log = {});

}  // namespace animeme::speech
