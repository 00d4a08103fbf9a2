#include "tools/formats/exchange/detail/json_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "fap/arkit.h"
#include "tools/formats/exchange/detail/json_landmarks.h"
#include "tools/formats/exchange/detail/json_series.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/detail/times.h"

namespace animeme::exchange {

namespace {

using tools::Json;

constexpr int kDeepest = 6;            // of objects in objects
constexpr double kAzureRate = 60;      // frames a second: Azure's documentation
constexpr std::size_t kAzureRow = 55;  // ARKit's shapes, then three turns
constexpr std::size_t kLookAt = 65536;

std::string plain_key(std::string_view name) {
  std::string out = lower_case(name);
  std::erase_if(out, [](char c) { return c == '_' || c == '-' || c == ' '; });
  return out;
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), plain_key(name)) != names.end();
}

bool is_rate_name(std::string_view name) {
  return is_one_of(name, {"fps", "exportfps", "framerate", "framespersecond", "rate",
                          "samplingrate", "recordingfps", "capturefps", "playbackfps"});
}
bool is_step_name(std::string_view name) {
  return is_one_of(name, {"dt", "deltatime", "timestep", "frametime", "frameduration",
                          "secondsperframe", "frameinterval"});
}

std::optional<double> number_in(const Json& json) {
  if (json.is_string()) return dam::parse_number(json.text());
  if (!json.is_number()) return std::nullopt;
  return json.get<double>();
}

// 25, [25, 1] or {"num": 25, "den": 1}.
std::optional<double> rate_in(const Json& json) {
  double rate = 0;
  if (json.is_number()) rate = json.get<double>();
  if (json.is_array() && json.size() == 2 && json[0].is_number() && json[1].is_number()) {
    rate = json[0].get<double>() / json[1].get<double>();
  }
  if (json.is_string()) rate = dam::parse_number(json.text()).value_or(0);
  return rate > 0 && std::isfinite(rate) ? std::optional(rate) : std::nullopt;
}

// The first rate in an object or in those within it, not in lists.
std::optional<double> find_rate(const Json& json, int depth = 0) {
  if (!json.is_object() || depth > 3) return std::nullopt;
  for (const auto& [key, value] : json.items()) {
    if (!is_rate_name(key)) continue;
    if (const auto rate = rate_in(value)) return rate;
  }
  for (const auto& [key, value] : json.items()) {
    const auto step = is_step_name(key) ? rate_in(value) : std::nullopt;
    if (step && *step < 1) return 1 / *step;
    if (step && *step > 1) return 1000 / *step;  // milliseconds
  }
  for (const auto& [key, value] : json.items()) {
    if (const auto rate = find_rate(value, depth + 1)) return rate;
  }
  return std::nullopt;
}

struct CurveFrame {
  std::optional<double> seconds, number;
  std::string timecode;          // as text
  std::map<int, double> values;  // by channel
};

struct Curves {
  std::vector<CurveFrame> frames;
  std::optional<double> rate;
  std::vector<std::string> unknown;
};

void note_unknown(Curves& curves, const std::string& name) {
  if (name == "_neutral" || name == "neutral") return;  // MediaPipe's
  if (std::find(curves.unknown.begin(), curves.unknown.end(), name) == curves.unknown.end()) {
    curves.unknown.push_back(name);
  }
}

bool is_weight(const Json& json) { return json.is_number() || json.is_null(); }

// Null is what writers of JSON make of NaN: missing, not 0.
double weight_in(const Json& json) { return json.is_number() ? json.get<double>() : std::nan(""); }

// Lists of numbers, of one length each.
bool is_row(const Json& json, std::size_t size) {
  return json.is_array() && json.size() == size && size > 0 &&
         std::all_of(json.begin(), json.end(), is_weight);
}

bool is_matrix(const Json& json, std::size_t columns) {
  return json.is_array() && !json.empty() &&
         std::all_of(json.begin(), json.end(),
                     [&](const Json& row) { return is_row(row, columns); });
}

