/// @file
/// SSML 1.1, the W3C's Speech Synthesis Markup Language, as a sequence of texts, pauses and marks.
///
/// Read with expat (Debian package libexpat1-dev), an optional part of the build
/// (ANIMEME_WITH_EXPAT). Documents that declare entities are rejected, to prevent entity expansion
/// attacks. https://www.w3.org/TR/speech-synthesis11/
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/mood.h"
#include "fap/result.h"

namespace animeme::text {

/// Prosody of a part, in percent of the voice's options.
struct Manner {
  std::string language;  ///< xml:lang; empty: the default
  std::string voice;     ///< name or variant ("f3") of a voice; empty: default of the language
  int rate = 100;        ///< 20..400
  int pitch = 100;       ///< 20..300
  int range = 100;       ///< of the pitch, 0..300
  int volume = 100;      ///< 0..200
  friend bool operator==(const Manner&, const Manner&) = default;
};

/// Kind of a part.
enum class ItemKind : std::uint8_t {
  text,   ///< words
  pause,  ///< silence, also the ends of paragraphs and sentences
  mark,   ///< a named position
};

/// How text is read.
enum class SayAs : std::uint8_t { words, characters, digits, telephone, ordinal, date };

/// A part of a document.
struct Item {
  /// kind of the part
  ItemKind kind = ItemKind::text;
  std::u32string text;   ///< as in the document, including blanks
  std::u32string alias;  ///< replacement by `sub`; empty: none
  std::string ipa;       ///< of `phoneme`; empty: none
  /// interpretation of the text
  SayAs say_as = SayAs::words;
  std::string format;  ///< of a date: "dmy"
  /// prosody
  Manner manner;
  std::optional<dam::Mood> mood;  ///< of mstts:express-as and the like
  double mood_gain = 1;           ///< of emphasis: multiplies the intensity of any mood
  double seconds = 0;             ///< of a pause, 0..10
  bool is_break = false;          ///< the pause is a break, not the end of a sentence or paragraph
  std::string name;               ///< of a mark
};

/// Result of read_ssml().
struct Document {
  std::vector<Item> items;            ///< in order
  std::vector<std::string> warnings;  ///< unknown or unsupported elements, each once
};

/// Whether a text is SSML: its first element is `speak`, possibly after an XML declaration.
bool is_ssml(std::string_view text);

/// Maximum nesting.
inline constexpr int kMostDepth = 64;

/// Reads a document in UTF-8. Supported: speak, p, s, break, prosody (rate, pitch, range, volume),
/// emphasis, voice (name, gender, xml:lang), lang, mark, sub, phoneme (IPA), say-as (characters,
/// digits, telephone, ordinal, cardinal, date, time ...), w and token; xml:lang everywhere. For the
/// face: mstts:express-as (style, styledegree: names of dam::read_mood()), amazon:emotion (name,
/// intensity), google:style (name); emphasis changes the intensity of a mood, too. Other elements
/// are reported in the warnings and their text is spoken, including the text of audio.
///
/// Errors: syntax with line and column (XML that is not well formed, a root other than speak,
/// entities that the document declares, deeper than kMostDepth), unsupported (built without expat).
Result<Document> read_ssml(std::string_view text);

}  // namespace animeme::text
