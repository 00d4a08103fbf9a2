/// @file
/// The same face by other carriers: what FBA, ARKit's weights, Live Link, VMC, ARF and JSON take
/// for a clip, and how far each leaves the face from what it was given.
///
/// All bytes are those of messages that were written (carrier_messages.h). All errors are
/// millimetres on one head, so carriers whose precision can be chosen are compared at one error.
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

/// What measure_carriers() is to do.
struct CarrierOptions {
  int quant = 1;        ///< fap_quant of the first row, 0..31
  double error = 0.05;  ///< mm; precisions that can be chosen are the coarsest within it, 1e-4..10
  /// Gets the share that is done, 0..1.
  std::function<void(double)> progress;
};

/// What a carrier made of a clip.
struct Carrier {
  std::string name;                  ///< "FBA, live" ...
  std::string setting;               ///< "quant 4", "7 bit" ...; empty: there is none
  bool fitted = false;               ///< the setting was chosen for CarrierOptions::error
  Headers headers = Headers::none;   ///< none: a file, read as a whole
  double error = 0;                  ///< mm RMS from what the carrier was given
  std::size_t messages = 0;          ///< sent
  std::size_t bytes = 0;             ///< of them, without headers
  std::size_t bytes_of_headers = 0;  ///< of all messages
};

/// A clip by all carriers.
struct ClipCarriers {
  std::string name;               ///< of the file
  std::size_t frames = 0;         ///< all of the clip
  double rate = 0;                ///< frames a second
  double seconds = 0;             ///< that the clip lasts
  std::size_t points = 0;         ///< vertices that the errors are over
  double shapes_error = 0;        ///< mm RMS between the face and what 52 shapes can show of it
  std::vector<Carrier> carriers;  ///< in the order of the table
  /// kbit/s with and without headers.
  double kbps(const Carrier& carrier, bool with_headers) const;
};

/// Sends `clip`, complete (fap::fill()), by all carriers. `weights` are ARKit's, one a frame;
/// empty: those that show the clip best (fap::ArkitFitter).
///
/// Errors are RMS over those vertices of the skin of a built-in head that the clip moves by 0.1 mm
/// at some time, without the turn of the head, on at most 200 frames that lie evenly in the clip.
/// FBA is measured from the FAPs of the clip, all others from the weights they get; what lies
/// between the two is shapes_error. Deterministic, for one version of zlib.
///
/// Errors: truncated (no frame), invalid_argument (not as many weights as frames), those of
/// fba::LiveEncoder and fba::encode().
Result<ClipCarriers> measure_carriers(const std::string& name, const fap::Sequence& clip,
                                      const std::vector<fap::ArkitFrame>& weights,
                                      const CarrierOptions& options);

/// The table of a clip, with what its columns are.
std::string carriers_text(const ClipCarriers& clip, const CarrierOptions& options);
/// All clips together (one at least): bits of all by seconds of all, errors as RMS over frames.
ClipCarriers carriers_of_all(const std::vector<ClipCarriers>& clips);
/// All of it as JSON text.
std::string carriers_json(const std::vector<ClipCarriers>& clips, const CarrierOptions& options);

}  // namespace animeme::inspect
