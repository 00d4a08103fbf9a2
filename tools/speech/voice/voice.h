/// @file
/// Text to speech: sound with timed phones.
///
/// The voices are those of espeak-ng (about 130 languages and dialects). Its library is an optional
/// part of the build (ANIMEME_WITH_ESPEAK, Debian package libespeak-ng-dev) and licensed under
/// GPL-3: a program that links it must comply with that licence. Without it the functions return
/// Code::unsupported.
///
/// espeak-ng keeps state from one call to the next, so that the same text would sound different
/// the second time. It is therefore run in a forked child process: every call is independent of
/// all others, gives the same samples every time, may be made from several threads at once, and
/// cannot take the program down. Source: tools/speech/voice/engines.md, section 2.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/mood.h"
#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/media/pcm.h"

/// Text to speech and forced alignment.
namespace animeme::voice {

/// Voice and prosody.
struct VoiceOptions {
  /// A language ("en", "de", "pt-br"), an espeak-ng voice name ("English (Scotland)") or identifier
  /// ("gmw/en-US"), in any case; "+f3" and the like select a variant. "en" is "en-us". An
  /// unavailable region falls back to its language ("de-at" to "de"). Further languages after a +
  /// speak passages in their scripts: "zh+en", "en+ru+f3" (languages take precedence over
  /// variants). "auto": by script, and if that is ambiguous, by the locale of the environment
  /// (LC_ALL, LC_MESSAGES, LANG), else "en".
  std::string language = "en";
  int words_per_minute = 175;  ///< 80..450
  int pitch = 50;              ///< 0..100
  int pitch_range = 50;        ///< 0..100; 0 is monotone
  int word_gap = 0;            ///< 0..100, extra pause between words in units of 10 ms
  double lead_silence = 0.25;  ///< seconds before the first sound, 0..10: time to open the mouth
  double tail_silence = 0.4;   ///< seconds after the last sound, 0..10: time to close it
  /// Folder that contains espeak-ng-data; empty: the library's default.
  std::string data_path;
};

/// A part of speech spoken by one voice in one language.
struct SpokenLanguage {
  /// when, in seconds
  double start = 0, end = 0;  ///< seconds
  std::string language;       ///< "en-us", "cmn-latn-pinyin"
  std::string voice;  ///< its name; if a voice itself switches the language for words, the name of
                      ///< that voice
  std::string text;   ///< its text as written
  /// The voice switched by itself, for words that it cannot read.
  bool by_itself = false;
};

/// A mark of an SSML document, `mark name="..."`.
struct SpeechMark {
  double time = 0;   ///< seconds
  std::string name;  ///< as in the document
};

/// Receives sound while it is made. An error of either function ends the work.
struct SoundSink {
  /// The sound begins; what came before it is void, as another process speaks the text again.
  std::function<Result<void>(int sample_rate)> begin;
  std::function<Result<void>(std::span<const float> samples)> take;  ///< the next samples, +-1
};

/// Result of speak_text(). The script begins at 0 and ends with the audio; its first and last
/// phones are SIL (unless that silence is 0). Phone::word is set.
struct Speech {
  media::Pcm audio;    ///< 22050 Hz with the voices of espeak-ng 1.51; no samples with a SoundSink
  dam::Script script;  ///< phones and words of the sound
  std::string voice;   ///< name of the voice, or of the first one: "English (America)"
  std::vector<SpokenLanguage> languages;  ///< ascending; at least one
  std::vector<SpeechMark> marks;          ///< of SSML, ascending
  std::vector<dam::MoodSpan> moods;       ///< of SSML, emoji and exclamation marks
  std::vector<std::string> warnings;  ///< about skipped or spelled words, sentences for the user
};

/// Speaks UTF-8 text, plain or SSML (detected by content, tools/speech/text/ssml.h). Dates,
/// amounts, and Chinese and Japanese characters are normalised (tools/speech/text). Words of the
/// script are as written.
///
/// Breaks of SSML in front of all words and behind them lengthen the silence there.
///
/// Letters of a script that no selected voice reads are an error, which suggests a voice. Words
/// that a voice reads in another language, or spells, are reported in `languages` and `warnings`.
///
/// A stop begins at its closure, not at its burst: the silence before it is taken from the previous
/// phone. A phone with an unknown IPA letter becomes AX.
/// Errors: invalid_argument (text without anything to say, or an option out of range), out_of_range
/// (more than 100000 characters or an hour of sound: speak it in parts), not_found (no such voice,
/// with suggestions; no voices at data_path; no Japanese dictionary), syntax with line and column
/// (SSML that is not well formed), unsupported (built without espeak-ng, or SSML without expat), io
/// (the child process could not be started, or espeak-ng failed, e.g. without its data).
///
/// With both functions of `sink` the sound goes there, and memory grows with the text alone: half
/// an hour of sound is 160 MB in Speech::audio.
Result<Speech> speak_text(std::string_view text, const VoiceOptions& options = {},
                          const SoundSink& sink = {});

/// An installed voice.
struct VoiceInfo {
  std::string name;                          ///< "English (America)"
  std::string language;                      ///< "en-us"
  std::string identifier;                    ///< "gmw/en-US"
  std::vector<std::string> other_languages;  ///< further codes that select it
};

/// All voices, by language, without those that need MBROLA data.
/// Errors: unsupported, io, not_found; see speak_text().
Result<std::vector<VoiceInfo>> list_voices(const std::string& data_path = {});

/// From now on a process with the loaded voice is kept for each of the last 32 voices, and a fork
/// of it speaks each text: faster, with the same sound. These processes are forks of the program in
/// its current state, so a large program should call this early, in a thread that lives on. For
/// programs that speak a lot in one thread.
void keep_voices();

/// Converts letters to phones: the ARPAbet labels of each text, spoken separately, without SIL, or,
/// with `mark_words`, with one SIL between two words. An empty entry means that the voice says
/// nothing. Chinese and Japanese words may be in characters. Errors as speak_text().
Result<std::vector<std::vector<std::string>>> pronounce(const std::vector<std::string>& texts,
                                                        const VoiceOptions& options = {},
                                                        bool mark_words = false);

}  // namespace animeme::voice
