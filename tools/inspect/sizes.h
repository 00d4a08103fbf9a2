/// @file
/// How small a clip gets: the form that is common in the wild beside the preset `file`.
#pragma once

#include <string>
#include <vector>

#include "fap/frame.h"
#include "fap/result.h"

namespace animeme::inspect {

/// Sizes of one clip, in bits with all headers.
struct ClipSizes {
  std::string name;          ///< of the file
  std::size_t planes = 0;    ///< coded
  double all_bits = 0;       ///< all 66 FAPs coded in ranges of +-1860 at fap_quant 1
  double file_bits = 0;      ///< preset file, the same values after filling in
  bool same_values = false;  ///< that they are the same, decoded and filled in
  double floor_bits = 0;     ///< a bound for these values, see floor_of()
  double limited_bits = 0;   ///< preset file with a limit of the error
  int limited_quant = 0;     ///< fap_quant that was chosen for it
  double limited_rms = 0;    ///< FAP units, over the FAPs that move and are no angles
  double floor_ratio() const { return floor_bits / all_bits; }  ///< bound : common form
  double file_ratio() const { return file_bits / all_bits; }    ///< preset file : common form
  /// With a limited error : common form.
  double limited_ratio() const { return limited_bits / all_bits; }
};

/// Codes a clip in the three forms; `max_rms` as in fba::EncodeOptions. Errors: those of encode().
Result<ClipSizes> measure_sizes(const std::string& name, const fap::Sequence& clip, double max_rms);

/// The heading of a table of sizes, and the row of a clip; they end with a line end.
std::string sizes_heading();
std::string sizes_row(const ClipSizes& clip);  ///< likewise
/// The last row, with the means of all clips (one at least), and what the columns are.
std::string sizes_means(const std::vector<ClipSizes>& clips, double max_rms);
/// All of it as JSON text.
std::string sizes_json(const std::vector<ClipSizes>& clips, double max_rms);

}  // namespace animeme::inspect
