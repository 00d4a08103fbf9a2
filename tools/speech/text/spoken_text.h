/// @file
/// Text prepared for a voice, in which each character keeps its position in the user's text:
/// "12/05/2024" is spoken as "May 12, 2024", but the script has the words as written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// A range of the text as written, in code points.
struct Place {
  std::uint32_t first = 0;  ///< from 0
  std::uint32_t last = 0;   ///< one behind
  friend bool operator==(const Place&, const Place&) = default;
};

/// Spoken text. Both members have the same length.
struct SpokenText {
  /// characters
  std::u32string text;
  /// of each character
  std::vector<Place> places;

  /// Number of characters.
  std::size_t size() const { return text.size(); }
  /// Appends characters, all with position `place`.
  void add(std::u32string_view more, Place place);
  /// Appends characters of another text with their positions.
  void add(const SpokenText& other, std::size_t first, std::size_t last);
  /// The combined position of characters first..last; first < last <= size().
  Place place(std::size_t first, std::size_t last) const;
  /// A part.
  SpokenText part(std::size_t first, std::size_t last) const;
};

/// Unchanged text; its first character has position `first`.
SpokenText as_written(std::u32string_view text, std::size_t first = 0);

/// UTF-8 to code points. Invalid bytes become U+FFFD.
std::u32string code_points(std::string_view utf8);
/// Code points to UTF-8.
std::string utf8(std::u32string_view text);

}  // namespace animeme::text
