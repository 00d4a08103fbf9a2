#include "tools/commands/curve_text.h"

#include <cstdio>

namespace animeme::tools {

std::string curve_header(std::span<const std::string> names) {
  std::string text = "time_s";
  for (const std::string& name : names) text += "," + name;
  return text + "\n";
}

std::string curve_row(const dam::Signal& signal, std::size_t frame) {
  char number[40];
  std::snprintf(number, sizeof number, "%.6f", signal.time(frame));
  std::string text = number;
  for (std::size_t control = 0; control < signal.names.size(); ++control) {
    std::snprintf(number, sizeof number, ",%.6g", signal.at(frame, control));
    text += number;
  }
  return text + "\n";
}

}  // namespace animeme::tools
