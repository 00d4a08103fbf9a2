// Captures of other forms as one table of ARKit's shapes.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fap/arkit.h"

namespace animeme::exchange {

/// A capture as read_arkit_table() reads it.
struct ShapeTable {
  std::string table;                  ///< with a header line
  std::vector<std::string> warnings;  ///< what was left out or assumed
};

/// Writes the table row by row.
class ShapeTableWriter {
 public:
  /// `first`: the name of the column before the shapes, "time_s" or "frame"; empty: there is none.
  ShapeTableWriter(std::string_view first, const fap::ArkitChannels& used);
  /// A row; `first` is the cell before the shapes. Values that are not finite are 0.
  void add(std::string_view first, const fap::ArkitFrame& values);
  /// The table.
  std::string take() { return std::move(table_) + "\n"; }

 private:
  void add_cell(std::string_view text);

  fap::ArkitChannels used_;
  bool has_first_;
  bool begun_ = false;  // the row has a cell
  std::string table_;
};

/// A number as a cell; NaN is an empty one, infinity 0.
std::string cell_of(double value);

}  // namespace animeme::exchange
