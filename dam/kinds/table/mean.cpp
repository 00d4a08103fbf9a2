// The kind mean: the mean pose of the training speech, for any script. It has no parameters.
#include "dam/corpus/training_set_internal.h"
#include "dam/kinds/table/table.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {

Result<void> validate_mean(const Model& model) {
  if (!std::holds_alternative<MeanParameters>(model.parameters))
    return invalid_model("its parameters are not those of its method");
  return {};
}

void write_mean(const Model&, ByteWriter&) {}

Result<void> read_mean(ByteReader&, Model& model) {
  model.parameters = MeanParameters{};
  return {};
}

Result<Parameters> fit_mean(const TrainingSet&, const Model&, const TrainOptions&, TrainRun& run) {
  if (!run.report("fit", 1)) return TrainRun::cancelled();
  run.summary.converged = true;
  return Parameters(MeanParameters{});
}

void speak_mean(const Speech& speech, std::span<double> rows, SynthesisReport&) {
  const std::vector<Control>& controls = speech.model.controls;
  for (std::size_t i = 0; i < speech.frames; ++i)
    for (std::size_t c = 0; c < controls.size(); ++c)
      if (controls[c].sd > 0)
        rows[i * controls.size() + c] = (controls[c].mean - controls[c].rest) / controls[c].sd;
}

double reach_of_mean(const Model&) { return 0; }

}  // namespace animeme::dam
