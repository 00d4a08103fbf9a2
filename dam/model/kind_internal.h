// The interface of a kind of model. synthesise(), train() and the model file do what all kinds
// share and leave the rest to the entry of this table. A new kind is a folder in dam/kinds, an
// entry in kinds.cpp and an alternative of Parameters.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dam/model/bytes_internal.h"
#include "dam/model/model.h"
#include "dam/script/timeline_internal.h"
#include "fap/result.h"

namespace animeme::dam {

struct SynthesisOptions;
struct SynthesisReport;
struct TrainingSet;
struct TrainOptions;
struct TrainRun;

/// Input of a kind's synthesis.
struct Speech {
  const Model& model;
  /// Every label is a phone of the model.
  std::span<const Occurrence> timeline;
  /// Model::phones index of each occurrence.
  std::span<const std::int32_t> phone;
  const SynthesisOptions& options;
  /// Frames to make: [first_frame, first_frame + frames) at `rate`.
  fap::Rate rate;
  std::size_t first_frame = 0;
  std::size_t frames = 0;

  double time(std::size_t frame) const { return rate.seconds(double(first_frame + frame)); }
  /// Frames [first, second) to make that lie within [low, high] seconds.
  std::pair<std::size_t, std::size_t> frames_between(double low, double high) const;
};

/// Model::phones index of Occurrence::left or right.
inline std::int32_t neighbour(const Model& model, const std::string& label) {
  return label.empty() ? kRestContext : model.find_phone(label);
}

struct Kind {
  Method method;
  std::string_view name;  ///< for users and files

  /// Checks Model::parameters; the rest of the model is valid already.
  Result<void> (*validate)(const Model& model);
  /// Model::parameters to and from the file. read() may trust nothing but the common part, and
  /// must not allocate what the input does not pay for; validate() follows.
  void (*write)(const Model& model, ByteWriter& out);
  Result<void> (*read)(ByteReader& in, Model& model);
  /// Fits. `model` has everything but its parameters.
  Result<Parameters> (*fit)(const TrainingSet& set, const Model& model, const TrainOptions& options,
                            TrainRun& run);
  /// S(t) of model.h into `rows`: frames x controls zeros, row by row. A frame costs as much as
  /// there are phones near it.
  void (*speak)(const Speech& speech, std::span<double> rows, SynthesisReport& report);
  /// Seconds beside a phone beyond which it has no influence.
  double (*reach)(const Model& model);
};

/// The entry of a method; the method must be one of methods().
const Kind& kind_of(Method method);
/// All entries, in the order of listings.
std::span<const Kind> kinds();

/// "the model is not valid: ..."
Error invalid_model(const std::string& what);

}  // namespace animeme::dam
