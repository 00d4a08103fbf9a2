#include "tools/formats/exchange/detail/plain_table.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <vector>

#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {
namespace {

constexpr std::size_t kFewestFields = 3;  // between blanks: two words may be any text

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

// Each with its number minus one as index.
std::vector<std::string> split_lines(std::string_view text) {
  const char end = text.find('\n') == std::string_view::npos ? '\r' : '\n';
  std::vector<std::string> lines;
  for (const std::string_view line : dam::split_fields(text, end)) lines.emplace_back(line);
  for (std::string& line : lines) {
    if (line.ends_with('\r')) line.pop_back();
  }
  return lines;
}

std::vector<std::string> blank_fields(std::string_view line) {
  std::vector<std::string> fields;
  while (!(line = dam::trimmed(line)).empty()) {
    fields.emplace_back(line.substr(0, line.find_first_of(" \t")));
    line.remove_prefix(fields.back().size());
  }
  return fields;
}

bool is_number_or_missing(std::string_view field) {
  return is_missing(field) || dam::parse_number(field).has_value();
}

template <class Fields>
bool mostly_numbers(const Fields& fields) {
  const auto count = std::count_if(fields.begin(), fields.end(), [](std::string_view field) {
    return is_number_or_missing(dam::trimmed(field));
  });
  return std::size_t(count) * 2 > fields.size();
}

std::size_t next_line(const std::vector<std::string>& lines, std::size_t from) {
  while (from < lines.size() && dam::trimmed(lines[from]).empty()) ++from;
  return from;
}

// A comment whose fields are as many as those of the line of numbers behind it.
bool is_header_in_comment(const std::string& comment, const std::string& next) {
  const std::string_view names = std::string_view(comment).substr(1);
  const char separator = separator_of(next);
  if (next.find(separator) == std::string::npos) {
    const auto fields = blank_fields(next);
    return fields.size() >= kFewestFields && mostly_numbers(fields) &&
           blank_fields(names).size() == fields.size();
  }
  const auto fields = dam::split_fields(next, separator);
  return mostly_numbers(fields) && dam::split_fields(names, separator).size() == fields.size();
}

// Blanks what stands before the header; its index.
std::size_t clear_front(std::vector<std::string>& lines) {
  std::size_t header = next_line(lines, 0);
  for (; header < lines.size(); header = next_line(lines, header)) {
    const std::string_view line = dam::trimmed(lines[header]);
    const bool separator = line.size() <= 5 && lower_case(line).starts_with("sep=");
    if (!separator && !line.starts_with('#')) break;
    const std::size_t next = next_line(lines, header + 1);
    if (!separator && next < lines.size() && is_header_in_comment(std::string(line), lines[next])) {
      lines[header] = line.substr(1);
      break;
    }
    lines[header].clear();
  }
  return header;
}

// Quotes are taken off; "" within them is one.
std::string unquoted(std::string_view line, char separator) {
  std::string out;
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      if (inside && i + 1 < line.size() && line[i + 1] == '"') {
        out += c;
        ++i;
      } else {
        inside = !inside;
      }
    } else if (inside && c == separator) {
      const bool number = i > 0 && is_decimal_digit(line[i - 1]) && i + 1 < line.size() &&
                          is_decimal_digit(line[i + 1]);
      out += number ? '.' : ' ';
    } else {
      out += c;
    }
  }
  return out;
}

void tabs_for_bars(std::vector<std::string>& lines) {
  for (std::string& line : lines) {
    std::string_view row = dam::trimmed(line);
    if (row.starts_with('|') && row.size() > 1) row.remove_prefix(1);
    if (row.ends_with('|') && row.size() > 1) row.remove_suffix(1);
    std::string text(row);
    std::replace(text.begin(), text.end(), '|', '\t');
    line = std::move(text);
  }
}

void tabs_for_blanks(std::vector<std::string>& lines) {
  for (std::string& line : lines) {
    std::string text;
    for (const std::string& field : blank_fields(line)) text += (text.empty() ? "" : "\t") + field;
    line = std::move(text);
  }
}

// Fields between bars or blanks are put between tabs.
void use_tabs(std::vector<std::string>& lines, std::size_t header) {
  const std::string& names = lines[header];
  if (names.find_first_of(",;\t") != std::string::npos) return;
  const std::size_t next = next_line(lines, header + 1);
  if (next == lines.size()) return;
  const auto bars = [](const std::string& line) {
    return std::count(line.begin(), line.end(), '|');
  };
  if (bars(names) >= 2 && bars(names) == bars(lines[next]) &&
      mostly_numbers(dam::split_fields(lines[next], '|'))) {
    tabs_for_bars(lines);
    return;
  }
  const auto fields = blank_fields(lines[next]);
  if (fields.size() >= kFewestFields && blank_fields(names).size() == fields.size() &&
      mostly_numbers(fields)) {
    tabs_for_blanks(lines);
  }
}

}  // namespace

bool is_missing(std::string_view field) {
  constexpr std::string_view kMissing[] = {"",          "nan", "-nan", "+nan", "nan(ind)",
                                           "-nan(ind)", "na",  "n/a",  "#n/a", "null",
                                           "none",      "nil", "-",    "--"};
  const std::string lower = lower_case(dam::trimmed(field));
  return std::find(std::begin(kMissing), std::end(kMissing), lower) != std::end(kMissing);
}

std::string plain_table(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  std::vector<std::string> lines = split_lines(text);
  const std::size_t header = clear_front(lines);
  if (header >= lines.size()) return std::string(text);
  if (text.find('"') != std::string_view::npos) {
    const char separator = separator_of(lines[header]);
    for (std::string& line : lines) line = unquoted(line, separator);
  }
  use_tabs(lines, header);
  const char separator = separator_of(lines[header]);
  const auto count = [&](const std::string& line) {
    return std::count(line.begin(), line.end(), separator);
  };
  const auto columns = count(lines[header]);
  const std::string blanks = std::string(" \t\r") + separator;
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::string& line = lines[i];
    if (i > header && line.find_first_not_of(blanks) == std::string::npos) line.clear();
    if (i > header && line.ends_with(separator)) {
      for (auto more = count(line) - columns; more > 0 && line.ends_with(separator); --more) {
        line.pop_back();
      }
    }
    out += line;
    if (i + 1 < lines.size()) out += '\n';
  }
  return out;
}

}  // namespace animeme::exchange
