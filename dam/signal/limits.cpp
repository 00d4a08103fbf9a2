#include "dam/signal/limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "dam/script/table_text_internal.h"
#include "fap/arkit.h"

namespace animeme::dam {
namespace {

/// Shapes that undo each other, by ARKit's names.
constexpr std::array<std::array<std::string_view, 2>, 10> kOpposites = {{
    {"jawLeft", "jawRight"},
    {"mouthLeft", "mouthRight"},
    {"mouthSmileLeft", "mouthFrownLeft"},
    {"mouthSmileRight", "mouthFrownRight"},
    {"eyeBlinkLeft", "eyeWideLeft"},
    {"eyeBlinkRight", "eyeWideRight"},
    {"eyeLookUpLeft", "eyeLookDownLeft"},
    {"eyeLookUpRight", "eyeLookDownRight"},
    {"eyeLookInLeft", "eyeLookOutLeft"},
    {"eyeLookInRight", "eyeLookOutRight"},
}};

std::int32_t index_of(std::span<const std::string> names, std::string_view name) {
  const auto at = std::find(names.begin(), names.end(), name);
  return at == names.end() ? -1 : std::int32_t(at - names.begin());
}

/// A field as a bound; nothing in it: none.
std::optional<double> bound_of(std::string_view field, double none) {
  if (field.empty()) return none;
  const auto value = parse_number(field);
  if (!value || std::isnan(*value)) return std::nullopt;
  return value;
}

/// Fields of one row, empty where the table has no such column.
struct Row {
  std::string_view control, low, high, opposite;
};

/// The table's columns by what they mean.
class Columns {
 public:
  static Result<Columns> find(const TableLine& line) {
    Columns columns;
    columns.separator_ = line.text.find('\t') != std::string_view::npos ? '\t' : ',';
    const auto header = split_fields(line.text, columns.separator_);
    columns.count_ = header.size();
    constexpr std::array<std::string_view, 4> kNames = {"control", "low", "high", "opposite"};
    for (std::size_t i = 0; i < kNames.size(); ++i) columns.at_[i] = find_column(header, kNames[i]);
    if (!columns.at_[0] || (!columns.at_[1] && !columns.at_[2] && !columns.at_[3]))
      return error_at_line(
          Code::syntax,
          "a table of limits begins with the columns control, low, high and optionally opposite",
          std::int64_t(line.number));
    return columns;
  }
  Result<Row> read(const TableLine& line) const {
    const auto fields = split_fields(line.text, separator_);
    if (fields.size() != count_)
      return error_at_line(Code::syntax,
                           std::to_string(fields.size()) + " fields where the header has " +
                               std::to_string(count_) + "; complete the line",
                           std::int64_t(line.number));
    const auto field = [&](std::size_t i) { return at_[i] ? fields[*at_[i]] : std::string_view(); };
    return Row{field(0), field(1), field(2), field(3)};
  }

