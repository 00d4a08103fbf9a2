#include "codec/encode.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "codec/decide_internal.h"
#include "codec/decoder.h"
#include "codec/plan_internal.h"

namespace animeme::fba {

namespace {

using internal::Channel;
using internal::ClipData;
using internal::Decision;
using internal::Role;
using internal::Row;
using internal::Run;

constexpr double kLeastBudget = 1;       // bits: as few as can be
constexpr std::size_t kMaxRetries = 40;  // plans tried to avoid traps

Result<void> check(const EncodeOptions& options) {
  const auto invalid = [](const char* message) {
    return make_error(Code::invalid_argument, message);
  };
  if (options.fap_quant < 0 || options.fap_quant > 31) return invalid("fap_quant must be 0..31");
  if (options.bap_quant < 0 || options.bap_quant > 31) return invalid("bap_quant must be 0..31");
  if (options.intra_period < 0) return invalid("the intra period must not be negative");
  if (!(options.max_rms >= 0) || !(options.max_bits_per_second >= 0) ||
      !(options.still_below >= 0)) {
    return invalid("limits of error, rate and motion must not be negative");
  }
  return {};
}

// Keeps the planes of the list and drops the others.
void keep_planes(const std::vector<std::size_t>& planes, ClipData& clip, Decision& decision) {
  const auto keep = [&](auto& row) {
    if (row.empty()) return;
    for (std::size_t i = 0; i < planes.size(); ++i) row[i] = row[planes[i]];
    row.resize(planes.size());
  };
  keep(clip.number);
  keep(clip.viseme);
  keep(clip.expression);
  for (Channel& channel : clip.channels) keep(channel.value);
  for (Row& row : decision.rows) keep(row.levels);
}

// The planes of a plan, one after the other, as the encoder wants them.
class Writer {
 public:
  Writer(const ClipData& clip, const Decision& decision) : clip_(clip), decision_(decision) {
    for (const Channel& channel : clip.channels) {
      steps_.push_back(internal::step_at(channel, decision.quant(channel)));
    }
  }

  // Notes where each plane ends.
  Result<void> write(const std::vector<Run>& runs, Encoder& encoder) {
    ends_.clear();
    for (const Run& run : runs) {
      for (std::size_t plane = run.first; plane < run.first + run.count; ++plane) {
        if (auto ok = encoder.write(input(run, plane)); !ok) {
          Error error = ok.error();
          error.message = "frame " + std::to_string(clip_.number[plane]) + ": " + error.message;
          return error;
        }
        ends_.push_back(encoder.bits());
      }
    }
    return {};
  }

  // The plane that holds a bit.
  std::size_t plane_at(std::int64_t bit) const {
    const auto end = std::upper_bound(ends_.begin(), ends_.end(), bit);
    return std::min(std::size_t(end - ends_.begin()), ends_.size() - 1);
  }

  // Reconstructed values of a plane.
  void load(std::size_t plane) {
    for (std::size_t i = 0; i < clip_.channels.size(); ++i) {
      const std::size_t number = std::size_t(clip_.channels[i].number);
      const std::int32_t value =
          std::int32_t(std::int64_t(decision_.rows[i].levels[plane]) * steps_[i]);
      (clip_.channels[i].body ? body_.value[number] : face_.value[number]) = value;
    }
    if (!clip_.viseme.empty()) {
      face_.viseme = clip_.viseme[plane];
      face_.expression = clip_.expression[plane];
      internal::keep_legal(face_.viseme, face_.expression, decision_.fap_quant);
    }
  }
  const fap::Frame& face() const { return face_; }
  const BodyFrame& body() const { return body_; }

 private:
  PlaneInput input(const Run& run, std::size_t plane) {
    load(plane);
    PlaneInput input;
    input.intra = plane == run.first;
    input.object_mask = ObjectMask((clip_.has_face ? 1 : 0) | (clip_.has_body ? 2 : 0));
    if (input.intra) input.temporal.rate = clip_.rate;
    if (plane + 1 < clip_.planes() && clip_.number[plane + 1] != clip_.number[plane] + 1) {
      input.temporal.skip = std::uint32_t(clip_.number[plane + 1] - clip_.number[plane] - 1);
    }
    input.face_settings = &run.face;
    input.body_settings = &run.body;
    face_.number = clip_.number[plane];
    input.face = &face_;
    input.body = &body_;
    return input;
  }

