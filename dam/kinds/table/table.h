// Poses and curves looked up by phone: the entry points of the kinds mean, viseme and triphone. See
// kind.h for what each has to do.
#pragma once

#include "dam/model/kind_internal.h"

namespace animeme::dam {

Result<void> validate_mean(const Model& model);
void write_mean(const Model& model, ByteWriter& out);
Result<void> read_mean(ByteReader& in, Model& model);
Result<Parameters> fit_mean(const TrainingSet& set, const Model& model, const TrainOptions& options,
                            TrainRun& run);
void speak_mean(const Speech& speech, std::span<double> rows, SynthesisReport& report);
double reach_of_mean(const Model& model);

Result<void> validate_visemes(const Model& model);
void write_visemes(const Model& model, ByteWriter& out);
Result<void> read_visemes(ByteReader& in, Model& model);
Result<Parameters> fit_visemes(const TrainingSet& set, const Model& model,
                               const TrainOptions& options, TrainRun& run);
void speak_visemes(const Speech& speech, std::span<double> rows, SynthesisReport& report);
double reach_of_visemes(const Model& model);

Result<void> validate_triphones(const Model& model);
void write_triphones(const Model& model, ByteWriter& out);
Result<void> read_triphones(ByteReader& in, Model& model);
Result<Parameters> fit_triphones(const TrainingSet& set, const Model& model,
                                 const TrainOptions& options, TrainRun& run);
void speak_triphones(const Speech& speech, std::span<double> rows, SynthesisReport& report);
double reach_of_triphones(const Model& model);

}  // namespace animeme::dam