 private:
  char separator_ = ',';
  std::size_t count_ = 0;
  std::array<std::optional<std::size_t>, 4> at_;
};

Result<void> check_bounds(const Row& row, const ControlLimit& limit, std::size_t line) {
  if (limit.low <= limit.high) return {};
  return error_at_line(Code::invalid_argument,
                       "the least value of " + std::string(row.control) + " is above its largest",
                       std::int64_t(line));
}

/// Ties two controls, each of which has no other opposite.
Result<void> tie(std::vector<ControlLimit>& limits, std::int32_t a, std::int32_t b,
                 std::span<const std::string> names, std::size_t line) {
  const auto taken = [&](std::int32_t c, std::int32_t by) {
    const std::int32_t has = limits[std::size_t(c)].opposite;
    return has >= 0 && has != by;
  };
  if (a == b || taken(a, b) || taken(b, a))
    return error_at_line(Code::invalid_argument,
                         names[std::size_t(a)] + " and " + names[std::size_t(b)] +
                             " cannot be opposites: a control has one, which is another",
                         std::int64_t(line));
  limits[std::size_t(a)].opposite = b;
  limits[std::size_t(b)].opposite = a;
  return {};
}

/// A control without its opposite, if it has one.
void release(std::vector<ControlLimit>& limits, std::size_t control) {
  const std::int32_t other = limits[control].opposite;
  if (other < 0) return;
  for (const std::size_t c : {control, std::size_t(other)}) {
    limits[c].opposite = -1;
    limits[c].shared = 0;
  }
}

}  // namespace

std::vector<ControlLimit> natural_limits(std::span<const std::string> names) {
  std::vector<ControlLimit> limits(names.size());
  std::array<std::int32_t, fap::kArkitChannelCount> channel;
  channel.fill(-1);
  for (std::size_t c = 0; c < names.size(); ++c) {
    const auto shape = fap::find_arkit(names[c]);
    if (!shape || *shape >= fap::kArkitShapeCount) continue;
    channel[std::size_t(*shape)] = std::int32_t(c);
    limits[c].low = 0;
    limits[c].high = 1;
  }
  for (const auto& [one, other] : kOpposites) {
    const std::int32_t a = channel[std::size_t(*fap::find_arkit(one))];
    const std::int32_t b = channel[std::size_t(*fap::find_arkit(other))];
    if (a < 0 || b < 0) continue;
    limits[std::size_t(a)].opposite = b;
    limits[std::size_t(b)].opposite = a;
    limits[std::size_t(a)].shared = limits[std::size_t(b)].shared = kSharedByShapes;
  }
  return limits;
}

void untie(std::vector<ControlLimit>& limits,
           const std::function<bool(std::size_t, std::size_t)>& apart) {
  for (std::size_t c = 0; c < limits.size(); ++c) {
    const std::int32_t other = limits[c].opposite;
    if (other <= std::int32_t(c) || apart(c, std::size_t(other))) continue;
    release(limits, c);
  }
}

std::vector<ControlLimit> settled(std::vector<ControlLimit> limits) {
  const bool free = std::all_of(limits.begin(), limits.end(),
                                [](const ControlLimit& limit) { return limit.free(); });
  return free ? std::vector<ControlLimit>() : std::move(limits);
}

Result<std::vector<ControlLimit>> read_limits(std::string_view text,
                                              std::span<const std::string> names) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto lines = table_lines(text);
  if (lines.empty()) return make_error(Code::truncated, "the table of limits is empty");
  const auto columns = Columns::find(lines[0]);
  if (!columns) return columns.error();
  std::vector<ControlLimit> limits = natural_limits(names);
  std::set<std::string_view> seen;
  struct Pair {
    std::int32_t one, other;
    std::size_t line;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto row = columns->read(lines[i]);
    if (!row) return row.error();
    const auto at = std::int64_t(lines[i].number);
    if (!seen.insert(row->control).second)
      return error_at_line(Code::invalid_argument,
                           std::string(row->control) + " has two rows; leave one out", at);
    const auto low = bound_of(row->low, -kNone), high = bound_of(row->high, kNone);
    if (!low || !high)
      return error_at_line(Code::syntax,
                           "a bound of " + std::string(row->control) + " is not a number", at);
    const std::int32_t c = index_of(names, row->control);
    if (c < 0) continue;
    ControlLimit& limit = limits[std::size_t(c)];
    release(limits, std::size_t(c));
    limit = {*low, *high, -1, 0};
    if (auto ok = check_bounds(*row, limit, lines[i].number); !ok) return ok.error();
    if (const std::int32_t other = index_of(names, row->opposite); other >= 0)
      pairs.push_back({c, other, lines[i].number});
  }
  for (const Pair& pair : pairs)
    if (auto ok = tie(limits, pair.one, pair.other, names, pair.line); !ok) return ok.error();
  return settled(std::move(limits));
}

void apply_limits(Signal& signal, std::span<const ControlLimit> limits) {
  if (limits.empty()) return;
  const std::size_t controls = signal.names.size();
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    double* row = &signal.values[i * controls];
    for (std::size_t c = 0; c < controls; ++c) {
      const std::int32_t other = limits[c].opposite;
      if (other <= std::int32_t(c)) continue;  // none, or done from its side
      const double common = std::min(row[c], row[other]) - limits[c].shared;
      if (common <= 0) continue;
      row[c] -= common;
      row[other] -= common;
    }
    for (std::size_t c = 0; c < controls; ++c)
      row[c] = std::clamp(row[c], limits[c].low, limits[c].high);
  }
}

}  // namespace animeme::dam