// At least two names of ARKit's shapes, and nothing but texts.
bool is_name_list(const Json& json) {
  if (!json.is_array() || json.size() < 2) return false;
  std::size_t known = 0;
  for (const Json& one : json) {
    if (!one.is_string()) return false;
    known += fap::find_arkit(one.text()) ? 1 : 0;
  }
  return known >= 2;
}

void put_clock(const std::string& name, const Json& value, CurveFrame& frame) {
  const ClockUnit unit = clock_unit(name);
  if (unit == ClockUnit::none || !(value.is_number() || value.is_string())) return;
  if (const auto number = number_in(value)) {
    std::optional<double>& place = unit == ClockUnit::frames ? frame.number : frame.seconds;
    if (!place) place = *number * (unit == ClockUnit::milliseconds ? 0.001 : 1);
  } else if (value.is_string() && frame.timecode.empty() && parse_time(value.text(), 0)) {
    frame.timecode = value.text();
  }
}

void read_clock(const Json& json, CurveFrame& frame) {
  for (const auto& [key, value] : json.items()) put_clock(key, value, frame);
}

using NameList = std::vector<std::string>;

CurveFrame frame_of_row(const Json& row, const NameList& names, Curves& curves) {
  CurveFrame frame;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (const auto channel = fap::find_arkit(names[i])) {
      frame.values.emplace(*channel, weight_in(row[i]));
    } else if (clock_unit(names[i]) != ClockUnit::none) {
      put_clock(names[i], row[i], frame);
    } else {
      note_unknown(curves, names[i]);
    }
  }
  return frame;
}

// Frames that a value beside the names holds: a matrix either way round, rows in objects, or one
// list of all numbers.
bool read_matrix(const Json& json, const NameList& names, Curves& curves) {
  const std::size_t n = names.size();
  if (is_matrix(json, n)) {
    for (const Json& row : json) curves.frames.push_back(frame_of_row(row, names, curves));
    return true;
  }
  if (json.is_array() && json.size() == n && json[0].is_array() &&
      is_matrix(json, json[0].size())) {
    for (std::size_t f = 0; f < json[0].size(); ++f) {
      Json row = Json::array();
      for (std::size_t i = 0; i < n; ++i) row.push_back(json[i][f]);
      curves.frames.push_back(frame_of_row(row, names, curves));
    }
    return true;
  }
  if (json.is_array() && json.size() > n && json.size() % n == 0 && is_row(json, json.size())) {
    for (std::size_t f = 0; f < json.size(); f += n) {
      Json row = Json::array();
      for (std::size_t i = 0; i < n; ++i) row.push_back(json[f + i]);
      curves.frames.push_back(frame_of_row(row, names, curves));
    }
    return true;
  }
  if (!json.is_array() || json.empty() || !json[0].is_object()) return false;
  std::vector<CurveFrame> frames;
  for (const Json& one : json) {
    const auto members = one.items();
    const auto row = std::find_if(members.begin(), members.end(),
                                  [&](const auto& entry) { return is_row(entry.value, n); });
    if (row == members.end()) return false;
    frames.push_back(frame_of_row(row->value, names, curves));
    read_clock(one, frames.back());
  }
  curves.frames = std::move(frames);
  return true;
}

// Times in a list as long as the frames are many.
void read_times(const Json& object, Curves& curves) {
  for (const auto& [key, value] : object.items()) {
    const ClockUnit unit = clock_unit(key);
    if (unit == ClockUnit::none || unit == ClockUnit::frames || !value.is_array() ||
        value.size() != curves.frames.size()) {
      continue;
    }
    for (std::size_t i = 0; i < curves.frames.size(); ++i) {
      put_clock(key, value[i], curves.frames[i]);
    }
    return;
  }
}

// Values that hold frames for a list of names: beside it, or further out.
bool find_matrix(const Json& json, const NameList& names, Curves& curves, int depth = 0) {
  if (depth > 3) return false;
  if (read_matrix(json, names, curves)) return true;
  for (const auto& [key, value] : json.items()) {
    if (!value.is_structured() || !find_matrix(value, names, curves, depth + 1)) continue;
    read_times(json, curves);
    return true;
  }
  return false;
}

