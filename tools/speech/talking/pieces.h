/// @file
/// Speech that another program makes and pushes: pieces of sound with their words, phones or
/// visemes, a line of JSON each.
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
/// - script: times: a text in any format of scripts, or JSON of one
/// - text: what is said; where there are no times the sound is aligned with it
/// - language, lang: of the text
/// - id: its name in what is told of it (line_events.h); do, when: see line_command.h
///
/// Without `script` the piece itself may be JSON of any format that scripts::read_labels() knows:
/// words with times, events of Azure, characters of ElevenLabs, visemes. Times count from the begin
/// of the piece's sound. A piece with times and without sound moves the face alone. A piece with
/// text alone is spoken by a synthetic voice.
#pragma once

#include <string>
#include <string_view>

#include "fap/result.h"
#include "tools/speech/talking/lines.h"
#include "tools/speech/talking/timed_sound.h"

namespace animeme::speech {

/// Bytes of the longest line.
inline constexpr std::size_t kMostPiece = std::size_t(64) << 20;
/// Seconds of the longest piece.
inline constexpr double kMostPieceSeconds = 600;

/// The speech of one piece. Errors: syntax, with the column (no JSON, no object, a member of
/// another kind, no base64), invalid_argument (a sample rate outside 1000..384000, an encoding that
/// is not known), those of media::read_audio(), time_sound() and voice::speak_text(); out_of_range
/// (longer than kMostPieceSeconds, nested more than 64 deep).
Result<SpokenLine> read_piece(std::string_view json, const voice::VoiceOptions& voice,
                              const ScriptInput& input = {});

/// read_piece() of lines as they come. Lines join each other.
LineMaker piece_lines(const voice::VoiceOptions& voice, const ScriptInput& input = {});

}  // namespace animeme::speech
