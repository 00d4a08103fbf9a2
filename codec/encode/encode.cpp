#include "codec/encode/encode.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "codec/encode/clip_planes_internal.h"
#include "codec/syntax/settings_internal.h"

namespace animeme::fba {

namespace {

using internal::Channel;
using internal::ClipData;
using internal::ClipPlanes;
using internal::Decision;
using internal::Role;
using internal::Row;
using internal::Run;

constexpr double kLeastBudget = 1;       // bits: as few as can be
constexpr std::size_t kMaxRetries = 40;  // plans tried to avoid traps

Result<void> check(const EncodeOptions& options) {
  const auto ok =
      internal::check_numbers(options.fap_quant, options.bap_quant, options.intra_period);
  if (!ok) return ok;
  if (options.max_rms >= 0 && options.max_bits_per_second >= 0 && options.still_below >= 0) {
    return {};
  }
  return internal::invalid("limits of error, rate and motion must not be negative");
}

// Writes the runs of a plan, and knows which plane a bit belongs to.
class Writer {
 public:
  Writer(const ClipData& clip, const Decision& decision) : planes_(clip, decision) {}

  Result<void> write(const std::vector<Run>& runs, Encoder& encoder) {
    ends_.clear();
    for (const Run& run : runs) {
      for (std::size_t plane = run.first; plane < run.first + run.count; ++plane) {
        if (auto ok = encoder.write(planes_.input(run, plane)); !ok) {
          Error error = ok.error();
          error.message = "frame " + std::to_string(planes_.face().number) + ": " + error.message;
          return error;
        }
        ends_.push_back(encoder.bits());
      }
    }
    return {};
  }

  std::size_t plane_at(std::int64_t bit) const {
    const auto end = std::upper_bound(ends_.begin(), ends_.end(), bit);
    return std::min(std::size_t(end - ends_.begin()), ends_.size() - 1);
  }

 private:
  ClipPlanes planes_;
  std::vector<std::int64_t> ends_;  // of the planes
};

struct Written {
  std::vector<std::uint8_t> stream;
  std::size_t intra_planes = 0;
  std::size_t retries = 0;
  std::size_t traps = 0;
};

// Plans, writes and checks; plans anew if the bits happen to hold traps.
Result<Written> write(const ClipData& clip, const Decision& decision,
                      const EncodeOptions& options) {
  Written out;
  internal::PlanOptions plan{options.intra_period, options.extra_intra, {}};
  Writer writer(clip, decision);
  for (;;) {
    Result<std::vector<Run>> runs = plan_runs(clip, decision, plan);
    if (!runs) return runs.error();
    Encoder encoder(options.stream);
    if (auto ok = writer.write(*runs, encoder); !ok) return ok.error();
    encoder.end();
    out.intra_planes = runs->size();
    const std::vector<std::int64_t> traps = encoder.trap_bits();
    out.traps = traps.size();
    if (traps.empty() || out.retries == kMaxRetries) {
      out.stream = encoder.take();
      break;
    }
    for (const std::int64_t bit : traps) plan.trapped.push_back(writer.plane_at(bit));
    std::sort(plan.trapped.begin(), plan.trapped.end());
    ++out.retries;
  }
  if (options.verify) {
    if (auto ok = internal::verify(out.stream, clip, decision); !ok) return ok.error();
  }
  return out;
}

void measure_error(const ClipData& clip, const Decision& decision, EncodeReport& report) {
  double error[2] = {0, 0};
  double values[2] = {0, 0};
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    const Row& row = decision.rows[i];
    if (internal::is_still(channel.value)) continue;
    const double step = internal::step_at(channel, decision.quant(channel));
    const std::size_t kind = channel.distance ? 0 : 1;
    for (std::size_t plane = 0; plane < clip.planes(); ++plane) {
      const double difference = (channel.value[plane] - row.levels[plane] * step) / channel.unit;
      error[kind] += difference * difference;
    }
    values[kind] += double(clip.planes());
  }
  report.rms = std::sqrt(error[0] / std::max(values[0], 1.0));
  report.rms_other = std::sqrt(error[1] / std::max(values[1], 1.0));
}

EncodeReport report_on(const ClipData& clip, const Decision& decision) {
  EncodeReport report;
  report.fap_quant = decision.fap_quant;
  report.bap_quant = decision.bap_quant;
  for (std::size_t i = 0; i < decision.rows.size(); ++i) {
    const Row& row = decision.rows[i];
    report.coded += row.role == Role::coded ? 1 : 0;
    report.mirrored += row.role == Role::mirrored ? 1 : 0;
    report.left_out += row.role == Role::left_out && clip.channels[i].given ? 1 : 0;
    report.stilled += row.stilled ? 1 : 0;
  }
  measure_error(clip, decision, report);
  return report;
}

// One attempt; `bit_budget` as in decide().
Result<Written> attempt(const ClipData& clip, const EncodeOptions& options, double bit_budget,
                        EncodeReport& report) {
  Decision decision = internal::decide(clip, options, bit_budget);
  report = report_on(clip, decision);
  Result<Written> written = Written{};
  if (options.skip_still) {
    ClipData moving = clip;
    internal::keep_planes(internal::moving_planes(clip, decision), moving, decision);
    report.planes = moving.planes();
    written = write(moving, decision, options);
  } else {
    report.planes = clip.planes();
    written = write(clip, decision, options);
  }
  if (!written) return written;
  report.skipped = clip.planes() - report.planes;
  report.intra_planes = written->intra_planes;
  report.retries = written->retries;
  report.traps = written->traps;
  return written;
}

}  // namespace

EncodeOptions file_options() {
  EncodeOptions options;
  options.leave_out = true;
  options.extra_intra = true;
  return options;
}

Result<std::vector<std::uint8_t>> encode(const fap::Sequence& face, const EncodeOptions& options,
                                         std::span<const BodyFrame> body, EncodeReport* report) {
  if (auto ok = check(options); !ok) return ok.error();
  Result<ClipData> clip = internal::gather(face, body, options.leave_out);
  if (!clip) return clip.error();

  const double seconds =
      clip->rate.rate().seconds(double(clip->number.back() - clip->number.front() + 1));
  const double target = options.max_bits_per_second * seconds;
  EncodeReport chosen;
  Result<Written> written = attempt(*clip, options, target, chosen);
  // What headers take is known only afterwards: aim lower by what was too much.
  double budget = target;
  for (int i = 0; i < 4 && written && target > 0; ++i) {
    const double excess = double(written->stream.size()) * 8 - target;
    if (excess <= 0 || budget <= kLeastBudget) break;
    budget = std::max(budget - excess - 0.002 * target, kLeastBudget);
    written = attempt(*clip, options, budget, chosen);
  }
  if (!written) return written.error();
  if (report != nullptr) *report = chosen;
  return std::move(written->stream);
}

}  // namespace animeme::fba