const Json* find_names(const Json& json, int depth = 0) {
  if (depth > 3) return nullptr;
  if (is_name_list(json)) return &json;
  for (const auto& [key, value] : json.items()) {
    if (const Json* found = find_names(value, depth + 1)) return found;
  }
  return nullptr;
}

// An object with a list of numbers for at least two shapes.
bool read_columns(const Json& json, Curves& curves) {
  std::size_t length = 0, known = 0;
  for (const auto& [key, value] : json.items()) {
    if (!fap::find_arkit(key) || !value.is_array() || !is_row(value, value.size())) continue;
    if (known > 0 && value.size() != length) return false;
    length = value.size();
    ++known;
  }
  if (known < 2) return false;
  curves.frames.resize(length);
  for (const auto& [key, value] : json.items()) {
    const auto channel = fap::find_arkit(key);
    if (!is_row(value, length)) continue;
    if (!channel) {
      if (clock_unit(key) == ClockUnit::none) note_unknown(curves, key);
      continue;
    }
    for (std::size_t i = 0; i < length; ++i) {
      curves.frames[i].values.emplace(*channel, weight_in(value[i]));
    }
  }
  read_times(json, curves);
  return true;
}

bool find_columns(const Json& json, Curves& curves, int depth = 0) {
  if (depth > 3 || !json.is_object()) return false;
  if (read_columns(json, curves)) return true;
  for (const auto& [key, value] : json.items()) {
    if (!find_columns(value, curves, depth + 1)) continue;
    if (!curves.frames.empty() && !curves.frames[0].seconds) read_times(json, curves);
    return true;
  }
  return false;
}

// {"name": "jawOpen", "value": 0.1}, whatever its members are called, or ["jawOpen", 0.1].
bool read_named_number(const Json& json, CurveFrame& frame) {
  if (json.is_array() && json.size() == 2 && json[0].is_string() && is_weight(json[1])) {
    const auto channel = fap::find_arkit(json[0].text());
    if (channel) frame.values.emplace(*channel, weight_in(json[1]));
    return channel.has_value();
  }
  const std::string* name = nullptr;
  for (const auto& [key, value] : json.items()) {
    if (value.is_string() && fap::find_arkit(value.text())) name = &value.text();
  }
  if (name == nullptr) return false;
  for (const auto& [key, value] : json.items()) {
    if (!is_weight(value) || clock_unit(key) == ClockUnit::frames) continue;
    frame.values.emplace(*fap::find_arkit(*name), weight_in(value));
    return true;
  }
  return false;
}

// Numbers by name, at any depth; of several faces the first one that has any.
void read_named(const Json& json, CurveFrame& frame, Curves& curves, int depth = 0) {
  if (depth > kDeepest) return;
  if (json.is_array()) {
    for (const Json& one : json) {
      if (read_named_number(one, frame)) continue;
      const bool had = !frame.values.empty();
      read_named(one, frame, curves, depth + 1);
      if (!had && !frame.values.empty()) return;
    }
    return;
  }
  // {"index": 0, "score": 0, "categoryName": "_neutral"}
  if (json.contains("categoryName") || json.contains("category_name")) return;
  if (depth <= 1) read_clock(json, frame);
  bool any = false;
  for (const auto& [key, value] : json.items()) {
    const auto channel = fap::find_arkit(key);
    if (channel && is_weight(value)) {
      frame.values.emplace(*channel, weight_in(value));
      any = true;
    }
  }
  for (const auto& [key, value] : json.items()) {
    if (any && value.is_number() && !fap::find_arkit(key) && clock_unit(key) == ClockUnit::none) {
      note_unknown(curves, key);
    }
    if (value.is_structured()) read_named(value, frame, curves, depth + 1);
  }
}

// Whether objects in a list are frames: numbers by name in one of them.
bool read_list(const Json& list, Curves& curves) {
  Curves read;
  std::size_t with_values = 0;
  for (const Json& one : list) {
    if (!one.is_structured() && !one.is_null()) return false;
    read.frames.emplace_back();
    read_named(one, read.frames.back(), read);
    with_values += read.frames.back().values.empty() ? 0 : 1;
  }
  // A list of {name, number} is a frame.
  CurveFrame alone;
  if (with_values == 0 || (!list.empty() && read_named_number(list[0], alone))) return false;
  curves.frames = std::move(read.frames);
  curves.unknown = std::move(read.unknown);
  return true;
}

