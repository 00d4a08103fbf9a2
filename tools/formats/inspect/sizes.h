/// @file
/// Sizes of a clip: the form common in the wild compared with the presets.
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
  double file_bits = 0;      ///< preset file, with the same values after filling in
  bool same_values = false;  ///< whether they are, decoded and filled in
  double floor_bits = 0;     ///< a bound for these values, see floor_of()
  double kept_bits = 0;      ///< preset file with kept ranges
  double live5_bits = 0;     ///< preset live with a random access point every 5 s ...
  double live1_bits = 0;     ///< ... every second
  double seconds = 0;        ///< duration of the clip
  double limited_bits = 0;   ///< preset file with limited error
  int limited_quant = 0;     ///< its fap_quant
  double limited_rms = 0;    ///< FAP units, over the moving FAPs except angles
  double floor_ratio() const { return floor_bits / all_bits; }       ///< bound : common form
  double file_ratio() const { return file_bits / all_bits; }         ///< preset file : common form
  double kept_ratio() const { return kept_bits / file_bits; }        ///< kept ranges : preset file
  double live5_ratio() const { return live5_bits / file_bits; }      ///< preset live : preset file
  double live1_ratio() const { return live1_bits / file_bits; }      ///< likewise
  double live1_kbps() const { return live1_bits / seconds / 1000; }  ///< kbit/s
  /// With a limited error : common form.
  double limited_ratio() const { return limited_bits / all_bits; }
};

/// Encodes a clip in these forms, at `quant` except for the common one; `max_rms` as in
/// fba::EncodeOptions. Errors: those of encode().
Result<ClipSizes> measure_sizes(const std::string& name, const fap::Sequence& clip, int quant,
                                double max_rms);

/// Heading and rows of a table of sizes, each with a line end.
std::string sizes_heading();
std::string sizes_row(const ClipSizes& clip);  ///< likewise
/// The last row, with the means of all clips (at least one), and an explanation of the columns.
std::string sizes_means(const std::vector<ClipSizes>& clips, int quant, double max_rms);
/// The sizes as JSON text.
std::string sizes_json(const std::vector<ClipSizes>& clips, int quant, double max_rms);

}  // namespace animeme::inspect
