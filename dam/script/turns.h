/// @file
/// Who speaks when: the turns of people who talk to each other, in RTTM as diarisers write it
/// (pyannote, NeMo, Kaldi), and the part of a script that one of them says.
///
///     auto turns = animeme::dam::read_rttm(text);
///     Script ann = animeme::dam::said_by(script, *turns, "Ann");
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dam/script/script.h"
#include "fap/result.h"

namespace animeme::dam {

/// A time in which a person speaks.
struct SpokenTurn {
  double start = 0;     ///< seconds
  double end = 0;       ///< seconds, above `start`
  std::string speaker;  ///< who, UTF-8

  friend bool operator==(const SpokenTurn&, const SpokenTurn&) = default;
};

/// Reads the SPEAKER lines of an RTTM file ("SPEAKER talk 1 0.50 2.25 <NA> <NA> Ann <NA> <NA>");
/// others are left out. Turns are in the order of time. Errors, with line and column: syntax (too
/// few fields, a time that is no number, a negative one), out_of_range (beyond kMaxScriptSeconds),
/// unsupported (several recordings), truncated (nobody speaks).
Result<std::vector<SpokenTurn>> read_rttm(std::string_view text);

/// The speakers of turns, each once, in the order in which they begin to speak.
std::vector<std::string> speakers_of(std::span<const SpokenTurn> turns);

/// Whether `speaker` speaks at a time: it is in one of their turns, or nearer to one than to those
/// of others.
bool speaks_at(std::span<const SpokenTurn> turns, double seconds, std::string_view speaker);

/// What `speaker` says of a script; the rest is silence, and it lasts as long. A word belongs to
/// those in whose turns its middle is, which may be several, else to whose turn is nearest; so do
/// phones without a word.
Script said_by(const Script& script, std::span<const SpokenTurn> turns, std::string_view speaker);

/// What several people say as one script: for captions, which are read one after the other. A phone
/// ends where the next one begins.
Script said_together(std::span<const Script> people);

}  // namespace animeme::dam
