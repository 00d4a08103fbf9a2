#include <algorithm>
#include <string_view>
#include <vector>

#include "fap/detail/real_text.h"
#include "fap/detail/text_header.h"
#include "fap/detail/text_writing.h"
#include "fap/rate_text.h"

namespace animeme::fap::detail {
namespace {

constexpr std::string_view kForm = "the first line has to be 'version name rate frames'";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

std::optional<double> number(std::string_view token) {
  double value = 0;
  const auto [end, code] = read_real(token.data(), token.data() + token.size(), value);
  if (code != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

// Rates may also be fractions, so the characters decide and parse_rate() judges later.
bool looks_like_rate(std::string_view token) {
  return !token.empty() && token.find_first_not_of("0123456789./") == std::string_view::npos &&
         token.front() >= '0' && token.front() <= '9';
}

std::string with_point(std::string_view token) {
  std::string text(token);
  std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

// "29,97", "1e9", "-25", and "nan" and "inf" after a name: meant as a rate, but invalid.
bool is_wrong_rate(std::string_view token, bool named) {
  if (looks_like_rate(token) || parse_rate(token)) return false;
  const std::string text = with_point(token);
  return number(text) && (named || text.find_first_of("0123456789") != std::string::npos);
}

std::string wrong_rate(std::string_view token) {
  const std::string text = with_point(token);
  if (text == token || !looks_like_rate(text)) return parse_rate(token).error().message;
  return in_quotes(token) + " is not a frame rate, write " + text + " with a point";
}

// The words of a line, all of them parts of `line`.
struct Words {
  std::string_view line;
  std::vector<std::string_view> words;

  std::size_t offset(std::string_view word) const { return std::size_t(word.data() - line.data()); }
};

Words split(std::string_view line, bool stop_at_comment) {
  Words result{line, {}};
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && is_blank(line[at])) ++at;
    const std::size_t begin = at;
    while (at < line.size() && !is_blank(line[at])) ++at;
    if (at == begin || (stop_at_comment && line[begin] == '#')) break;
    result.words.push_back(line.substr(begin, at - begin));
  }
  return result;
}

bool ends_with_numbers(const Words& w) {
  return w.words.size() >= 3 && number(w.words.back()) &&
         looks_like_rate(w.words[w.words.size() - 2]);
}

// A name may contain a word like "#3", so a comment is only cut off where a whole header
// remains in front of it.
Words header_words(std::string_view line) {
  Words bare = split(line, true);
  if (ends_with_numbers(bare)) return bare;
  Words all = split(line, false);
  return ends_with_numbers(all) ? all : bare;
}

// What else people hand to a FAP reader by mistake.
std::optional<Error> foreign(std::string_view text, std::string_view first_token, std::int64_t line,
                             const TextDialect& dialect) {
  const auto refuse = [line](std::string what) {
    return error_at_line(Code::unsupported, std::move(what), line);
  };
  const std::string format(dialect.format);
  if (text.substr(0, 3) == std::string_view("\0\0\1", 3)) {
    return refuse("this is a binary FBA stream and not " + format + ": decode it first");
  }
  if (text.substr(0, 2) == "\xff\xfe" || text.substr(0, 2) == "\xfe\xff") {
    return refuse("this text is UTF-16: save it as UTF-8 or plain ASCII");
  }
  if (first_token == "FBM") {
    return refuse("this is an encoder parameter file (EPF) and not " + format);
  }
  if (first_token.front() == '<') {
    return refuse("this is XML and not " + format + ": take the text out of its element");
  }
  if (TextDialect::has(dialect.other, first_token)) {
    return refuse("version " + std::string(first_token) + " is " +
                  std::string(dialect.other_format) + " and not " + format);
  }
  return std::nullopt;
}

bool is_flag(std::string_view token) { return token == "0" || token == "1"; }

// Goes over a lone start number, so that the scanner stands at the first mask.
bool skip_start_number(TextScanner& scanner, int flags) {
  TextScanner ahead = scanner;
  if (ahead.count_rest(2) != 1) return false;
  // "2.1" would be the rest of a header.
  if (ahead.token().find_first_not_of("0123456789") != std::string_view::npos) return false;
  if (!ahead.to_content() || ahead.count_rest(flags) < flags) return false;
  scanner = ahead;
  return true;
}

bool starts_with_mask(const TextScanner& scanner, std::string_view first_token, int flags) {
  return is_flag(first_token) && scanner.count_rest(flags) >= flags;
}

void check_version(std::string_view version, std::int64_t line, const TextDialect& dialect,
                   TextNotes& notes) {
  if (TextDialect::has(dialect.known, version)) return;
  notes.add(Quirk::version, line, [&] {
    return "version " + in_quotes(version) + " is not known, the file is read like " +
           std::string(dialect.known_as);
  });
}

// Sets the name from the words between the version and the numbers.
void take_name(const Words& w, std::size_t end, TextHeader& header, TextNotes& notes) {
  if (end <= 1) {
    notes.add(Quirk::no_name, header.line, [] { return "the header has no name"; });
    return;
  }
  const std::size_t from = w.offset(w.words[1]);
  const std::size_t to = w.offset(w.words[end - 1]) + w.words[end - 1].size();
  header.name = w.line.substr(from, to - from);
  if (end > 2) {
    notes.add(Quirk::blanks_in_name, header.line,
              [] { return "the name contains blanks, some players refuse that"; });
  }
}

void take_count(std::string_view word, TextHeader& header) {
  const double count = number(word).value_or(-1);
  const bool fits = count >= 0 && count <= 1e15;
  header.count = fits ? std::int64_t(count) : std::int64_t(-1);
}

Result<Rate> take_rate(std::string_view word, const ReadTextOptions& options,
                       const TextHeader& header, TextNotes& notes) {
  Result<Rate> rate = parse_rate(word);
  if (!rate || rate->valid()) return rate;
  notes.add(Quirk::no_rate, header.line, [&] {
    return "the header has rate 0, " + format_rate(options.default_rate) +
           " frames a second are assumed";
  });
  return options.default_rate;
}

struct Place {
  std::int64_t line;
  std::int64_t column;  // of the first word
};

Result<TextHeader> parse_header(const Words& w, Place place, const TextDialect& dialect,
                                const ReadTextOptions& options, TextNotes& notes) {
  const auto refuse = [&](std::string message, std::string_view word) {
    return error_at_line(Code::syntax, std::move(message), place.line,
                         place.column + std::int64_t(w.offset(word)));
  };
  if (w.words.empty() || !number(w.words.front())) {
    const std::string_view word = w.words.empty() ? w.line.substr(0, 0) : w.words.front();
    return refuse(std::string(kForm) + ", but it starts with " + in_quotes(word), word);
  }
  TextHeader header;
  header.line = place.line;
  std::size_t rate_at = w.words.size() - 1;
  if (ends_with_numbers(w)) {
    take_count(w.words.back(), header);
    --rate_at;
  } else if (rate_at > 1 && is_wrong_rate(w.words[rate_at - 1], rate_at > 2)) {
    return refuse(wrong_rate(w.words[rate_at - 1]), w.words[rate_at - 1]);
  } else if (rate_at > 0 && looks_like_rate(w.words.back())) {
    notes.add(Quirk::no_count, place.line,
              [] { return "the header has no frame count, all frames are read"; });
  } else if (rate_at > 1 && is_wrong_rate(w.words.back(), true)) {
    return refuse(wrong_rate(w.words.back()), w.words.back());
  } else {
    return refuse(std::string(kForm) + ", but the frame rate is missing", w.words.back());
  }
  header.version = w.words.front();
  check_version(w.words.front(), place.line, dialect, notes);
  take_name(w, rate_at, header, notes);
  Result<Rate> rate = take_rate(w.words[rate_at], options, header, notes);
  if (!rate) {
    Error error = refuse(rate.error().message, w.words[rate_at]);
    error.code = rate.error().code;
    return error;
  }
  header.rate = *rate;
  if (const std::size_t tag = exact_rate_at(header.name, *rate); tag != std::string::npos) {
    header.rate = exact_rate_of(std::string_view(header.name).substr(tag));
    header.name.resize(tag);
  }
  return header;
}

constexpr std::string_view kExactEnd = "fps";

}  // namespace

std::string exact_rate_tag(Rate rate) { return "@" + format_rate(rate) + std::string(kExactEnd); }

Rate exact_rate_of(std::string_view tag) {
  const Result<Rate> rate = parse_rate(tag.substr(1, tag.size() - 1 - kExactEnd.size()));
  return rate ? *rate : Rate{0, 0};
}

std::size_t exact_rate_at(std::string_view name, Rate whole) {
  const std::size_t tag = name.rfind('@');
  if (tag == std::string_view::npos || tag == 0 || !name.ends_with(kExactEnd)) return name.npos;
  if (name.size() - tag < kExactEnd.size() + 2) return name.npos;
  const Rate rate = exact_rate_of(name.substr(tag));
  const bool exact = rate.valid() && rate.den > 1 && whole_rate(rate) == whole;
  return exact ? tag : name.npos;
}

Result<TextHeader> read_header(std::string_view text, TextScanner& scanner,
                               const TextDialect& dialect, const ReadTextOptions& options,
                               TextNotes& notes) {
  if (!scanner.to_content()) {
    return error_at_line(Code::truncated, "the text is empty: " + std::string(kForm),
                         scanner.line());
  }
  const std::int64_t line = scanner.line();
  TextScanner ahead = scanner;
  const std::string_view first = ahead.token();
  if (auto error = foreign(text, first, line, dialect)) return *error;
  if (skip_start_number(scanner, dialect.flags) ||
      starts_with_mask(scanner, first, dialect.flags) || options.headerless) {
    if (!options.headerless) {
      notes.add(Quirk::no_header, line, [&] {
        return "there is no header, " + format_rate(options.default_rate) +
               " frames a second are assumed";
      });
    }
    return TextHeader{"", options.default_rate, std::nullopt, line, ""};
  }
  const Place place{line, scanner.column()};
  return parse_header(header_words(scanner.rest_of_line()), place, dialect, options, notes);
}

void check_count(const TextHeader& header, std::size_t frames, TextNotes& notes) {
  if (!header.count || *header.count == std::int64_t(frames)) return;
  notes.add(Quirk::wrong_count, header.line, [&] {
    const std::string said =
        *header.count < 0 ? "no valid frame count" : std::to_string(*header.count) + " frames";
    return "the header says " + said + ", the text has " + std::to_string(frames);
  });
}

void remove_byte_order_mark(std::string_view& text, TextNotes& notes) {
  if (text.substr(0, 3) != "\xef\xbb\xbf") return;
  text.remove_prefix(3);
  notes.add(Quirk::byte_order_mark, 1, [] { return "the text has a byte order mark"; });
}

}  // namespace animeme::fap::detail
