/// @file
/// Scripts and sounds from files, or from standard input for "-". Errors and warnings (to log.warn)
/// include the file name.
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

/// Default limit for the length of a script, seconds: a phone of a day takes one line of text, but
/// two gigabytes of curves.
inline constexpr double kMostSeconds = 3600;

/// Options for reading a script.
struct ScriptInput {
  dam::ScriptOptions reading;                    ///< its format, tier, unit; nullopt: by content
  std::string language = "en";                   ///< of words without phones
  double most_seconds = dam::kMaxScriptSeconds;  ///< longer ones are rejected
};

/// Reads a script of any format (tools/formats/scripts/script_text.h), or from a media file with
/// tracks of words and phones (carried_script()). Words with times get phones by pronunciation,
/// with a message to log.info. Errors: those of tools::read_text_file(), scripts::read_labels(),
/// dam::make_script() and voice::words_to_phones(), media::read_text_tracks(); out_of_range (it
/// lasts more than `most_seconds`).
Result<dam::Script> read_script(const std::string& path, const ScriptInput& input = {},
                                const tools::Log& log = {}, bool* from_words = nullptr);
/// The same from its text; `path` is for messages. `from_words`, if not null, receives whether the
/// phones are estimated.
Result<dam::Script> parse_script(const std::string& text, const std::string& path,
                                 const ScriptInput& input = {}, const tools::Log& log = {},
                                 bool* from_words = nullptr);

/// Words and phones of a script as text tracks, for media::MuxInput::texts: "words" in `language`
/// (a tag such as "de-at", or a code of espeak-ng; empty: unknown) and "phones"; empty tracks are
/// omitted.
std::vector<media::TextTrack> carried_texts(const dam::Script& script, std::string_view language);

/// Puts captions (dam/script/captions.h) of these tracks in front of them, in the language of the
/// words, as a track media::kCaptionTrack; without words nothing is added.
void add_captions(std::vector<media::TextTrack>& tracks);

/// Reads these tracks of a file; empty: it has none, or cannot be read again ("-", pipes). If it
/// has more text than the limit, log.warn is called.
std::vector<media::TextTrack> carried_tracks(const std::string& path, const tools::Log& log = {});

/// Converts these tracks of a file to a script; nullopt: there are none, or they are unusable
/// (reported to log.warn).
std::optional<dam::Script> carried_script(const std::string& path, const ScriptInput& input = {},
                                          const tools::Log& log = {});

/// Reads a recording as samples of one channel; `sample_rate` 0: its own. Errors: those of
/// media::read_audio().
Result<media::Pcm> read_voice(const std::string& path, const tools::Log& log = {},
                              int sample_rate = 0);

/// A sound to be written to a file: either coded packets, or samples to be encoded.
struct SoundInput {
  std::optional<media::EncodedAudio> coded;  ///< nullopt: `samples`
  std::optional<media::Pcm> samples;         ///< nullopt: `coded`

  double seconds() const;  ///< length
  /// Sets it in `input`, which borrows it.
  void give_to(media::MuxInput& input) const;
};

/// Returns whether sound of a codec may be copied without re-encoding.
using KeepCodec = std::function<bool(media::AudioCodec)>;

/// The best sound of a file: its packets if it is AAC or Opus and `keep` agrees, else samples.
/// Errors: those of media::read_encoded_audio() and media::read_audio(); not_found: no file, or no
/// sound in it.
Result<SoundInput> read_sound(const std::string& path, const KeepCodec& keep,
                              const tools::Log& log = {});

/// The same, encoded with `settings` if it cannot be copied. Errors: also those of
/// media::encode_audio().
Result<media::EncodedAudio> read_coded_sound(const std::string& path, const KeepCodec& keep,
                                             const media::AudioSettings& settings,
                                             const tools::Log& log = {});

}  // namespace animeme::speech
