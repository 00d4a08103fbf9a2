/// @file
/// A performance that is kept under new speech: options of speak and stream.
#pragma once

#include <memory>
#include <string>

#include "dam/performance/over_speech.h"
#include "fap/result.h"

namespace animeme::tools {

struct OptionTable;

/// What was asked for.
struct OverChoice {
  std::string path;              ///< --over; empty: no performance
  std::string keep;              ///< --keep, as it was written
  double bend = dam::kMostBend;  ///< --bend
};

/// Adds --over, --keep and, with `bends`, --bend.
void add_over_options(OptionTable& cli, OverChoice& choice, bool bends);

/// Reads a list of shares such as "lips=0.5,brows=0". Groups are those of edit: parts of the face
/// (fap::regions()), all (but jaw and tongue), FAPs. Errors: invalid_argument.
Result<dam::KeptShares> parse_kept_shares(const std::string& text);

/// Reads a performance: any file with a face, as other commands do; what is said in it from the
/// words and phones of a container. Errors: those of read_face(), shown_face() and
/// Performance::make().
Result<dam::Performance> read_performance(const std::string& path);

/// Reads what was chosen; `over` stays null without --over. Errors: those of parse_kept_shares()
/// and read_performance().
Result<void> read_over(const OverChoice& choice, std::shared_ptr<const dam::Performance>& over,
                       dam::KeptShares& keep);

}  // namespace animeme::tools
