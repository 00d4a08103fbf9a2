#include "fap/detail/text_parameters.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "fap/detail/real_text.h"
#include "fap/detail/text_order.h"

namespace animeme::fap::detail {
namespace {

constexpr int kLookAhead = 1024;  // tokens; more than any value line and a mask behind it

std::string plural(int count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace

bool ParameterReader::fail(Code code, std::string message, std::int64_t line, std::int64_t column) {
  error_ = error_at_line(code, std::move(message), line, column);
  return false;
}
bool ParameterReader::fail_at_token(Code code, std::string message) {
  return fail(code, std::move(message), scan_.line(), scan_.token_column());
}

bool ParameterReader::read_mask(std::span<std::uint8_t> mask) {
  const std::int64_t line = scan_.line();
  int flags = 0;
  while (flags < dialect_.flags) {
    const std::string_view token = scan_.token();
    if (token.empty()) {
      if (!continue_mask(flags, line)) return false;
    } else if (token == "1") {
      mask[std::size_t(flags++)] = 1;
    } else if (token == "0") {
      ++flags;
    } else {
      return fail_at_token(Code::syntax, "a mask value has to be 0 or 1, but " +
                                             std::string(dialect_.parameter) + " " +
                                             std::to_string(flags + 1) + " has " +
                                             in_quotes(token) + "; every frame starts with " +
                                             std::to_string(dialect_.flags) + " mask values");
    }
  }
  return true;
}

// The line ends after `flags` values: only a line that completes the mask may follow.
bool ParameterReader::continue_mask(int flags, std::int64_t line) {
  const std::int64_t column = scan_.column();
  const std::string message = "the mask has only " + std::to_string(flags) + " of " +
                              std::to_string(dialect_.flags) + " values";
  if (!scan_.to_content()) {
    return fail(Code::truncated, message + " and the text ends here", line, column);
  }
  if (flags + scan_.count_rest(kLookAhead) > dialect_.flags + 1) {
    return fail(Code::syntax, message, line, column);
  }
  notes_.add(Quirk::wrapped_mask, line, [] { return "a mask continues on the next line"; });
  return true;
}

// Goes to the frame number, wherever the writer has put it.
bool ParameterReader::find_values(const Needs& needs) {
  const std::int64_t line = scan_.line();
  const int rest = scan_.count_rest(kLookAhead);
  if (rest == 1 && (needs.full > 1 || tokens_of_next_line() == 1)) {
    const std::string_view extra = scan_.token();
    if (extra != "0" && extra != "1") {
      return fail_at_token(Code::syntax, "a mask has " + std::to_string(dialect_.flags) +
                                             " values, but " + in_quotes(extra) +
                                             " follows on the same line");
    }
    notes_.add(Quirk::extra_flag, line, [&] {
      return "a mask has " + std::to_string(dialect_.flags + 1) +
             " values, the last one is ignored";
    });
  } else if (rest > 0) {
    notes_.add(Quirk::one_line, line, [] { return "the values are on the line of the mask"; });
  }
  if (scan_.to_content()) return check_values(needs);
  return fail(Code::truncated,
              "the text ends after a mask, the frame number and " +
                  plural(needs.full - 1, "value") + " are missing",
              scan_.line());
}

int ParameterReader::tokens_of_next_line() const {
  TextScanner ahead = scan_;
  while (!ahead.token().empty()) {
  }
  return ahead.to_content() ? ahead.count_rest(kLookAhead) : 0;
}

// Decides by the number of tokens in the line how the values are written.
bool ParameterReader::check_values(const Needs& needs) {
  const int tokens = scan_.count_rest(kLookAhead);
  single_ = false;
  // More than a frame in one line: the next mask has to fit behind this one.
  if (tokens == needs.full || tokens >= needs.full + dialect_.flags) return true;
  const std::int64_t line = scan_.line();
  if (tokens > needs.full) {
    for (int i = 0; i <= needs.full; ++i) scan_.token();
    return fail_at_token(Code::syntax, "the line has " + plural(tokens - 1, "value") +
                                           " after the frame number, the mask requires " +
                                           std::to_string(needs.full - 1));
  }
  if (tokens == needs.single) {
    const int next = tokens_of_next_line();
    if (next == 0 || next >= dialect_.flags) {
      notes_.add(Quirk::single_high_level, line, [] {
        return "FAP 1 or 2 has a single value instead of 4 or 6, which is used as the selection";
      });
      return single_ = true;
    }
  }
  return check_wrapped_values(needs, tokens);
}

// Values may go on in further lines if they end where one of those ends.
bool ParameterReader::check_wrapped_values(const Needs& needs, int tokens) {
  const std::int64_t line = scan_.line();
  const auto refuse = [&](Code code, const TextScanner& line_end, std::string_view more) {
    return fail(code,
                "the line has " + plural(tokens - 1, "value") +
                    " after the frame number, the mask requires " + std::to_string(needs.full - 1) +
                    std::string(more),
                line, line_end.column());
  };
  TextScanner ahead = scan_;
  while (!ahead.token().empty()) {
  }
  const TextScanner line_end = ahead;
  for (int have = tokens; have < needs.full;) {
    if (!ahead.to_content()) return refuse(Code::truncated, line_end, " and the text ends here");
    const int next = ahead.count_rest(kLookAhead);
    if (next >= dialect_.flags || have + next > needs.full)
      return refuse(Code::syntax, line_end, "");
    have += next;
    while (!ahead.token().empty()) {
    }
  }
  notes_.add(Quirk::wrapped_values, line,
             [] { return "the values of a frame continue on the next line"; });
  return true;
}

std::string_view ParameterReader::next_token() {
  std::string_view token = scan_.token();
  if (token.empty() && scan_.to_content()) token = scan_.token();
  return token;
}

bool ParameterReader::value(std::int32_t& out) {
  const std::string_view token = next_token();
  const char* end = token.data() + token.size();
  const auto [stop, code] = std::from_chars(token.data(), end, out);
  if (code == std::errc() && stop == end) return true;
  double number = 0;
  if (!real(token, number)) return false;
  if (number < std::numeric_limits<std::int32_t>::min() ||
      number > std::numeric_limits<std::int32_t>::max()) {
    return fail_at_token(Code::out_of_range,
                         "the value " + in_quotes(token) + " does not fit 32 bits");
  }
  out = std::int32_t(number);
  return true;
}

bool ParameterReader::frame_number(std::int64_t& out) {
  const std::string_view token = next_token();
  double number = 0;
  if (!real(token, number)) return false;
  if (std::abs(number) > double(kLargestNumber)) {
    return fail_at_token(Code::out_of_range,
                         "the frame number " + in_quotes(token) + " is beyond 10^15");
  }
  out = std::int64_t(number);  // exact: far below 2^53
  number_line_ = scan_.line();
  return true;
}

// A number as people and programs write it, rounded to an integer.
bool ParameterReader::real(std::string_view token, double& out) {
  const char* begin = token.data();
  const char* end = begin + token.size();
  if (token.size() > 1 && *begin == '+' && begin[1] != '-') ++begin;
  const auto [stop, code] = read_real(begin, end, out);
  if (code == std::errc::result_out_of_range && stop == end) {
    out = 1e300;  // or tiny: both are no FAP values
  } else if (code != std::errc() || stop != end || !std::isfinite(out)) {
    return fail_at_token(Code::syntax, in_quotes(token) + " is not a number");
  }
  const double rounded = std::round(out);
  if (rounded != out) {
    notes_.add(Quirk::rounded, scan_.line(),
               [&] { return "the value " + in_quotes(token) + " is rounded to an integer"; });
  }
  out = rounded;
  return true;
}

}  // namespace animeme::fap::detail
