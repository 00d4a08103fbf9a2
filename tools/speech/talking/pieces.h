/// @file
/// Speech pushed by another program: pieces of sound with words, phones or visemes, one line of
/// JSON each, as speech services deliver them.
///
///     {"text": "Hello", "audio": "UklGR...", "words": [{"word": "Hello", "start": 0, "end": 0.4}]}
///     {"audio": "AAAA...", "sample_rate": 24000}
///     {"context_id": "u7", "word_timestamps": {"words": ["Hello"], "start": [0], "end": [0.4]}}
///     {"file": "two.wav", "script": "0 0.1 HH\n0.1 0.3 AY\n"}
///
/// Members, in any case, with or without "_":
///
/// - audio, audio_base64, audio_content, data: the sound, base64: a file (WAV, MP3, Ogg, FLAC ...),
///   samples, or a part of an MP3, cut anywhere; of messages whose "type" names an audio delta:
///   delta
/// - file, audio_file: the sound as the path of a file
/// - sample_rate: Hz of samples, 1000..384000; channels: 1..16, interleaved; encoding, format,
///   output_format: names of read_coding() (16 bits little-endian, f32le, mu-law, A-law). They hold
///   for later pieces until others are given.
/// - script: timings: text in any script format, or JSON of one
/// - text, transcript: what is said
/// - utterance, utterance_id, context_id, response_id, item_id: the utterance that it belongs to
/// - times_from: "piece" or "utterance": where times count from; without it the piece, or, if it
///   names its utterance, what its times fit
/// - done, final, is_final, last: true: the utterance ends
/// - language, lang: of the text
/// - id: its name in events (line_events.h); do, when, mood: see line_command.h
///
/// Without `script` the piece itself may be JSON of any format that scripts::read_labels() knows:
/// words with times, events of Azure, characters of ElevenLabs, visemes. Members of services that
/// mean nothing here are ignored.
///
/// **Sound is never dropped.** Pieces of one utterance follow each other, and the face moves by
/// what is known when a piece is due: times that came with it, or in a message of their own, before
/// or behind it (messages with an utterance and without sound are not spoken themselves); a text
/// that is as long as the sound, which is aligned with it; else the sound alone, as a listener
/// hears it. A word may end in a later piece. What does not fit is left out with a warning.
///
/// A piece with timings, without sound and utterance moves the face only. A piece with only text is
/// spoken by a synthetic voice; with an utterance that happens when it ends without sound.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/timed_sound.h"

namespace animeme::speech {

/// Maximum length of a line, bytes.
inline constexpr std::size_t kMostPiece = std::size_t(64) << 20;
/// Maximum length of a piece, seconds.
inline constexpr double kMostPieceSeconds = 600;

/// Puts sound, times and text together that come in several messages. add() and forget() may be
/// called from other threads than make().
class PieceStream {
 public:
  /// `voice` speaks what is only text. `sample_rate`: Hz to which sound is converted, across the
  /// borders of its pieces; 0: it keeps its own.
  explicit PieceStream(const voice::VoiceOptions& voice, const ScriptInput& input = {},
                       int sample_rate = 0);
  ~PieceStream();

  /// What a message is for.
  struct Taken {
    std::uint64_t key = 0;        ///< for make() and forget(); 0: nothing of its own to say
    std::uint64_t utterance = 0;  ///< pieces of one have the same number; 0: none
    std::string text;             ///< what is said, if known
    std::string warning;          ///< a sentence; empty: none
  };
  /// Takes a message. Errors: syntax, with the column (invalid JSON, not an object, a member of a
  /// wrong type, invalid base64), invalid_argument (a sample rate or channels out of range, samples
  /// without a rate, nothing to say), those of media::read_audio(); out_of_range (longer than
  /// kMostPieceSeconds, nested more than 64 deep).
  Result<Taken> add(std::string_view json);
  /// Takes sound that came as samples, 1000..384000 Hz; `last`: its utterance ends. Without samples
  /// it has nothing to say. Errors: invalid_argument (the rate), out_of_range (longer than
  /// kMostPieceSeconds).
  Result<Taken> add_sound(const std::string& utterance, media::Pcm sound, bool last);
  /// From now on messages that name a file are errors (invalid_argument): they come from others.
  void refuse_files();
  /// The speech of a piece by what is known now; may be repeated, which is useful while
  /// SpokenLine::improvable is true and something was added to its utterance. Errors: not_found
  /// (forgotten); without sound those of time_sound() and voice::speak_text().
  Result<SpokenLine> make(std::uint64_t key);
  /// Only SpokenLine::words of a piece with sound. Errors: not_found.
  Result<SpokenLine> words(std::uint64_t key);
  /// Whether make() would know more than the last time.
  bool may_improve(std::uint64_t key);
  /// Whether times of its utterance came since the last make() or words().
  bool times_came(std::uint64_t key);
  /// A piece is no longer needed.
  void forget(std::uint64_t key);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Whether a JSON object has to do with sound, or with times of sound, and so is no line of text:
/// it has a sound or tells how it is stored, names an utterance, or holds times.
bool is_piece(std::string_view json);

/// The speech of one piece alone. Errors: those of PieceStream.
Result<SpokenLine> read_piece(std::string_view json, const voice::VoiceOptions& voice,
                              const ScriptInput& input = {});

/// Lines that are pieces, which join each other.
LineMaker piece_lines(const voice::VoiceOptions& voice, const ScriptInput& input = {});

}  // namespace animeme::speech
