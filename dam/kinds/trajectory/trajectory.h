// Trajectory synthesis as in Ezzat's multidimensional morphable models: the entry points of the
// kind mmm. See kind.h for what each has to do.
#pragma once

#include "dam/model/kind_internal.h"

namespace animeme::dam {

Result<void> validate_trajectory(const Model& model);
void write_trajectory(const Model& model, ByteWriter& out);
Result<void> read_trajectory(ByteReader& in, Model& model);
Result<Parameters> fit_trajectory(const TrainingSet& set, const Model& model,
                                  const TrainOptions& options, TrainRun& run);
void speak_trajectory(const Speech& speech, std::span<double> rows, SynthesisReport& report);
double reach_of_trajectory(const Model& model);

}  // namespace animeme::dam
