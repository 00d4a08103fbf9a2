// Refined dominated animemes: the entry points of the kind dam. See kind.h for what each has to do.
#pragma once

#include "dam/model/kind_internal.h"

namespace animeme::dam {

Result<void> validate_refined(const Model& model);
void write_refined(const Model& model, ByteWriter& out);
Result<void> read_refined(ByteReader& in, Model& model);
Result<Parameters> fit_refined(const TrainingSet& set, const Model& model,
                               const TrainOptions& options, TrainRun& run);
void speak_refined(const Speech& speech, std::span<double> rows, SynthesisReport& report);
double reach_of_refined(const Model& model);

}  // namespace animeme::dam
