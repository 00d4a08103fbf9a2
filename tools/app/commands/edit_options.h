/// @file
/// The options of edit that have a text of their own: times, pieces, parts of the face.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/rate.h"
#include "fap/result.h"

namespace animeme::tools {

struct OptionTable;

/// A point of a clip, in seconds or frames.
struct EditTime {
  double value = 0;     ///< >= 0
  bool frames = false;  ///< it is a number of frames

  /// The nearest frame.
  std::int64_t frame(fap::Rate rate) const;
};

/// "12.5", "1:02.5", "0:01:02.5" (seconds), or "375f" (frames). Errors: invalid_argument.
Result<EditTime> parse_edit_time(const std::string& text);

/// A piece of a clip. No end: up to its end.
struct EditPiece {
  EditTime from;               ///< its begin
  std::optional<EditTime> to;  ///< its end; nullopt: that of the clip
};

/// "FROM-TO", "FROM-" or "-TO". Errors: invalid_argument, as parse_edit_time(); an end that does
/// not come after its begin.
Result<EditPiece> parse_edit_piece(const std::string& text);

/// --from and --to.
struct EditSpan {
  std::string from;  ///< as it was given; empty: the begin
  std::string to;    ///< likewise; empty: the end

  bool given() const { return !from.empty() || !to.empty(); }  ///< one of them
  /// Errors: those of parse_edit_piece().
  Result<EditPiece> piece() const { return parse_edit_piece(from + "-" + to); }
};
/// Adds both.
void add_span_options(OptionTable& cli, EditSpan& span);

/// FAPs of a part of the face: a region ("lips"), a FAP or range ("open_jaw", "31-38"), "all".
/// Errors: invalid_argument.
Result<fap::Mask> parse_edit_faps(const std::string& name);

/// A part of the face and a number: "brows=1.4"; without a name of all FAPs.
struct EditAmount {
  fap::Mask faps;    ///< the part
  double value = 0;  ///< factor or seconds, >= 0
};
/// Errors: invalid_argument (no number, or one that is negative).
Result<EditAmount> parse_edit_amount(const std::string& text);

/// Where a part of the face, the body or the rest comes from: "lips=a.fba".
struct EditTake {
  /// A part of the face, the body, or what no other part names.
  enum class What : std::uint8_t { face, body, rest };
  What what = What::face;  ///< what is taken
  fap::Mask faps;          ///< of What::face
  std::string path;        ///< of the file
};
/// Errors: invalid_argument.
Result<EditTake> parse_edit_take(const std::string& text);

}  // namespace animeme::tools