  const ClipData& clip_;
  const Decision& decision_;
  std::vector<std::int32_t> steps_;
  std::vector<std::int64_t> ends_;
  fap::Frame face_;
  BodyFrame body_;
};

Error verify_error(std::int64_t number, const std::string& what) {
  return make_error(Code::internal, "the stream does not decode to what was coded: frame " +
                                        std::to_string(number) + ", " + what);
}

// FAP 1 and 2 as given; what has a scale within half a quantiser step.
bool high_level_agrees(const fap::Frame& got, const fap::Frame& want, const ClipData& clip,
                       const Decision& decision) {
  if (got.mask[1] != clip.has_viseme || got.mask[2] != clip.has_expression) return false;
  const auto near = [&](std::int32_t& value, std::int32_t other) {
    const bool is = std::abs(value - other) <= fap_scale(decision.fap_quant) / 2;
    value = other;
    return is;
  };
  fap::Viseme viseme = got.viseme;
  fap::Expression expression = got.expression;
  if (clip.has_viseme && (!near(viseme.blend, want.viseme.blend) || viseme != want.viseme)) {
    return false;
  }
  return !clip.has_expression ||
         (near(expression.intensity1, want.expression.intensity1) &&
          near(expression.intensity2, want.expression.intensity2) && expression == want.expression);
}

// Decodes the stream and compares every coded value.
Result<void> verify(const std::vector<std::uint8_t>& stream, const ClipData& clip,
                    const Decision& decision) {
  Decoder decoder;
  decoder.push(stream);
  decoder.finish();
  Writer expected(clip, decision);
  for (std::size_t plane = 0; plane < clip.planes(); ++plane) {
    Result<Event> event = decoder.next();
    if (event && event->kind == Event::Kind::info) event = decoder.next();
    const std::int64_t number = clip.number[plane];
    if (!event) return verify_error(number, event.error().describe());
    if (event->kind != Event::Kind::plane) return verify_error(number, event->text);
    expected.load(plane);
    if (event->plane.number != number - clip.number.front()) {
      return verify_error(number, "its number");
    }
    if (!high_level_agrees(event->plane.face, expected.face(), clip, decision)) {
      return verify_error(number, "FAP 1 or 2");
    }
    for (std::size_t i = 0; i < clip.channels.size(); ++i) {
      const Channel& channel = clip.channels[i];
      if (decision.rows[i].role != Role::coded) continue;
      const std::size_t n = std::size_t(channel.number);
      const bool same = channel.body ? event->plane.body->mask[n] &&
                                           event->plane.body->value[n] == expected.body().value[n]
                                     : event->plane.face.mask[n] &&
                                           event->plane.face.value[n] == expected.face().value[n];
      if (!same) {
        return verify_error(number, (channel.body ? "BAP " : "FAP ") + std::to_string(n));
      }
    }
  }
  const Result<Event> end = decoder.next();
  if (end || end.error().code != Code::end_of_stream) {
    return verify_error(clip.number.back(), "something follows");
  }
  return {};
}

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
    if (auto ok = verify(out.stream, clip, decision); !ok) return ok.error();
  }
  return out;
}

void measure_error(const ClipData& clip, const Decision& decision, EncodeReport& report) {
  double error[2] = {0, 0};
  double values[2] = {0, 0};
  for (std::size_t i = 0; i < clip.channels.size(); ++i) {
    const Channel& channel = clip.channels[i];
    const Row& row = decision.rows[i];
    if (std::all_of(channel.value.begin(), channel.value.end(),
                    [&](std::int32_t v) { return v == channel.value.front(); })) {
      continue;
    }
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
  for (const Row& row : decision.rows) {
    report.coded += row.role == Role::coded ? 1 : 0;
    report.mirrored += row.role == Role::mirrored ? 1 : 0;
    report.left_out += row.role == Role::left_out ? 1 : 0;
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
    keep_planes(internal::moving_planes(clip, decision), moving, decision);
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
  Result<ClipData> clip = internal::gather(face, body);
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
