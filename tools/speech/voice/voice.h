/// @file
/// Text to speech with timed phones: the sound and the script that describes it, from one source.
///
/// The voices are those of espeak-ng (about 130 languages and dialects). Its library is an
/// optional part of the build (ANIMEME_WITH_ESPEAK, Debian package libespeak-ng-dev) and licensed
/// under GPL-3: a program that links this part with it has to respect that licence. Without it the
/// functions exist and return Code::unsupported.
///
/// espeak-ng keeps state from one call to the next, so that the same text would sound different
/// the second time. It is therefore run in a forked child process: every call is independent of
/// all others, gives the same samples every time, may be made from several threads at once, and
/// cannot take the program down. Source: tools/speech/voice/engines.md, section 2.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"
#include "tools/formats/media/pcm.h"

/// Text to speech and forced alignment.
namespace animeme::voice {

/// Who speaks, and how.
struct VoiceOptions {
  /// A language ("en", "de", "pt-br"), an espeak-ng voice name ("English (Scotland)") or
  /// identifier ("gmw/en-US"), in any case; "+f3" and the like select a variant. "en" is "en-us".
  /// A region that is not there falls back to its language ("de-at" to "de"). Further languages
  /// behind a + speak the passages in their scripts: "zh+en", "en+ru+f3" (what is a language is no
  /// variant). "auto": by script, and where that does not tell, by the locale of the environment
  /// (LC_ALL, LC_MESSAGES, LANG), else "en".
  std::string language = "en";
  int words_per_minute = 175;  ///< 80..450
  int pitch = 50;              ///< 0..100
  int pitch_range = 50;        ///< 0..100; 0 is monotone
  int word_gap = 0;            ///< 0..100, extra pause between words in units of 10 ms
  double lead_silence = 0.25;  ///< seconds before the first sound, 0..10: time to open the mouth
  double tail_silence = 0.4;   ///< seconds after the last sound, 0..10: time to close it
  /// Folder that contains espeak-ng-data; empty: the one that the library was built for.
  std::string data_path;
};

/// A part of speech that one voice speaks in one language.
struct SpokenLanguage {
  /// when, in seconds
  double start = 0, end = 0;  ///< seconds
  std::string language;       ///< "en-us", "cmn-latn-pinyin"
  std::string voice;  ///< its name; for words that a voice itself takes as another language,
                      ///< the name of that voice
  std::string text;   ///< what it speaks, as it was written
  /// The voice changed by itself, which it does for words that it does not know how to read.
  bool by_itself = false;
};

/// A place of an SSML document, `mark name="..."`.
struct SpeechMark {
  double time = 0;   ///< seconds
  std::string name;  ///< as in the document
};

/// What speak_text() makes. The script begins at 0 and ends with the audio; its first and last
/// phones are SIL (unless a silence of 0 was asked for). Phone::word is filled.
struct Speech {
  media::Pcm audio;    ///< 22050 Hz with the voices of espeak-ng 1.51
  dam::Script script;  ///< phones and words of the sound
  std::string voice;   ///< name of the voice that spoke, the first of several: "English (America)"
  std::vector<SpokenLanguage> languages;  ///< ascending; at least one
  std::vector<SpeechMark> marks;          ///< of SSML, ascending
  std::vector<std::string> warnings;      ///< what was left out or spelled, sentences for people
};

/// Speaks UTF-8 text: plain, or an SSML document, told by its content (tools/speech/text/ssml.h).
/// What is written is read as people say it: dates, amounts, characters of Chinese and Japanese
/// (tools/speech/text). Words of the script are as they were written.
///
/// Letters of a script that no chosen voice reads are an error, which names the voice to take.
/// Words that a voice takes for another language, or spells, are told by `languages` and
/// `warnings`.
///
/// A stop begins at its closure, not at its burst: the silence before it is taken from the phone
/// before. A sound whose IPA letter is unknown becomes AX.
/// Errors: invalid_argument (text without anything to say, or an option out of range),
/// out_of_range (more than 100000 characters or an hour of sound: speak it in parts), not_found
/// (no such voice, the nearest ones are named; no voices at data_path; a dictionary of Japanese),
/// syntax with line and column (SSML that is not well formed), unsupported (built without
/// espeak-ng, or SSML without expat), io (the child process could not be started, or espeak-ng
/// failed, e.g. without its data).
Result<Speech> speak_text(std::string_view text, const VoiceOptions& options = {});

/// An installed voice.
struct VoiceInfo {
  std::string name;                          ///< "English (America)"
  std::string language;                      ///< "en-us"
  std::string identifier;                    ///< "gmw/en-US"
  std::vector<std::string> other_languages;  ///< further codes that select it
};

/// All voices, by language. Voices that need MBROLA data are left out.
/// Errors: unsupported, io, not_found; see speak_text().
Result<std::vector<VoiceInfo>> list_voices(const std::string& data_path = {});

/// From now on a process stays for each of the last 32 voices that have spoken, loaded, and each
/// text is spoken by a copy of it: the same sound, sooner. They begin as copies of what the program
/// is now, so that a large one does well to call it early, in a thread that stays. For programs
/// with one thread that speaks a lot.
void keep_voices();

/// Letters to phones: the ARPAbet labels of each text, spoken by itself, without SIL. An empty
/// entry is a text that the voice says nothing for. Chinese and Japanese words may be characters.
/// Errors as speak_text().
Result<std::vector<std::vector<std::string>>> pronounce(const std::vector<std::string>& texts,
                                                        const VoiceOptions& options = {});

}  // namespace animeme::voice
