/// @file
/// Speech pushed by another program: pieces of sound with words, phones or visemes, one line of
/// JSON each.
///
///     {"text": "Hello", "audio": "UklGR...", "words": [{"word": "Hello", "start": 0, "end": 0.4}]}
///     {"file": "two.wav", "script": "0 0.1 HH\n0.1 0.3 AY\n"}
///
/// Members, in any case, with or without "_":
///
/// - audio, audio_base64, audio_content, data: the sound, base64: a file (WAV, MP3, Ogg, FLAC ...),
///   or samples
/// - file, audio_file: the sound as the path of a file
/// - sample_rate: Hz of samples: 16 bits, little-endian, one channel
/// - encoding, format: of samples: s16le, pcm_s16le, linear16, or f32le, pcm_f32le; another name: a
///   file
/// - script: timings: text in any script format, or JSON of one
/// - text: what is said; without timings the sound is aligned with it
/// - language, lang: of the text
/// - id: its name in events (line_events.h); do, when, mood: see line_command.h
///
/// Without `script` the piece itself may be JSON of any format that scripts::read_labels() knows:
/// words with times, events of Azure, characters of ElevenLabs, visemes. Times count from the start
/// of the piece's sound. A piece with timings and without sound moves the face only. A piece with
/// only text is spoken by a synthetic voice.
#pragma once

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

/// The speech of one piece. Errors: syntax, with the column (invalid JSON, not an object, a member
/// of a wrong type, invalid base64), invalid_argument (a sample rate outside 1000..384000, an
/// unknown encoding), those of media::read_audio(), time_sound() and voice::speak_text();
/// out_of_range (longer than kMostPieceSeconds, nested more than 64 deep).
Result<SpokenLine> read_piece(std::string_view json, const voice::VoiceOptions& voice,
                              const ScriptInput& input = {});

/// Applies read_piece() to lines, which join each other.
LineMaker piece_lines(const voice::VoiceOptions& voice, const ScriptInput& input = {});

}  // namespace animeme::speech
