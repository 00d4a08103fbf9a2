/// @file
/// Text on its way to a voice, with the place in the text of the user that each character stands
/// for: "12/05/2024" is spoken as "May 12, 2024", and the words of the script are what was written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::text {

/// Characters of the text as it was written, counted in code points.
struct Place {
  std::uint32_t first = 0;  ///< from 0
  std::uint32_t last = 0;   ///< one behind
  friend bool operator==(const Place&, const Place&) = default;
};

/// What is said for a text. Both have the same length.
struct Said {
  /// characters
  std::u32string text;
  /// of each character
  std::vector<Place> places;

  /// Count of characters.
  std::size_t size() const { return text.size(); }
  /// Adds characters that all stand for `place`.
  void add(std::u32string_view more, Place place);
  /// Adds characters of another one with their places.
  void add(const Said& other, std::size_t first, std::size_t last);
  /// What characters first..last stand for, all together; first < last <= size().
  Place place(std::size_t first, std::size_t last) const;
  /// A part.
  Said part(std::size_t first, std::size_t last) const;
};

/// Each character stands for itself; the first one is number `first` of the text.
Said as_written(std::u32string_view text, std::size_t first = 0);

/// UTF-8 to code points. Invalid bytes become U+FFFD.
std::u32string code_points(std::string_view utf8);
/// Code points to UTF-8.
std::string utf8(std::u32string_view text);

}  // namespace animeme::text
