// Dominated animemes as the paper has them: the entry points of the kinds dam-paper and
// cohen-massaro. See kind.h for what each has to do.
#pragma once

#include "dam/model/kind_internal.h"

namespace animeme::dam {

Result<void> validate_animemes(const Model& model);
void write_animemes(const Model& model, ByteWriter& out);
Result<void> read_animemes(ByteReader& in, Model& model);
Result<Parameters> fit_animemes(const TrainingSet& set, const Model& model,
                                const TrainOptions& options, TrainRun& run);
void speak_animemes(const Speech& speech, std::span<double> rows, SynthesisReport& report);
double reach_of_animemes(const Model& model);

}  // namespace animeme::dam
