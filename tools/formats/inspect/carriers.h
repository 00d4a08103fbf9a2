/// @file
/// Compares protocols for a face: bits and errors of FBA, ARKit weights, Live Link, VMC, ARF and
/// JSON for a clip.
///
/// Sizes are those of real messages (carrier_messages.h). Errors are millimetres on one head;
/// carriers with adjustable precision are compared at the same error.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fap/arkit.h"
#include "fap/frame.h"
#include "fap/result.h"
#include "tools/formats/inspect/carrier_messages.h"

namespace animeme::inspect {

/// Options of measure_carriers().
struct CarrierOptions {
  int quant = 1;        ///< fap_quant of the first row, 0..31
  double error = 0.05;  ///< mm; adjustable precisions are the coarsest within it, 1e-4..10
  /// Receives the progress, 0..1.
  std::function<void(double)> progress;
};

/// Result of one carrier for a clip.
struct Carrier {
  std::string name;                  ///< "FBA, live" ...
  std::string setting;               ///< "quant 4", "7 bit" ...; empty: none
  bool fitted = false;               ///< the setting was chosen for CarrierOptions::error
  Headers headers = Headers::none;   ///< none: a file, read as a whole
  double error = 0;                  ///< mm RMS relative to the carrier's input
  std::size_t messages = 0;          ///< sent
  std::size_t bytes = 0;             ///< of the messages, without headers
  std::size_t bytes_of_headers = 0;  ///< of all messages
};

/// Results of all carriers for a clip.
struct ClipCarriers {
  std::string name;               ///< of the file
  std::size_t frames = 0;         ///< of the clip
  double rate = 0;                ///< frames a second
  double seconds = 0;             ///< duration of the clip
  std::size_t points = 0;         ///< number of vertices over which errors are computed
  double shapes_error = 0;        ///< mm RMS error of the fit with 52 shapes
  std::vector<Carrier> carriers;  ///< in the order of the table
  /// kbit/s with and without headers.
  double kbps(const Carrier& carrier, bool with_headers) const;
};

/// Encodes `clip`, which is complete (fap::fill()), with all carriers. `weights` are ARKit's, one
/// per frame; empty: fitted to the clip (fap::ArkitFitter).
///
/// Errors are RMS over those skin vertices of a built-in head that the clip moves by at least 0.1
/// mm, without head rotation, on at most 200 evenly spaced frames. FBA is compared with the FAPs of
/// the clip, the others with their input weights; the difference between the two is shapes_error.
/// Deterministic, for one version of zlib.
///
/// Errors: truncated (no frame), invalid_argument (not as many weights as frames), those of
/// fba::LiveEncoder and fba::encode().
Result<ClipCarriers> measure_carriers(const std::string& name, const fap::Sequence& clip,
                                      const std::vector<fap::ArkitFrame>& weights,
                                      const CarrierOptions& options);

/// The table of a clip, with an explanation of its columns.
std::string carriers_text(const ClipCarriers& clip, const CarrierOptions& options);
/// Averages all clips (at least one): total bits by total seconds, errors as RMS over frames.
ClipCarriers carriers_of_all(const std::vector<ClipCarriers>& clips);
/// The results as JSON text.
std::string carriers_json(const std::vector<ClipCarriers>& clips, const CarrierOptions& options);

}  // namespace animeme::inspect
