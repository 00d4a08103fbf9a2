#include "tools/formats/exchange/column_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "dam/signal/fap_signal.h"
#include "fap/arkit.h"
#include "fap/tables.h"
#include "tools/formats/exchange/detail/landmark_columns.h"
#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {

namespace {

// The name that readers know for a meaning; nothing if none does.
std::optional<std::string> known_name(const std::string& meaning) {
  const std::string lower = lower_case(meaning);
  if (lower == "-") return std::string();
  if (is_time_name(lower) || lower == "frame" || lower == "face_id" || lower == "confidence" ||
      lower == "success" || fap::find_arkit(lower) || is_coordinate_name(meaning)) {
    return meaning;
  }
  if (const int fap = dam::fap_of_channel(lower); fap > 2) return dam::fap_channel(fap);
  for (const fap::FapInfo& info : fap::kFaps) {
    if (info.number > 2 && lower == info.name) return dam::fap_channel(info.number);
  }
  return std::nullopt;
}

// What a "*" would stand for, tried on some texts: "8.3_*" is known, "8.3_x" being so.
bool is_known(const std::string& meaning) {
  const std::size_t star = meaning.find('*');
  if (star == std::string::npos) return known_name(meaning) || is_point_name(meaning);
  for (const char* text : {"x", "3", "1", "2.1", "Left"}) {
    std::string tried = meaning;
    if (known_name(tried.replace(star, 1, text))) return true;
  }
  return false;
}

Result<ColumnRule> checked(ColumnRule rule) {
  if (rule.name.empty() || rule.meaning.empty()) {
    return make_error(Code::syntax, "write NAME=MEANING, like jaw=jawOpen or mouthL_*=8.3_*");
  }
  if (!is_known(rule.meaning)) {
    return make_error(Code::invalid_argument,
                      "'" + rule.meaning +
                          "' is not a known meaning; write a shape (jawOpen), a coordinate "
                          "(x_61, 8.3_y), a FAP (fap3), time_s, frame, confidence, or - to leave "
                          "it out");
  }
  if (!std::isfinite(rule.factor) || rule.factor == 0) {
    return make_error(Code::invalid_argument, "the factor of " + rule.name +
                                                  " is not a number, or is 0; write one like 0.01");
  }
  return rule;
}

// A rule's meaning for a column; nothing: it is about another one.
std::optional<std::string> meaning_for(const ColumnRule& rule, std::string_view column) {
  const std::string name = lower_case(rule.name);
  const std::string given = lower_case(column);
  const std::size_t star = name.find('*');
  if (star == std::string::npos) {
    if (name != given) return std::nullopt;
    return known_name(rule.meaning);
  }
  const std::string_view front = std::string_view(name).substr(0, star);
  const std::string_view back = std::string_view(name).substr(star + 1);
  if (given.size() < front.size() + back.size() || !given.starts_with(front) ||
      !given.ends_with(back)) {
    return std::nullopt;
  }
  std::string meaning = rule.meaning;
  const std::size_t at = meaning.find('*');
  const std::string_view text =
      column.substr(front.size(), column.size() - front.size() - back.size());
  if (at != std::string::npos) meaning.replace(at, 1, text);
  return known_name(meaning);  // empty: the text of the star is not valid here
}

struct Column {
  std::string name;
  double factor = 1;
  bool kept = true;
};

Result<std::vector<Column>> renamed(const Row& header, const ColumnMap& map) {
  std::vector<Column> columns;
  std::vector<bool> used(map.size(), false);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < header.size(); ++i) {
    Column column{std::string(header.text(i))};
    names.push_back(column.name);
    for (std::size_t r = 0; r < map.size(); ++r) {
      const auto meaning = meaning_for(map[r], names.back());
      if (!meaning) continue;
      used[r] = true;
      column = {*meaning, map[r].factor, !meaning->empty()};
      break;
    }
    columns.push_back(std::move(column));
  }
  for (std::size_t r = 0; r < map.size(); ++r) {
    if (used[r]) continue;
    return error_at_line(
        Code::not_found,
        "no column is called '" + map[r].name + "'; there are: " + list_of_names(names),
        std::int64_t(header.line()));
  }
  return columns;
}

}  // namespace

Result<ColumnRule> parse_column_rule(std::string_view text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string_view::npos) return checked({});
  ColumnRule rule{std::string(dam::trimmed(text.substr(0, equals))), {}, 1};
  std::string_view meaning = dam::trimmed(text.substr(equals + 1));
  // "8.3_*" has a star of its own; a factor is what a number follows.
  if (const std::size_t star = meaning.rfind('*'); star != std::string_view::npos) {
    const std::string_view behind = dam::trimmed(meaning.substr(star + 1));
    if (!behind.empty()) {
      const auto factor = dam::parse_number(behind);
      rule.factor = factor ? *factor : 0;
      meaning = dam::trimmed(meaning.substr(0, star));
    }
  }
  rule.meaning = meaning;
  return checked(std::move(rule));
}

Result<ColumnMap> read_column_map(std::string_view text) {
  ColumnMap map;
  bool first = true;
  for (const dam::TableLine& line : dam::table_lines(text)) {
    if (dam::trimmed(line.text).starts_with('#')) continue;
    const Row row(line, separator_of(line.text));
    const bool heading = first && row.size() >= 2 && lower_case(row.text(0)) == "column";
    first = false;
    if (heading) continue;
    const auto at = std::int64_t(line.number);
    if (row.size() != 2 && row.size() != 3) {
      return error_at_line(
          Code::syntax,
          "a column, its meaning and optionally a factor are needed, like jaw,jawOpen", at);
    }
    ColumnRule rule{std::string(row.text(0)), std::string(row.text(1)), 1};
    if (row.size() == 3 && !row.text(2).empty()) rule.factor = row.number(2).value_or(0);
    auto good = checked(std::move(rule));
    if (!good) return error_at_line(good.error().code, good.error().message, at);
    map.push_back(std::move(*good));
  }
  if (map.empty()) {
    return make_error(Code::truncated, "there is no rule; write lines like jaw,jawOpen");
  }
  return map;
}

Result<std::string> rename_columns(std::string_view table, const ColumnMap& map) {
  const auto lines = dam::table_lines(table);
  if (map.empty() || lines.empty()) return std::string(table);
  const char separator = separator_of(lines[0].text);
  const auto columns = renamed(Row(lines[0], separator), map);
  if (!columns) return columns.error();
  std::string out;
  std::size_t number = 1;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (; number < lines[i].number; ++number) out += '\n';
    const Row row(lines[i], separator);
    bool any = false;
    const bool whole = row.size() == columns->size();
    if (!whole) out += lines[i].text;  // the reader says what is wrong with it
    for (std::size_t f = 0; whole && f < columns->size(); ++f) {
      const Column& column = (*columns)[f];
      if (!column.kept) continue;
      if (any) out += separator;
      any = true;
      if (i == 0) {
        out += column.name;
      } else if (column.factor == 1 || row.text(f).empty()) {
        out += row.text(f);
      } else {
        const auto value = row.number(f);
        if (!value) return row.wrong(f, column.name, "not a number; correct it or leave it empty");
        char text[40];
        std::snprintf(text, sizeof text, "%.9g", *value * column.factor);
        out += text;
      }
    }
  }
  return out + "\n";
}

}  // namespace animeme::exchange
