#include "tools/formats/exchange/detail/action_units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fap/arkit.h"
#include "tools/formats/exchange/detail/plain_table.h"
#include "tools/formats/exchange/detail/table.h"

namespace animeme::exchange {

namespace {

constexpr double kStrongest = 5;  // intensity E of FACS
constexpr std::size_t kFewest = 3;

// Shapes of a unit at its strongest. A pair has its left shape alone; the right one does the same.
struct ActionUnit {
  int number;
  std::array<std::string_view, 3> shapes;
  double share = 1;
};

constexpr ActionUnit kActionUnits[] = {
    {1, {"browInnerUp"}},
    {2, {"browOuterUpLeft"}},
    {4, {"browDownLeft"}},
    {5, {"eyeWideLeft"}},
    {6, {"cheekSquintLeft"}},
    {7, {"eyeSquintLeft"}},
    {9, {"noseSneerLeft"}},
    // FaceKit lists mouthShrugUpper, which also presses the lips together.
    {10, {"mouthUpperUpLeft"}},
    {11, {"mouthUpperUpLeft"}, 0.5},
    {12, {"mouthSmileLeft"}},
    {14, {"mouthDimpleLeft"}},
    {15, {"mouthFrownLeft"}},
    {16, {"mouthLowerDownLeft"}},
    {17, {"mouthShrugLower"}},
    {18, {"mouthPucker"}},
    {20, {"mouthStretchLeft"}},
    {22, {"mouthFunnel"}},
    {23, {"mouthPressLeft"}, 0.5},
    {24, {"mouthPressLeft"}},
    // The lips part, the jaw hardly moves.
    {25, {"mouthLowerDownLeft", "mouthUpperUpLeft"}, 0.35},
    {26, {"jawOpen"}, 0.6},
    {27, {"jawOpen"}},
    {28, {"mouthRollLower", "mouthRollUpper"}},
    {29, {"jawForward"}},
    {33, {"cheekPuff"}},
    {43, {"eyeBlinkLeft"}},
    {45, {"eyeBlinkLeft"}}};

// OpenFace's angles in rad: x of the gaze to the right of the picture, y down; the head's about its
// axes to the right, down and away. They are those of Live Link Face, whose roll has another sign.
struct UnitAngle {
  std::string_view column;
  std::array<std::string_view, 2> channels;
  double sign;
};

constexpr UnitAngle kUnitAngles[] = {{"gaze_angle_x", {"leftEyeYaw", "rightEyeYaw"}, -1},
                                     {"gaze_angle_y", {"leftEyePitch", "rightEyePitch"}, 1},
                                     {"pose_rx", {"headPitch"}, 1},
                                     {"pose_ry", {"headYaw"}, 1},
                                     {"pose_rz", {"headRoll"}, 1}};

// "AU12_r": 12 and 'r'; "AU12", "au12": 12 and nothing.
struct UnitColumn {
  int number = 0;
  char kind = 0;
};

std::optional<UnitColumn> unit_of(std::string_view name) {
  const std::string text = lower_case(name);
  if (!text.starts_with("au") || text.size() < 3) return std::nullopt;
  UnitColumn unit;
  std::size_t i = text[2] == '_' ? 3 : 2;
  const std::size_t first = i;
  while (i < text.size() && text[i] >= '0' && text[i] <= '9' && i < first + 2) {
    unit.number = unit.number * 10 + (text[i++] - '0');
  }
  if (i == first) return std::nullopt;
  const std::string rest = text.substr(i);
  if (rest == "_r" || rest == "_c") {
    unit.kind = rest[1];
  } else if (rest == "_intensity") {
    unit.kind = 'r';
  } else if (!rest.empty()) {
    return std::nullopt;
  }
  return unit;
}

const ActionUnit* find_unit(int number) {
  const auto found = std::find_if(std::begin(kActionUnits), std::end(kActionUnits),
                                  [&](const ActionUnit& unit) { return unit.number == number; });
  return found == std::end(kActionUnits) ? nullptr : found;
}

struct UnitColumns {
  struct Used {
    std::size_t field;
    const ActionUnit* unit;
    char kind;
  };
  std::vector<Used> units;
  std::vector<std::pair<std::size_t, const UnitAngle*>> angles;
  std::optional<std::size_t> time, success, face;
  std::size_t frame = 0;
  bool has_frame = false;
  std::vector<std::string> unknown;
};

UnitColumns unit_columns(const Row& header) {
  UnitColumns columns;
  std::vector<std::pair<int, std::size_t>> presences;
  const auto has = [&](int number) {
    return std::any_of(columns.units.begin(), columns.units.end(),
                       [&](const UnitColumns::Used& used) { return used.unit->number == number; });
  };
  for (std::size_t i = 0; i < header.size(); ++i) {
    const std::string name = lower_case(header.text(i));
    if (const auto column = unit_of(name)) {
      const ActionUnit* unit = find_unit(column->number);
      if (unit == nullptr) {
        columns.unknown.emplace_back(header.text(i));
      } else if (column->kind == 'c') {
        presences.emplace_back(column->number, i);
      } else if (!has(column->number)) {
        columns.units.push_back({i, unit, column->kind});
      }
      continue;
    }
    if (is_time_name(name) && !columns.time) columns.time = i;
    if (name == "success") columns.success = i;
    if (name == "face_id" || name == "face") columns.face = i;
    if (is_frame_name(name)) {
      columns.frame = i;
      columns.has_frame = true;
    }
    for (const UnitAngle& angle : kUnitAngles) {
      if (name == angle.column) columns.angles.emplace_back(i, &angle);
    }
  }
  for (const auto& [number, field] : presences) {
    if (!has(number)) columns.units.push_back({field, find_unit(number), 'c'});
  }
  return columns;
}

// Calls `use` with each channel that a unit moves.
template <class Use>
void for_channels(const ActionUnit& unit, Use use) {
  for (const std::string_view shape : unit.shapes) {
    const auto channel = fap::find_arkit(shape);
    if (!channel) continue;
    use(std::size_t(*channel));
    if (const auto other = fap::arkit_other_side(*channel)) use(std::size_t(*other));
  }
}

// The same with those of an angle.
template <class Use>
void for_channels(const UnitAngle& angle, Use use) {
  for (const std::string_view name : angle.channels) {
    if (const auto channel = fap::find_arkit(name)) use(std::size_t(*channel));
  }
}

// The intensity that is a full unit, by the kind of its column.
double strongest(const std::vector<dam::TableLine>& lines, char separator,
                 const UnitColumns& columns) {
  double most = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Row row(lines[i], separator);
    for (const UnitColumns::Used& used : columns.units) {
      if (used.kind == 'c' || used.field >= row.size()) continue;
      if (used.kind == 'r') return kStrongest;
      most = std::max(most, row.number(used.field).value_or(0));
    }
  }
  return most > 1 ? kStrongest : 1;
}

}  // namespace