// {"0": {...}, "1": {...}}: numbers of frames, or times.
bool read_numbered(const Json& json, Curves& curves) {
  if (json.size() < 2) return false;
  std::vector<std::pair<double, const Json*>> entries;
  bool whole = true;
  for (const auto& [key, value] : json.items()) {
    const auto number = dam::parse_number(key);
    if (!number || !value.is_structured()) return false;
    whole = whole && *number == std::floor(*number);
    entries.emplace_back(*number, &value);
  }
  std::sort(entries.begin(), entries.end());
  for (const auto& [number, value] : entries) {
    CurveFrame frame;
    read_named(*value, frame, curves);
    if (!frame.seconds && !frame.number) (whole ? frame.number : frame.seconds) = number;
    curves.frames.push_back(std::move(frame));
  }
  return std::any_of(curves.frames.begin(), curves.frames.end(),
                     [](const CurveFrame& frame) { return !frame.values.empty(); });
}

bool find_list(const Json& json, Curves& curves, int depth = 0) {
  if (depth > 3) return false;
  if (json.is_array() && json.size() > 1 && read_list(json, curves)) return true;
  if (json.is_object() && read_numbered(json, curves)) return true;
  curves.frames.clear();
  for (const auto& [key, value] : json.items()) {
    if (value.is_structured() && find_list(value, curves, depth + 1)) return true;
  }
  if (json.is_array() && json.size() == 1) return find_list(json[0], curves, depth + 1);
  return false;
}

bool read_alone(const Json& json, Curves& curves) {
  CurveFrame frame;
  read_named(json, frame, curves);
  if (frame.values.size() < 2) return false;
  curves.frames.push_back(std::move(frame));
  return true;
}

// The order of Azure Speech ("Get facial position with viseme"): ARKit's, but left before right
// where ARKit has both ways of the jaw and of the mouth, and three turns.
NameList azure_names() {
  NameList names(fap::kArkitNames.begin(), fap::kArkitNames.begin() + fap::kArkitShapeCount);
  for (const char* left : {"jawLeft", "mouthLeft"}) {
    const auto at = std::find(names.begin(), names.end(), left);
    std::iter_swap(at, at - 1);
  }
  names.insert(names.end(), {"headRoll", "leftEyeRoll", "rightEyeRoll"});
  return names;
}

// Pieces of Azure's frames, in lists, or as text in the events of its visemes.
bool read_azure(const Json& json, Curves& curves, int depth = 0) {
  if (depth > 4) return false;
  if (json.is_string() && json.text().starts_with('{') &&
      json.text().find("BlendShapes") != std::string::npos) {
    const Result<Json> inside = Json::parse(json.text());
    return inside && read_azure(*inside, curves, depth + 1);
  }
  if (json.is_array()) {
    bool any = false;
    for (const Json& one : json) any = read_azure(one, curves, depth + 1) || any;
    return any;
  }
  for (const auto& [key, value] : json.items()) {
    if (plain_key(key) != "blendshapes" || !is_matrix(value, kAzureRow)) continue;
    static const NameList kNames = azure_names();
    double number = double(curves.frames.size());
    for (const auto& [other, index] : json.items()) {
      if (clock_unit(other) == ClockUnit::frames) number = number_in(index).value_or(number);
    }
    for (const Json& row : value) {
      curves.frames.push_back(frame_of_row(row, kNames, curves));
      curves.frames.back().number = number++;
    }
    curves.rate = curves.rate.value_or(kAzureRate);
    return true;
  }
  bool any = false;
  for (const auto& [key, value] : json.items()) {
    any = read_azure(value, curves, depth + 1) || any;
  }
  return any;
}

