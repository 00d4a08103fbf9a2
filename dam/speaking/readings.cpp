#include "dam/speaking/readings.h"

#include <functional>
#include <limits>

#include "dam/speaking/frames_internal.h"

namespace animeme::dam {

namespace {

using MakeReading = std::function<Result<Signal>(const Script&)>;

Result<Signal> mean_motion(std::span<const Script> readings, const MakeReading& make) {
  if (readings.empty()) return make_error(Code::invalid_argument, "there are no readings");
  Signal mean;
  for (const Script& reading : readings) {
    Result<Signal> one = make(reading);
    if (!one) return one.error();
    if (mean.values.empty()) {
      mean = std::move(*one);
      continue;
    }
    if (one->values.size() != mean.values.size()) {
      return make_error(Code::invalid_argument, "the readings have different durations");
    }
    for (std::size_t i = 0; i < mean.values.size(); ++i) mean.values[i] += one->values[i];
  }
  for (double& value : mean.values) value /= double(readings.size());
  return mean;
}

}  // namespace

Result<Signal> synthesise_readings(const Model& model, std::span<const Script> readings,
                                   const Script& agreed, const SynthesisOptions& options,
                                   SynthesisReport* report) {
  auto mean = mean_motion(
      readings, [&](const Script& reading) { return synthesise(model, reading, options); });
  if (!mean) return mean;
  SynthesisReport own;
  SynthesisReport& out = report != nullptr ? *report : own;
  out = {};
  if (auto known = replace_unknown_phones(model, agreed, &out); !known) return known.error();
  out.phones = agreed.phones.size();
  touch_lips(model, agreed, options, *mean, out);
  return mean;
}

Result<Signal> synthesise_readings(const Model& model, std::span<const Script> readings,
                                   const Script& agreed, const SynthesisOptions& options,
                                   const ReadingFrames& frames) {
  if (auto ok = validate(options); !ok) return ok.error();
  SynthesisOptions going_on = options;
  going_on.rest_at_ends = false;
  const FramePlan plan{frames.first, frames.count, std::numeric_limits<double>::infinity()};
  auto mean = mean_motion(readings, [&](const Script& reading) -> Result<Signal> {
    if (auto ok = check_script(reading); !ok) return ok.error();
    SynthesisReport unused;
    return synthesise_frames(model, reading, going_on, plan, unused);
  });
  if (!mean) return mean;
  SynthesisReport unused;
  touch_lips(model, agreed, going_on, *mean, unused);
  return mean;
}

}  // namespace animeme::dam
