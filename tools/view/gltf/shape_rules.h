/// @file
/// What morph targets with names of a user's own mean.
///
///     auto rule = animeme::gltf::parse_shape_rule("Mund_auf=jawOpen");
///     animeme::gltf::ReadOptions options;
///     options.rules.push_back(*rule);
///
/// A meaning is any name that meaning_of() knows (shape_names.h): a shape of ARKit (jawOpen, also
/// one half, mouthSmile_L, or both sides, mouthSmile), a viseme (viseme_PP, aa), a mood (joy).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fap/result.h"

namespace animeme::gltf {

/// A name and its meaning.
struct ShapeRule {
  std::string name;     ///< of the morph target; case and surrounding blanks do not count
  std::string meaning;  ///< see above; "-": the shape stays at rest
};

/// Rules; the first one for a name applies.
using ShapeRules = std::vector<ShapeRule>;

/// "NAME=MEANING"; the last "=" counts. Errors: syntax (no name, no meaning), invalid_argument (an
/// unknown meaning).
Result<ShapeRule> parse_shape_rule(std::string_view text);

/// Reads a table with one rule per line: "shape,meaning", also separated by semicolons or tabs.
/// Empty lines and lines that begin with # are ignored, as is a first line that begins with
/// "shape,". Errors, with the line: those of parse_shape_rule(); truncated (no rule).
Result<ShapeRules> read_shape_rules(std::string_view text);

/// Rules as options give them: each of `texts` by parse_shape_rule(), then those of the file `path`
/// (empty: none). Errors: those of the functions above and of reading the file, with its path.
Result<ShapeRules> shape_rules_of(const std::vector<std::string>& texts, const std::string& path);

/// The rule for a name, nullptr: none.
const ShapeRule* find_rule(const ShapeRules& rules, std::string_view name);

/// Checks rules against the names of a file. Errors: not_found (a rule for a name that the file
/// does not have; the message lists those that it has).
Result<void> check_rules(const ShapeRules& rules, const std::vector<std::string>& names);

}  // namespace animeme::gltf
