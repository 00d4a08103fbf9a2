#include "tools/formats/exchange/detail/json_landmarks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "tools/formats/common/json.h"
#include "tools/formats/exchange/detail/json_curves.h"
#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {

namespace {

using tools::Json;

// Names, in lower case and without "_", of what holds frames, points, shapes and times.
constexpr std::string_view kFrames[] = {"frames", "results", "data", "detections"};
constexpr std::string_view kPoints[] = {"facelandmarks", "landmarks", "multifacelandmarks",
                                        "keypoints",     "points",    "scaledmesh",
                                        "shape"};
constexpr std::string_view kShapes[] = {"faceblendshapes", "blendshapes"};
constexpr std::string_view kFaces[] = {"faces"};
constexpr std::string_view kSeconds[] = {"times", "time", "timestamp", "t", "seconds"};
constexpr std::string_view kMilliseconds[] = {"timestampms", "timems", "ms", "milliseconds"};
constexpr std::string_view kNumbers[] = {"frame", "framenumber", "frameindex", "index"};

std::string plain(std::string_view name) {
  std::string out = lower_case(name);
  std::erase(out, '_');
  return out;
}

template <std::size_t N>
const Json* member(const Json& object, const std::string_view (&names)[N]) {
  if (!object.is_object()) return nullptr;
  for (const std::string_view name : names) {
    for (const auto& [key, value] : object.items()) {
      if (plain(key) == name) return &value;
    }
  }
  return nullptr;
}

using Place = std::array<double, 3>;

// One point: {"x": 1, "y": 2, "z": 3} or [1, 2, 3]; z may be missing (NaN).
std::optional<Place> place_of(const Json& json) {
  Place place = {std::nan(""), std::nan(""), std::nan("")};
  if (json.is_array() && (json.size() == 2 || json.size() == 3)) {
    for (std::size_t i = 0; i < json.size(); ++i) {
      if (!json[i].is_number() && !json[i].is_null()) return std::nullopt;
      if (json[i].is_number()) place[i] = json[i].get<double>();
    }
    return place;
  }
  if (!json.is_object() || !json.contains("x") || !json.contains("y")) return std::nullopt;
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json* value = json.find(kAxes[i]);
    if (value == nullptr || value->is_null()) continue;
    if (!value->is_number()) return std::nullopt;
    place[i] = value->get<double>();
  }
  return place;
}

bool is_points(const Json& json) {
  return json.is_array() && json.size() > 3 && place_of(json[0]).has_value();
}

// The points of the first face: an array of points, of faces, or an object that holds one.
const Json* points_of(const Json& frame, int depth = 0) {
  if (depth > 4) return nullptr;
  if (is_points(frame)) return &frame;
  if (frame.is_array()) return frame.empty() ? nullptr : points_of(frame[0], depth + 1);
  for (const Json* inside : {member(frame, kPoints), member(frame, kFaces)}) {
    if (inside == nullptr) continue;
    if (const Json* points = points_of(*inside, depth + 1)) return points;
  }
  return nullptr;
}

struct Frame {
  std::optional<double> seconds, number;
  const Json* points = nullptr;
};

std::optional<double> number_of(const Json* json) {
  if (json == nullptr || !json->is_number()) return std::nullopt;
  return json->get<double>();
}

Frame read_frame(const Json& json) {
  Frame frame;
  frame.seconds = number_of(member(json, kSeconds));
  if (!frame.seconds) {
    if (const auto ms = number_of(member(json, kMilliseconds))) frame.seconds = *ms / 1000;
  }
  frame.number = number_of(member(json, kNumbers));
  frame.points = points_of(json);
  return frame;
}

Error syntax_at(std::size_t frame, const std::string& what) {
  return make_error(Code::syntax, "frame " + std::to_string(frame) + ": " + what);
}

