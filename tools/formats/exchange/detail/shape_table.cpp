#include "tools/formats/exchange/detail/shape_table.h"

#include <cmath>
#include <cstdio>

namespace animeme::exchange {

std::string cell_of(double value) {
  if (std::isnan(value)) return {};
  if (!std::isfinite(value)) return "0";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

ShapeTableWriter::ShapeTableWriter(std::string_view first, const fap::ArkitChannels& used)
    : used_(used), has_first_(!first.empty()) {
  if (has_first_) add_cell(first);
  for (std::size_t c = 0; c < used_.size(); ++c) {
    if (used_[c]) add_cell(fap::kArkitNames[c]);
  }
}

void ShapeTableWriter::add(std::string_view first, const fap::ArkitFrame& values) {
  table_ += '\n';
  begun_ = false;
  if (has_first_) add_cell(first);
  for (std::size_t c = 0; c < used_.size(); ++c) {
    if (used_[c]) add_cell(cell_of(values[c]));
  }
}

void ShapeTableWriter::add_cell(std::string_view text) {
  if (begun_) table_ += ',';
  begun_ = true;
  table_ += text;
}

}  // namespace animeme::exchange
