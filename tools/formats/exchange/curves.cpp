#include "tools/formats/exchange/curves.h"

#include <cstdio>
#include <utility>

#include "dam/corpus/corpus.h"
#include "dam/signal/fap_signal.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/landmarks.h"

namespace animeme::exchange {

Result<Imported> read_any_table(std::string_view text) {
  if (is_arkit_table(text)) return read_arkit_table(text);
  if (is_landmark_table(text)) {
    auto take = import_landmarks(text);
    if (!take) return take.error();
    return Imported{std::move(take->face.clip), std::move(take->warnings)};
  }
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
