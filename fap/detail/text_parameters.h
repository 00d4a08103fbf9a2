// The parts of a frame that FAP text and BAP text have in common: a mask, a frame number and
// integers, wherever a writer has put the line ends. Internal.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "fap/detail/text_dialect.h"
#include "fap/detail/text_notes.h"
#include "fap/detail/text_scanner.h"
#include "fap/result.h"

namespace animeme::fap::detail {

/// Reads in order: read_mask(), find_values(), frame_number(), then value() as often as the mask
/// says. Each returns false on a failure, which error() then holds.
class ParameterReader {
 public:
  /// How many tokens the number and the values of a frame are.
  struct Needs {
    int full = 1;
    int single = 1;  ///< with one value each for FAP 1 and 2, as Greta (Java) writes them
  };

  ParameterReader(const TextDialect& dialect, TextScanner& scanner, TextNotes& notes)
      : dialect_(dialect), scan_(scanner), notes_(notes) {}

  /// mask[n] = 1 if parameter n + 1 is present; dialect.flags values, all 0 before.
  bool read_mask(std::span<std::uint8_t> mask);
  /// Goes to the frame number and makes sure that enough values follow it.
  bool find_values(const Needs& needs);
  bool frame_number(std::int64_t& out);
  bool value(std::int32_t& out);

  /// True behind find_values() if FAP 1 and 2 have one value each.
  bool single() const { return single_; }
  /// Line of the frame number.
  std::int64_t number_line() const { return number_line_; }
  std::int64_t line() const { return scan_.line(); }
  TextNotes& notes() { return notes_; }
  Error error() && { return std::move(error_); }

 private:
  bool fail(Code code, std::string message, std::int64_t line, std::int64_t column = 0);
  bool fail_at_token(Code code, std::string message);
  bool continue_mask(int flags, std::int64_t line);
  int tokens_of_next_line() const;
  bool check_values(const Needs& needs);
  bool check_wrapped_values(const Needs& needs, int tokens);
  std::string_view next_token();
  bool real(std::string_view token, double& out);

  const TextDialect& dialect_;
  TextScanner& scan_;
  TextNotes& notes_;
  bool single_ = false;
  std::int64_t number_line_ = 0;
  Error error_;
};

}  // namespace animeme::fap::detail