bool is_action_unit_table(std::string_view header) {
  const Row names({1, header}, separator_of(header));
  std::size_t known = 0;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto unit = unit_of(names.text(i));
    known += unit && find_unit(unit->number) != nullptr ? 1 : 0;
  }
  return known >= kFewest;
}

Result<ShapeTable> action_units_to_shapes(std::string_view text) {
  const auto lines = dam::table_lines(text);
  if (lines.size() < 2) {
    return make_error(Code::truncated, "there is no row after the header line");
  }
  const char separator = separator_of(lines[0].text);
  const Row header(lines[0], separator);
  const UnitColumns columns = unit_columns(header);
  const double full = strongest(lines, separator, columns);
  fap::ArkitChannels used;
  const auto use = [&](std::size_t channel) { used.set(channel); };
  for (const UnitColumns::Used& one : columns.units) for_channels(*one.unit, use);
  for (const auto& [field, angle] : columns.angles) for_channels(*angle, use);
  ShapeTableWriter table(columns.time ? "time_s" : columns.has_frame ? "frame" : "row", used);
  std::size_t lost = 0, others = 0;
  std::optional<double> face;  // the first one's number
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const Row row(lines[i], separator);
    if (auto ok = row.check_size(header.size()); !ok) return ok.error();
    if (columns.face && !face) face = row.number(*columns.face);
    if (face && row.number(*columns.face) != face) {
      ++others;
      continue;
    }
    const bool nothing = std::all_of(
        columns.units.begin(), columns.units.end(),
        [&](const UnitColumns::Used& unit) { return is_missing(row.text(unit.field)); });
    if (nothing || (columns.success && row.number(*columns.success) == 0.0)) {
      ++lost;
      continue;
    }
    fap::ArkitFrame frame{};
    for (const UnitColumns::Used& one : columns.units) {
      const bool missing = is_missing(row.text(one.field));  // its shapes are, too
      const auto value = missing ? std::nan("") : row.number(one.field);
      if (!missing && (!value || !std::isfinite(*value))) {
        return row.wrong(one.field, std::string(header.text(one.field)),
                         "not a finite number; correct it or remove the line");
      }
      const double weight = *value / (one.kind == 'c' ? 1 : full) * one.unit->share;
      for_channels(*one.unit, [&](std::size_t channel) {
        const double sum = frame[channel] + weight;
        frame[channel] = std::isnan(sum) ? sum : std::clamp(sum, 0.0, 1.0);
      });
    }
    for (const auto& [field, angle] : columns.angles) {
      const double value = angle->sign * row.number(field).value_or(0);
      for_channels(*angle, [&](std::size_t channel) { frame[channel] = value; });
    }
    table.add(columns.time        ? std::string(row.text(*columns.time))
              : columns.has_frame ? std::string(row.text(columns.frame))
                                  : std::to_string(i - 1),
              frame);
  }
  ShapeTable out{table.take(), {}};
  out.warnings.push_back("these are " + std::to_string(columns.units.size()) +
                         " action units without points of the face, which say less of the lips; "
                         "OpenFace writes the points with FeatureExtraction -2Dfp -3Dfp");
  if (lost > 0) out.warnings.push_back("rows without a face, skipped: " + std::to_string(lost));
  if (others > 0) {
    out.warnings.push_back("rows of other faces than the first, skipped: " +
                           std::to_string(others));
  }
  if (!columns.unknown.empty()) {
    out.warnings.push_back("action units without a shape are ignored: " +
                           list_of_names(columns.unknown));
  }
  return out;
}

}  // namespace animeme::exchange