// {"jawOpen": {"0": 0.1, ...}, ...}, [{"name": "jawOpen", "keys": [...]}, ...] and the like.
bool find_series(const Json& json, Curves& curves) {
  const auto series = find_json_series(json);
  if (!series) return false;
  for (std::size_t i = 0; i < series->at.size(); ++i) {
    CurveFrame frame;
    (series->seconds ? frame.seconds : frame.number) = series->at[i];
    frame.values = series->values[i];
    curves.frames.push_back(std::move(frame));
  }
  return true;
}

// Enough digits for milliseconds since 1970.
std::string cell_of_time(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.15g", value);
  return text;
}

ShapeTable curves_table(Curves& curves) {
  const auto all = [&](auto holds) {
    return std::all_of(curves.frames.begin(), curves.frames.end(), holds);
  };
  const bool timecodes = all([](const CurveFrame& frame) { return !frame.timecode.empty(); });
  const bool times = all([](const CurveFrame& frame) { return frame.seconds.has_value(); });
  const bool numbers = all([](const CurveFrame& frame) { return frame.number.has_value(); });
  // Writers that gather frames from several threads do not keep their order.
  if (times || numbers) {
    std::stable_sort(curves.frames.begin(), curves.frames.end(),
                     [&](const CurveFrame& a, const CurveFrame& b) {
                       return times ? *a.seconds < *b.seconds : *a.number < *b.number;
                     });
  }
  fap::ArkitChannels used;
  for (const CurveFrame& frame : curves.frames) {
    for (const auto& [channel, value] : frame.values) used.set(std::size_t(channel));
  }
  const bool clock = times || timecodes || curves.rate;
  ShapeTableWriter table(clock ? "time_s" : numbers ? "frame" : "row", used);
  std::size_t lost = 0;
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    const CurveFrame& frame = curves.frames[i];
    if (frame.values.empty()) {
      ++lost;
      continue;
    }
    fap::ArkitFrame values{};
    for (const auto& [channel, value] : frame.values) values[std::size_t(channel)] = value;
    const double at = numbers ? *frame.number : double(i);
    const double time = times ? *frame.seconds : curves.rate ? at / *curves.rate : at;
    table.add(timecodes && !times ? frame.timecode : cell_of_time(time), values);
  }
  ShapeTable out{table.take(), {}};
  if (lost > 0) out.warnings.push_back("frames without a face, skipped: " + std::to_string(lost));
  if (!curves.unknown.empty()) {
    out.warnings.push_back("shapes that are not ARKit's are ignored: " +
                           list_of_names(curves.unknown));
  }
  return out;
}

bool find_any(const Json& root, Curves& curves) {
  if (read_azure(root, curves)) return true;
  if (const Json* list = find_names(root)) {
    NameList names;
    for (const Json& one : *list) names.push_back(one.text());
    if (find_matrix(root, names, curves)) return true;
  }
  const auto fresh = [&] { curves = {{}, curves.rate, {}}; };
  fresh();
  if (find_columns(root, curves)) return true;
  fresh();
  if (find_series(root, curves)) return true;
  fresh();
  if (find_list(root, curves)) return true;
  fresh();
  return read_alone(root, curves);
}

}  // namespace

std::optional<ShapeTable> find_json_curves(const Json& root) {
  Curves curves;
  curves.rate = find_rate(root);
  if (!find_any(root, curves)) return std::nullopt;
  return curves_table(curves);
}

bool looks_like_json_curves(std::string_view text) {
  if (!is_json(text)) return false;
  text = text.substr(0, kLookAt);
  int known = 0;
  std::string_view last;
  for (std::size_t at = text.find('"'); at != std::string_view::npos;) {
    const std::size_t end = text.find('"', at + 1);
    if (end == std::string_view::npos) break;
    std::string_view word = text.substr(at + 1, end - at - 1);
    while (word.ends_with('\\')) word.remove_suffix(1);  // JSON in a text
    if (word == "BlendShapes" || (word != last && word.size() < 64 && fap::find_arkit(word))) {
      known += word == "BlendShapes" ? 2 : 1;
      last = word;
    }
    if (known >= 2) return true;
    at = end;  // in a text within JSON, quotes do not come in pairs
  }
  return false;
}

}  // namespace animeme::exchange
