/// @file
/// SSML 1.1, the W3C's markup of text that is to be spoken, as a row of texts, pauses and marks.
///
/// Read with expat (Debian package libexpat1-dev), an optional part of the build
/// (ANIMEME_WITH_EXPAT). Documents that declare entities of their own are refused, so that none can
/// grow. https://www.w3.org/TR/speech-synthesis11/
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::text {

/// How a part is spoken: in percent of what the options of the voice say.
struct Manner {
  std::string language;  ///< xml:lang of it; empty: as asked for
  std::string voice;     ///< name or variant ("f3") of a voice; empty: that of the language
  int rate = 100;        ///< 20..400
  int pitch = 100;       ///< 20..300
  int range = 100;       ///< of the pitch, 0..300
  int volume = 100;      ///< 0..200
  friend bool operator==(const Manner&, const Manner&) = default;
};

/// What a part is.
enum class ItemKind : std::uint8_t {
  text,   ///< words
  pause,  ///< silence, also the ends of paragraphs and sentences
  mark,   ///< a place with a name
};

/// How text is read.
enum class SayAs : std::uint8_t { words, characters, digits, telephone, ordinal, date };

/// A part of a document.
struct Item {
  /// which of the three it is
  ItemKind kind = ItemKind::text;
  std::u32string text;   ///< as it stands in the document, blanks as they are
  std::u32string alias;  ///< said instead, by `sub`; empty: nothing
  std::string ipa;       ///< of `phoneme`; empty: nothing
  /// how its text is read
  SayAs say_as = SayAs::words;
  std::string format;  ///< of a date: "dmy"
  /// how it is spoken
  Manner manner;
  double seconds = 0;  ///< of a pause, 0..10
  std::string name;    ///< of a mark
};

/// What read_ssml() found.
struct Document {
  std::vector<Item> items;            ///< in order
  std::vector<std::string> warnings;  ///< what is not known or left out, each once
};

/// True if a text claims to be SSML: its first element is `speak`, also behind an XML declaration.
bool is_ssml(std::string_view text);

/// The deepest nesting that is read.
inline constexpr int kMostDepth = 64;

/// Reads a document in UTF-8. Known: speak, p, s, break, prosody (rate, pitch, range, volume),
/// emphasis, voice (name, gender, xml:lang), lang, mark, sub, phoneme (IPA), say-as (characters,
/// digits, telephone, ordinal, cardinal, date, time ...), w and token; xml:lang everywhere. What is
/// else in it is spoken as if it were not marked, audio by its text, and named in the warnings.
///
/// Errors: syntax with line and column (XML that is not well formed, a root other than speak,
/// entities that the document declares, deeper than kMostDepth), unsupported (built without expat).
Result<Document> read_ssml(std::string_view text);

}  // namespace animeme::text