std::string field(double value) {
  if (!std::isfinite(value)) return {};
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// Times if all frames have them, else numbers if all do.
struct Clock {
  bool seconds = true, numbers = true;
  explicit Clock(const std::vector<Frame>& frames) {
    for (const Frame& frame : frames) {
      seconds = seconds && frame.seconds;
      numbers = numbers && frame.number;
    }
  }
  std::string header() const { return seconds ? "time_s" : numbers ? "frame" : "row"; }
  std::string field_of(const Frame& frame, std::size_t row) const {
    return field(seconds ? *frame.seconds : numbers ? *frame.number : double(row));
  }
};

// Numbers of the points that a layout uses; of other sets all, which the reader refuses.
std::vector<int> points_used(std::size_t count, std::optional<fap::LandmarkLayout>& layout) {
  if (count == 68) layout = fap::LandmarkLayout::ibug68;
  if (count == 468 || count == 478) layout = fap::LandmarkLayout::mediapipe;
  std::set<int> used;
  if (layout) {
    for (const fap::LandmarkSource& source : fap::landmark_sources(*layout)) {
      for (const int one : {source.landmark, source.second}) {
        if (one >= 0 && std::size_t(one) < count) used.insert(one);
      }
    }
  } else {
    for (std::size_t i = 0; i < count; ++i) used.insert(int(i));
  }
  return {used.begin(), used.end()};
}

Result<void> write_points(const std::vector<Frame>& frames, JsonTable& out) {
  std::size_t count = 0;
  bool depth = false;
  for (const Frame& frame : frames) {
    if (frame.points == nullptr || count > 0) continue;
    count = frame.points->size();
    depth = !std::isnan((*place_of((*frame.points)[0]))[2]);
  }
  const std::vector<int> used = points_used(count, out.layout);
  const Clock clock(frames);
  out.table = clock.header() + ",confidence";
  for (const int i : used) {
    for (const char* axis : {",x_", ",y_", ",z_"}) {
      if (axis[1] != 'z' || depth) out.table += axis + std::to_string(i);
    }
  }
  for (std::size_t row = 0; row < frames.size(); ++row) {
    const Json* points = frames[row].points;
    if (points != nullptr && points->size() != count) {
      return syntax_at(row, std::to_string(points->size()) + " points where the first frame has " +
                                std::to_string(count));
    }
    out.table += "\n" + clock.field_of(frames[row], row) + (points != nullptr ? ",1" : ",0");
    for (const int i : used) {
      Place place = {std::nan(""), std::nan(""), std::nan("")};
      if (points != nullptr) {
        const auto read = place_of((*points)[std::size_t(i)]);
        if (!read) return syntax_at(row, "point " + std::to_string(i) + " has no x and y");
        place = *read;
      }
      for (std::size_t axis = 0; axis < (depth ? 3U : 2U); ++axis) {
        out.table += "," + field(place[axis]);
      }
    }
  }
  out.table += "\n";
  return {};
}

// NaN and Infinity, which Python writes and JSON does not have, become null.
std::string without_nan(std::string_view text) {
  std::string out;
  bool inside = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') inside = !inside;
    if (inside && c == '\\' && i + 1 < text.size()) {
      out += c;
      out += text[++i];
      continue;
    }
    std::string_view word;
    for (const std::string_view one : {"NaN", "-NaN", "Infinity", "-Infinity"}) {
      if (!inside && text.substr(i).starts_with(one)) word = one;
    }
    out += word.empty() ? std::string_view(&c, 1) : "null";
    if (!word.empty()) i += word.size() - 1;
  }
  return out;
}

// The frames of a value, or of one value a line.
Result<Json> parse(std::string_view text) {
  Result<Json> json = Json::parse(text, {.sorted = true});
  if (json) return json;
  std::string plain;
  if (text.find("NaN") != std::string_view::npos || text.find("Infinity") != text.npos) {
    plain = without_nan(text);
    text = plain;
    json = Json::parse(text, {.sorted = true});
    if (json) return json;
  }
  Json lines = Json::array();
  for (const dam::TableLine& line : dam::table_lines(text)) {
    Result<Json> one = Json::parse(line.text, {.sorted = true});
    if (!one) {
      const bool first = lines.empty();
      return error_at_line(Code::syntax,
                           first ? "this begins like JSON but is invalid; is it complete?"
                                 : "this line is not JSON; was the file cut off?",
                           std::int64_t(line.number));
    }
    lines.push_back(std::move(*one));
  }
  return lines;
}

}  // namespace

bool is_json(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && (text[first] == '{' || text[first] == '[');
}

Result<JsonTable> json_to_table(std::string_view text, bool shapes) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const Result<Json> root = parse(text);
  if (!root) return root.error();
  const Json* list = member(*root, kFrames);
  if (list == nullptr) list = &*root;
  JsonTable out;
  std::vector<Frame> frames;
  // An array of points is one frame, not a list of frames.
  if (list->is_array() && !is_points(*list)) {
    for (const Json& one : *list) frames.push_back(read_frame(one));
  } else {
    frames.push_back(read_frame(*list));
  }
  if (frames.empty()) return make_error(Code::truncated, "the JSON has no frames");
  constexpr std::string_view kWidth[] = {"width", "videowidth", "imagewidth"};
  constexpr std::string_view kHeight[] = {"height", "videoheight", "imageheight"};
  const auto width = number_of(member(*root, kWidth));
  const auto height = number_of(member(*root, kHeight));
  if (width && height && *width > 0 && *height > 0) out.size = PictureSize{*width, *height};
  const bool points = std::any_of(frames.begin(), frames.end(),
                                  [](const Frame& frame) { return frame.points != nullptr; });
  std::optional<ShapeTable> curves;
  if (shapes || !points) curves = find_json_curves(*root);
  // Members for faces, all of them empty.
  const auto asks = [](const Json& one) {
    const Json* places = member(one, kPoints);
    const Json* weights = member(one, kShapes);
    return (places != nullptr || weights != nullptr) && (places == nullptr || places->empty()) &&
           (weights == nullptr || weights->empty());
  };
  const auto members = list->items();
  const bool asked =
      std::any_of(list->begin(), list->end(), asks) ||
      std::any_of(members.begin(), members.end(), [&](const auto& one) { return asks(one.value); });
  if (!points && !curves && asked) {
    return make_error(Code::truncated, "the tracker found no face in any of " +
                                           std::to_string(frames.size()) + " frames");
  }
  if (!points && !curves) {
    return make_error(Code::not_found,
                      "the JSON has neither landmarks (faceLandmarks, landmarks, keypoints: arrays "
                      "of {x, y, z}) nor names of ARKit's blend shapes (jawOpen, EyeBlinkLeft ...) "
                      "with numbers");
  }
  if (curves) {
    out.table = std::move(curves->table);
    out.warnings = std::move(curves->warnings);
  } else if (auto ok = write_points(frames, out); !ok) {
    return ok.error();
  }
  return out;
}

}  // namespace animeme::exchange
