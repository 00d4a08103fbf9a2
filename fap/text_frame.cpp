#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fap/detail/text_frame.h"

namespace animeme::fap::detail {
namespace {

constexpr int kVisemeValues = 4;
constexpr int kExpressionValues = 6;
constexpr int kLookAhead = 512;  // tokens; more than any value line and a mask behind it

// How many tokens the number and the values of a frame are.
struct Needs {
  int full = 1;
  int single = 1;  // with one value each for FAP 1 and 2, as Greta (Java) writes them

  explicit Needs(const Mask& mask) {
    const int high = int(mask[1]) + int(mask[2]);
    const int low = int(mask.count()) - high;
    full += low + (mask[1] ? kVisemeValues : 0) + (mask[2] ? kExpressionValues : 0);
    single += low + high;
  }
};

std::string plural(int count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

class FrameReader {
 public:
  FrameReader(TextScanner& scanner, TextNotes& notes) : scan_(scanner), notes_(notes) {}

  Result<std::int64_t> read(Frame& frame) {
    const bool ok = read_mask(frame.mask) && find_values(Needs(frame.mask)) && read_values(frame);
    if (!ok) return std::move(error_);
    return number_line_;
  }

 private:
  bool fail(Code code, std::string message, std::int64_t line, std::int64_t column = 0) {
    error_ = error_at_line(code, std::move(message), line, column);
    return false;
  }
  bool fail_at_token(Code code, std::string message) {
    return fail(code, std::move(message), scan_.line(), scan_.token_column());
  }

  bool read_mask(Mask& mask) {
    const std::int64_t line = scan_.line();
    int flags = 0;
    while (flags < kFapCount) {
      const std::string_view token = scan_.token();
      if (token.empty()) {
        if (!continue_mask(flags, line)) return false;
      } else if (token == "1") {
        mask.set(std::size_t(++flags));
      } else if (token == "0") {
        ++flags;
      } else {
        return fail_at_token(Code::syntax, "a mask value has to be 0 or 1, but FAP " +
                                               std::to_string(flags + 1) + " has " + quoted(token) +
                                               "; every frame starts with 68 mask values");
      }
    }
    return true;
  }

  // The line ends after `flags` values: only a line that completes the mask may follow.
  bool continue_mask(int flags, std::int64_t line) {
    const std::int64_t column = scan_.column();
    const std::string message = "the mask has only " + std::to_string(flags) + " of 68 values";
    if (!scan_.to_content()) {
      return fail(Code::truncated, message + " and the text ends here", line, column);
    }
    if (flags + scan_.count_rest(kLookAhead) > kFapCount + 1) {
      return fail(Code::syntax, message, line, column);
    }
    notes_.add(Quirk::wrapped_mask, line, [] { return "a mask goes on in the next line"; });
    return true;
  }

  // Goes to the frame number, wherever the writer has put it.
  bool find_values(const Needs& needs) {
    const std::int64_t line = scan_.line();
    const int rest = scan_.count_rest(kLookAhead);
    if (rest == 1 && (needs.full > 1 || tokens_of_next_line() == 1)) {
      const std::string_view extra = scan_.token();
      if (extra != "0" && extra != "1") {
        return fail_at_token(Code::syntax, "a mask has 68 values, but " + quoted(extra) +
                                               " follows in the same line");
      }
      notes_.add(Quirk::extra_flag, line,
                 [] { return "a mask has 69 values, the last one is ignored"; });
    } else if (rest > 0) {
      notes_.add(Quirk::one_line, line, [] { return "the values follow in the line of the mask"; });
    }
    if (scan_.to_content()) return check_values(needs);
    return fail(Code::truncated,
                "the text ends after a mask, the frame number and " +
                    plural(needs.full - 1, "value") + " are missing",
                scan_.line());
  }

  int tokens_of_next_line() const {
    TextScanner ahead = scan_;
    while (!ahead.token().empty()) {
    }
    return ahead.to_content() ? ahead.count_rest(kLookAhead) : 0;
  }

  // Decides by the number of tokens in the line how the values are written.
  bool check_values(const Needs& needs) {
    const int tokens = scan_.count_rest(kLookAhead);
    single_ = false;
    // More than a frame in one line: the next mask has to fit behind this one.
    if (tokens == needs.full || tokens >= needs.full + kFapCount) return true;
    const std::int64_t line = scan_.line();
    if (tokens > needs.full) {
      for (int i = 0; i <= needs.full; ++i) scan_.token();
      return fail_at_token(Code::syntax, "the line has " + plural(tokens - 1, "value") +
                                             " behind the frame number, the mask asks for " +
                                             std::to_string(needs.full - 1));
    }
    if (tokens == needs.single) {
      const int next = tokens_of_next_line();
      if (next == 0 || next >= kFapCount) {
        notes_.add(Quirk::single_high_level, line, [] {
          return "FAP 1 or 2 has a single value instead of 4 or 6, it is taken as the selection";
        });
        return single_ = true;
      }
    }
    return check_wrapped_values(needs, tokens);
  }

  // Values may go on in further lines if they end where one of those ends.
  bool check_wrapped_values(const Needs& needs, int tokens) {
    const std::int64_t line = scan_.line();
    const auto refuse = [&](Code code, const TextScanner& line_end, std::string_view more) {
      return fail(code,
                  "the line has " + plural(tokens - 1, "value") +
                      " behind the frame number, the mask asks for " +
                      std::to_string(needs.full - 1) + std::string(more),
                  line, line_end.column());
    };
    TextScanner ahead = scan_;
    while (!ahead.token().empty()) {
    }
    const TextScanner line_end = ahead;
    for (int have = tokens; have < needs.full;) {
      if (!ahead.to_content()) return refuse(Code::truncated, line_end, " and the text ends here");
      const int next = ahead.count_rest(kLookAhead);
      if (next >= kFapCount || have + next > needs.full) return refuse(Code::syntax, line_end, "");
      have += next;
      while (!ahead.token().empty()) {
      }
    }
    notes_.add(Quirk::wrapped_values, line,
               [] { return "the values of a frame go on in the next line"; });
    return true;
  }

  bool read_values(Frame& frame) {
    if (!frame_number(frame.number)) return false;
    if (frame.mask[1] && !read_viseme(frame.viseme)) return false;
    if (frame.mask[2] && !read_expression(frame.expression)) return false;
    for (std::size_t fap = kFirstLowLevel; fap <= kFapCount; ++fap) {
      if (frame.mask[fap] && !value(frame.value[fap])) return false;
    }
    return true;
  }

  bool read_viseme(Viseme& v) {
    if (single_) {
      v.blend = 63;
      return value(v.select1) && check_range(v.select1, 14);
    }
    return value(v.select1) && check_range(v.select1, 14) && value(v.select2) &&
           check_range(v.select2, 14) && value(v.blend) && check_range(v.blend, 63) && flag(v.def);
  }

  bool read_expression(Expression& e) {
    if (single_) {
      e.intensity1 = 63;
      return value(e.select1) && check_range(e.select1, 6);
    }
    return value(e.select1) && check_range(e.select1, 6) && value(e.intensity1) &&
           check_range(e.intensity1, 63) && value(e.select2) && check_range(e.select2, 6) &&
           value(e.intensity2) && check_range(e.intensity2, 63) && flag(e.init_face) && flag(e.def);
  }

  // Always true: values outside the ranges of the standard are kept.
  bool check_range(std::int32_t v, std::int32_t highest) {
    if (v >= 0 && v <= highest) return true;
    notes_.add(Quirk::high_level_range, scan_.line(), [&] {
      return "a value of FAP 1 or 2 is " + std::to_string(v) + ", allowed are 0 to " +
             std::to_string(highest);
    });
    return true;
  }

  bool flag(bool& out) {
    std::int32_t v = 0;
    if (!value(v)) return false;
    out = v != 0;
    return check_range(v, 1);
  }

  std::string_view next_token() {
    std::string_view token = scan_.token();
    if (token.empty() && scan_.to_content()) token = scan_.token();
    return token;
  }

  bool value(std::int32_t& out) {
    const std::string_view token = next_token();
    const char* end = token.data() + token.size();
    const auto [stop, code] = std::from_chars(token.data(), end, out);
    if (code == std::errc() && stop == end) return true;
    double number = 0;
    if (!real(token, number)) return false;
    if (number < std::numeric_limits<std::int32_t>::min() ||
        number > std::numeric_limits<std::int32_t>::max()) {
      return fail_at_token(Code::out_of_range,
                           "the value " + quoted(token) + " does not fit 32 bits");
    }
    out = std::int32_t(number);
    return true;
  }

  bool frame_number(std::int64_t& out) {
    const std::string_view token = next_token();
    double number = 0;
    if (!real(token, number)) return false;
    if (std::abs(number) > double(kLargestNumber)) {
      return fail_at_token(Code::out_of_range,
                           "the frame number " + quoted(token) + " is beyond 10^15");
    }
    out = std::int64_t(number);  // exact: far below 2^53
    number_line_ = scan_.line();
    return true;
  }

  // A number as people and programs write it, rounded to an integer.
  bool real(std::string_view token, double& out) {
    const char* begin = token.data();
    const char* end = begin + token.size();
    if (token.size() > 1 && *begin == '+' && begin[1] != '-') ++begin;
    const auto [stop, code] = std::from_chars(begin, end, out);
    if (code == std::errc::result_out_of_range && stop == end) {
      out = 1e300;  // or tiny: both are no FAP values
    } else if (code != std::errc() || stop != end || !std::isfinite(out)) {
      return fail_at_token(Code::syntax, quoted(token) + " is not a number");
    }
    const double rounded = std::round(out);
    if (rounded != out) {
      notes_.add(Quirk::rounded, scan_.line(),
                 [&] { return "the value " + quoted(token) + " is rounded to an integer"; });
    }
    out = rounded;
    return true;
  }

  TextScanner& scan_;
  TextNotes& notes_;
  bool single_ = false;
  std::int64_t number_line_ = 0;
  Error error_;
};

}  // namespace

Result<std::int64_t> read_frame(TextScanner& scanner, TextNotes& notes, Frame& frame) {
  return FrameReader(scanner, notes).read(frame);
}

}  // namespace animeme::fap::detail
