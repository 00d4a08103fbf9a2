#include "tools/formats/exchange/curves.h"

#include <cstdio>
#include <utility>

#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/detail/action_units.h"
#include "tools/formats/exchange/detail/face_packets.h"
#include "tools/formats/exchange/detail/json_landmarks.h"
#include "tools/formats/exchange/detail/table.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

namespace {

// Of another form: JSON, action units.
Result<Imported> read_converted(Result<ShapeTable> table) {
  if (!table) return std::move(table).error();
  Result<Imported> read = read_arkit_table(table->table);
  if (!read) return read;
  read->warnings.insert(read->warnings.begin(), table->warnings.begin(), table->warnings.end());
  return read;
}

}  // namespace

Result<Imported> read_any_table(std::string_view text) {
  if (is_json(text)) {
    Result<JsonTable> json = json_to_table(text, true);
    if (!json) return std::move(json).error();
    return read_converted(ShapeTable{std::move(json->table), std::move(json->warnings)});
  }
  if (is_face_packets(text)) return read_converted(face_packets_to_shapes(text));
  if (is_arkit_table(text)) return read_arkit_table(text);
  if (is_landmark_table(text)) {
    auto take = import_landmarks(text);
    if (!take) return take.error();
    return Imported{std::move(take->face.clip), std::move(take->warnings)};
  }
  if (is_action_unit_table(first_line(text))) return read_converted(action_units_to_shapes(text));
  const Result<dam::Signal> signal = dam::read_curves(text);
  if (!signal) return signal.error();
  auto clip = dam::to_sequence(*signal);
  if (!clip) return clip.error();
  return Imported{std::move(*clip), {}};
}

std::string write_curve_header(std::span<const std::string> names) {
  std::string text = "time_s";
  for (const std::string& name : names) text += "," + name;
  return text + "\n";
}

std::string write_curve_row(const dam::Signal& signal, std::size_t frame) {
  char number[40];
  std::snprintf(number, sizeof number, "%.6f", signal.time(frame));
  std::string text = number;
  for (std::size_t control = 0; control < signal.names.size(); ++control) {
    std::snprintf(number, sizeof number, ",%.6g", signal.at(frame, control));
    text += number;
  }
  return text + "\n";
}

std::string write_curves(const dam::Signal& signal) {
  const bool marked = !signal.measured.empty();
  std::string text = write_curve_header(signal.names);
  if (marked) text.insert(text.size() - 1, ",measured");
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    text += write_curve_row(signal, i);
    if (marked) text.insert(text.size() - 1, signal.measured[i] ? ",1" : ",0");
  }
  return text;
}

}  // namespace animeme::exchange
