#include "tools/formats/exchange/detail/json_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "fap/arkit.h"
#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {
namespace {

using tools::Json;

constexpr int kSeriesDepth = 3;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Series {
  bool seconds = false;
  std::vector<double> at, values;
};

bool is_curve_value(const Json& json) { return json.is_number() || json.is_null(); }

double curve_value(const Json& json) { return json.is_number() ? json.get<double>() : kNothing; }

bool every(const Json& list, bool (*holds)(const Json&)) {
  return list.is_array() && !list.empty() && std::all_of(list.begin(), list.end(), holds);
}

bool is_pair(const Json& json) {
  return json.is_array() && json.size() == 2 && json[0].is_number() && is_curve_value(json[1]);
}

std::optional<Series> series_of_numbers(const Json& list) {
  if (!every(list, is_curve_value)) return std::nullopt;
  Series series;
  for (const Json& one : list) {
    series.at.push_back(double(series.at.size()));
    series.values.push_back(curve_value(one));
  }
  return series;
}

std::optional<Series> series_of_pairs(const Json& list) {
  if (!every(list, is_pair)) return std::nullopt;
  Series series;
  series.seconds = true;
  for (const Json& one : list) {
    series.at.push_back(one[0].get<double>());
    series.values.push_back(curve_value(one[1]));
  }
  return series;
}

// {"time": 0.1, "value": 0.5}, whatever the value is called.
std::optional<Series> series_of_keys(const Json& list) {
  if (!every(list, [](const Json& one) { return one.is_object(); })) return std::nullopt;
  Series series;
  for (const Json& one : list) {
    std::optional<double> at, value;
    for (const auto& [name, member] : one.items()) {
      const ClockUnit unit = clock_unit(name);
      if (unit != ClockUnit::none && member.is_number() && !at) {
        at = member.get<double>() * (unit == ClockUnit::milliseconds ? 0.001 : 1);
        series.seconds = unit != ClockUnit::frames;
      } else if (is_curve_value(member) && !value) {
        value = curve_value(member);
      }
    }
    if (!at || !value) return std::nullopt;
    series.at.push_back(*at);
    series.values.push_back(*value);
  }
  return series;
}

std::optional<Series> series_of_members(const Json& object) {
  std::vector<std::pair<double, double>> entries;
  for (const auto& [name, member] : object.items()) {
    const auto number = dam::parse_number(name);
    if (!number || !std::isfinite(*number) || !is_curve_value(member)) return std::nullopt;
    entries.emplace_back(*number, curve_value(member));
  }
  if (entries.empty()) return std::nullopt;
  std::sort(entries.begin(), entries.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  Series series;
  for (const auto& [at, value] : entries) {
    series.seconds = series.seconds || at != std::floor(at);
    series.at.push_back(at);
    series.values.push_back(value);
  }
  return series;
}

// {"times": [...], "values": [...]}, or a curve within.
std::optional<Series> series_of(const Json& json, int depth = 0) {
  if (json.is_array()) {
    auto series = series_of_numbers(json);
    if (!series) series = series_of_pairs(json);
    return series ? series : series_of_keys(json);
  }
  if (!json.is_object() || depth > 1) return std::nullopt;
  if (auto series = series_of_members(json)) return series;
  std::optional<Series> values, times;
  ClockUnit unit = ClockUnit::none;
  for (const auto& [name, member] : json.items()) {
    if (!member.is_structured()) continue;
    auto series = series_of(member, depth + 1);
    const ClockUnit clock = clock_unit(name);
    if (series && clock != ClockUnit::none) {
      times = std::move(series);
      unit = clock;
    } else if (series && !values) {
      values = std::move(series);
    }
  }
  if (values && times && times->values.size() == values->values.size()) {
    values->seconds = unit != ClockUnit::frames;
    values->at = std::move(times->values);
    for (double& at : values->at) at *= unit == ClockUnit::milliseconds ? 0.001 : 1;
  }
  return values;
}

struct NamedSeries {
  std::map<int, Series> curves;
  std::optional<Series> times;  // of data frames: a column beside the curves
};

bool read_curve_object(const Json& json, NamedSeries& named) {
  for (const auto& [name, member] : json.items()) {
    if (!member.is_structured()) continue;
    const auto channel = fap::find_arkit(name);
    const ClockUnit unit = clock_unit(name);
    if (!channel && (unit == ClockUnit::none || unit == ClockUnit::frames)) continue;
    auto series = series_of(member);
    if (!series) continue;
    if (channel) {
      named.curves.try_emplace(*channel, std::move(*series));
    } else {
      for (double& at : series->values) at *= unit == ClockUnit::milliseconds ? 0.001 : 1;
      named.times = std::move(series);
    }
  }
  return named.curves.size() >= 2;
}

bool read_curve_list(const Json& json, NamedSeries& named) {
  for (const Json& one : json) {
    std::optional<int> channel;
    for (const auto& [name, member] : one.items()) {
      if (member.is_string() && !channel) channel = fap::find_arkit(member.text());
    }
    if (!channel) continue;
    if (auto series = series_of(one)) named.curves.try_emplace(*channel, std::move(*series));
  }
  return named.curves.size() >= 2;
}

bool find_named(const Json& json, NamedSeries& named, int depth = 0) {
  named = {};
  if (json.is_object() ? read_curve_object(json, named) : read_curve_list(json, named)) return true;
  if (depth == kSeriesDepth) return false;
  for (const auto& [name, member] : json.items()) {
    if (member.is_structured() && find_named(member, named, depth + 1)) return true;
  }
  return false;
}

// The value at a time, on the line between two of its own; held beyond its ends.
double sample(const Series& series, double at) {
  const auto next = std::lower_bound(series.at.begin(), series.at.end(), at);
  if (next == series.at.end()) return series.values.back();
  const auto i = std::size_t(next - series.at.begin());
  if (*next == at || i == 0) return series.values[i];
  const double share = (at - series.at[i - 1]) / (*next - series.at[i - 1]);
  return series.values[i - 1] + share * (series.values[i] - series.values[i - 1]);
}

bool ascends(const Series& series) {
  return std::is_sorted(series.at.begin(), series.at.end()) &&
         std::none_of(series.at.begin(), series.at.end(), [](double at) { return std::isnan(at); });
}

}  // namespace

ClockUnit clock_unit(std::string_view name) {
  std::string plain = lower_case(name);
  std::erase_if(plain, [](char c) { return c == '_' || c == '-' || c == ' '; });
  const auto is = [&](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), plain) != names.end();
  };
  if (is({"time", "times", "timestamp", "timestamps", "t", "seconds", "timecode", "timesec",
          "timeseconds", "timestampsec", "currenttime", "timeinseconds"})) {
    return ClockUnit::seconds;
  }
  if (is({"timestampms", "timestampsms", "timems", "timesms", "ms", "milliseconds",
          "timestampmilliseconds"})) {
    return ClockUnit::milliseconds;
  }
  if (is({"frame", "frames", "framenumber", "frameindex", "index", "frameid"})) {
    return ClockUnit::frames;
  }
  return ClockUnit::none;
}

std::optional<SeriesFrames> find_json_series(const Json& root) {
  NamedSeries named;
  if (!find_named(root, named)) return std::nullopt;
  SeriesFrames out;
  std::set<double> times;
  for (const auto& [channel, series] : named.curves) {
    if (!ascends(series)) return std::nullopt;
    out.seconds = out.seconds || series.seconds;
    times.insert(series.at.begin(), series.at.end());
  }
  for (const double at : times) {
    std::map<int, double> values;
    for (const auto& [channel, series] : named.curves) values[channel] = sample(series, at);
    out.at.push_back(at);
    out.values.push_back(std::move(values));
  }
  if (named.times && named.times->values.size() == out.at.size()) {
    out.at = std::move(named.times->values);
    out.seconds = true;
  }
  return out;
}

}  // namespace animeme::exchange
