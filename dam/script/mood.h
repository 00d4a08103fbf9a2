/// @file
/// Moods by name: joy, sadness, anger, fear, disgust and surprise, as FAP 2 has them, and others
/// that are mixed from these or have a face of their own (dam/speaking/moods.h).
///
///     const auto mood = dam::read_mood("joy:0.6");
///     const auto style = dam::read_mood("cheerful");     // a style of Azure: joy, 0.8
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::dam {

/// A mood and how strong it is.
struct Mood {
  std::string name = "neutral";  ///< one of mood_names()
  double intensity = 1;          ///< 0 (none) to 1 (full)

  /// Nothing to show.
  bool neutral() const { return name == "neutral" || !(intensity > 0); }
  friend bool operator==(const Mood&, const Mood&) = default;
};

/// A stretch of time and its mood. Of spans that overlap the later one in a list counts, so that
/// inner elements of a document follow outer ones.
struct MoodSpan {
  double start = 0;          ///< seconds
  double end = 0;            ///< seconds, >= start
  std::optional<Mood> mood;  ///< nullopt: that of what is around it
  double gain = 1;           ///< multiplies the intensity of whatever mood is there, 0..2

  friend bool operator==(const MoodSpan&, const MoodSpan&) = default;
};

/// The moods, "neutral" first.
std::vector<std::string> mood_names();

/// Reads NAME or NAME:INTENSITY. A name is one of mood_names(), another word for one ("happy",
/// "tired"), a style of Azure's `mstts:express-as` ("cheerful", "terrified") or a preset of VRM
/// ("sorrow"), in any case, with blanks, "-" and "_" alike. Styles have an intensity of their own,
/// which the given one multiplies: "friendly:2" is up to 1. Errors: not_found (no such mood; the
/// message suggests one), invalid_argument (an intensity that is not a number from 0 to 2).
Result<Mood> read_mood(std::string_view text);

/// The same of a name and a factor for its intensity, 0..2.
Result<Mood> make_mood(std::string_view name, double intensity);

/// "joy:0.6"; "joy" for full intensity.
std::string mood_text(const Mood& mood);

}  // namespace animeme::dam
