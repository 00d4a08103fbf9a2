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

constexpr double kLeastBudget = 1;  // bits: as few as can be
constexpr std::size_t kRetriesWithDefaults = 10;
constexpr std::size_t kMaxRetries = 40;  // plans tried to avoid hazards

Result<void> check(const EncodeOptions& options) {
  const auto ok =
      internal::check_numbers(options.fap_quant, options.bap_quant, options.intra_seconds);
  if (!ok) return ok;
  if (options.kept_ranges && options.intra_seconds > 0) {
    return internal::invalid(
        "with kept ranges receivers can join at the beginning only, so an intra period has no "
        "effect");
  }
  if (options.kept_ranges && options.default_ranges) {
    return internal::invalid("kept ranges and default ranges exclude each other");
  }
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
  std::size_t hazards = 0;
  std::size_t limited = 0;
  bool default_ranges = false;
};

// Plans, writes and checks; plans anew if the bits happen to hold hazards.
Result<Written> write(const ClipData& clip, const Decision& wanted, const EncodeOptions& options) {
  Written out;
  internal::PlanOptions plan{internal::period_frames(options.intra_seconds, clip.rate.rate()),
                             options.extra_intra,
                             {},
                             options.default_ranges};
  const bool far = internal::reaches_too_far(clip, wanted);
  Decision reached;
  const Decision& decision = far ? reached : wanted;
  Writer writer(clip, decision);
  for (;;) {
    const std::vector<std::size_t> begins = run_begins(clip, wanted, plan);
    if (far) {
      reached = wanted;
      out.limited = internal::limit_levels(clip, begins, reached);
    }
    Result<std::vector<Run>> runs = plan_runs(clip, decision, begins, plan);
    if (!runs) return runs.error();
    Encoder encoder(options.stream);
    if (auto ok = writer.write(*runs, encoder); !ok) return ok.error();
    encoder.end();
    out.intra_planes = runs->size();
    out.default_ranges = clip.has_face && !runs->front().face.send_range[kIntraMax];
    const std::vector<std::int64_t> hazards = encoder.hazard_bits();
    out.hazards = hazards.size();
    if (hazards.empty() || out.retries == kMaxRetries) {
      out.stream = encoder.take();
      break;
    }
    for (const std::int64_t bit : hazards) plan.hazardous.push_back(writer.plane_at(bit));
    std::sort(plan.hazardous.begin(), plan.hazardous.end());
    ++out.retries;
    // Values of intra planes have other bits with ranges of their own only.
    if (out.retries >= kRetriesWithDefaults) plan.default_ranges = false;
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
    if (internal::is_still(channel.value)) continue;
    const std::size_t kind = channel.distance ? 0 : 1;
    for (std::size_t plane = 0; plane < clip.planes(); ++plane) {
      const double difference =
          double(channel.value[plane] - decision.value(channel, i, plane)) / channel.unit;
      error[kind] += difference * difference;
    }
    values[kind] += double(clip.planes());
  }
  report.rms = std::sqrt(error[0] / std::max(values[0], 1.0));
  report.rms_other = std::sqrt(error[1] / std::max(values[1], 1.0));
  report.values = values[0];
  report.values_other = values[1];
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

// The smaller one of the streams with and without kept ranges, if those are wanted.
Result<Written> write_smallest(const ClipData& clip, Decision& decision,
                               const EncodeOptions& options) {
  Result<Written> plain = write(clip, decision, options);
  if (!plain || !options.kept_ranges) return plain;
  Decision with_first = decision;
  internal::choose_first(clip, with_first);
  if (!with_first.first) return plain;
  Result<Written> kept = write(clip, with_first, options);
  if (!kept || kept->hazards > plain->hazards || kept->stream.size() >= plain->stream.size()) {
    return plain;
  }
  decision = std::move(with_first);
  return kept;
}

// What planes take besides their values: a header of four bits, and one at the end of a segment;
// start codes and stuffing. Planes that may be skipped take nothing.
double least_header_bits(const ClipData& clip, const EncodeOptions& options) {
  if (options.skip_still) return 0;
  const bool all = options.stream.plane_start_codes == PlaneStartCodes::all;
  return double(clip.planes()) * (all ? 5 + 36 : 5);
}

// One attempt; `bit_budget` and `hint` as in decide().
Result<Written> attempt(const ClipData& clip, const EncodeOptions& options, double bit_budget,
                        internal::SearchHint& hint, EncodeReport& report) {
  Decision decision = internal::decide(clip, options, bit_budget, hint);
  Result<Written> written = Written{};
  if (options.skip_still) {
    ClipData moving = clip;
    Decision of_moving = decision;
    internal::keep_planes(internal::moving_planes(clip, decision), moving, of_moving);
    written = write_smallest(moving, of_moving, options);
    decision.first = std::move(of_moving.first);
    report = report_on(clip, decision);
    report.planes = moving.planes();
  } else {
    written = write_smallest(clip, decision, options);
    report = report_on(clip, decision);
    report.planes = clip.planes();
  }
  if (!written) return written;
  report.kept_ranges = decision.first.has_value();
  report.default_ranges = written->default_ranges;
  report.limited = written->limited;
  report.skipped = clip.planes() - report.planes;
  report.intra_planes = written->intra_planes;
  report.retries = written->retries;
  report.hazards = written->hazards;
  return written;
}

}  // namespace

EncodeOptions file_options() {
  EncodeOptions options;
  options.leave_out = true;
  options.extra_intra = true;
  return options;
}

EncodeOptions live_options() {
  EncodeOptions options;
  options.extra_intra = true;
  options.intra_seconds = 2;
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
  internal::SearchHint hint;
  double budget =
      target > 0 ? std::max(target - least_header_bits(*clip, options), kLeastBudget) : 0;
  Result<Written> written = attempt(*clip, options, budget, hint, chosen);
  // What headers take beyond that is known only afterwards: aim lower by what was too much.
  for (int i = 0; i < 4 && written && target > 0; ++i) {
    const double excess = double(written->stream.size()) * 8 - target;
    if (excess <= 0 || budget <= kLeastBudget) break;
    budget = std::max(budget - excess - 0.002 * target, kLeastBudget);
    written = attempt(*clip, options, budget, hint, chosen);
  }
  if (!written) return written.error();
  if (report != nullptr) *report = chosen;
  return std::move(written->stream);
}

}  // namespace animeme::fba
