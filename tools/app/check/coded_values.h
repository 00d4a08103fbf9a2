/// @file
/// The coded values of a face or body clip, and their comparison.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "codec/text/bap_text.h"
#include "fap/frame.h"

namespace animeme::tools {

/// One frame: values by key, ascending. The key of FAP or BAP n is 8n, plus the component for FAP 1
/// and 2, see key_name().
struct CodedFrame {
  std::int64_t number = 0;                           ///< running number at the clip's rate
  std::vector<std::pair<int, std::int64_t>> values;  ///< ascending keys
};

/// Either kind of motion in one form.
struct CodedClip {
  bool body = false;               ///< keys are those of BAPs
  fap::Rate rate;                  ///< frames a second
  std::vector<CodedFrame> frames;  ///< ascending numbers
};
CodedClip coded_values(const fap::Sequence& clip);      ///< values of present FAPs
CodedClip coded_values(const fba::BodySequence& clip);  ///< values of present BAPs

/// "FAP 5 raise_b_midlip", "FAP 1 viseme_blend", "BAP 17".
std::string key_name(bool body, int key);

/// The first wrong coded value.
struct FirstDifference {
  std::int64_t frame = -1;    ///< frame number in the expected clip
  std::string parameter;      ///< key_name()
  std::int64_t expected = 0;  ///< value of the case
  bool missing = false;       ///< the value is missing
  std::int64_t got = 0;       ///< value of the decoder, unless missing
};

/// Result of a comparison.
struct Comparison {
  bool right = false;  ///< every coded value is present and correct
  bool exact = false;  ///< and also masks, frame numbers and rate
  std::string text;    ///< why not right, or why not exact; one sentence without a full stop
  FirstDifference difference;  ///< parameter is empty if whole frames are missing
};

/// Frames are paired in order if their number is as expected, else by frame number. Additional
/// frames are correct if they fill gaps in the numbers, or repeat the last frame.
Comparison compare(const CodedClip& expected, const CodedClip& got);

/// Whether `got` is a prefix of `expected` with correct values; it may be empty.
bool is_beginning(const CodedClip& expected, const CodedClip& got);

}  // namespace animeme::tools
