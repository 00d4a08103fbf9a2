/// @file
/// The fixed vocabulary of features that cases exercise: what a coverage table counts.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace animeme::conformance {

/// Features of one kind: "quant.0" .. "quant.31". The ids are the family's name, a dot, and a
/// member.
struct Family {
  std::string_view name;     ///< first part of the ids
  std::string_view title;    ///< for people
  std::string_view section;  ///< of codec/bitstream.md
  /// How certain the description is: 'C' proven on real streams and two codecs, 'S' read in the
  /// sources and proven on synthetic streams, 'M' from memory of the standard, 'T' tolerance that
  /// the standard does not ask for, '?' the standard's intention is unknown.
  char certainty;
  std::vector<std::string> members;  ///< second parts of the ids
};

/// All families, in the order of tables.
const std::vector<Family>& families();

/// The family of a feature id, null if the id is not in the vocabulary.
const Family* family_of(std::string_view feature);

/// Sections and the least certainty of some features.
std::vector<std::string> sections_of(std::span<const std::string> features);
/// The least of all of them, in the order C S M T ?.
char certainty_of(std::span<const std::string> features);

/// A number 0..99 as ids have it: "07".
inline std::string two_digits(int n) { return (n < 10 ? "0" : "") + std::to_string(n); }

/// Sorts ids into the order of the vocabulary and drops repeated ones.
void sort_features(std::vector<std::string>& features);

}  // namespace animeme::conformance
