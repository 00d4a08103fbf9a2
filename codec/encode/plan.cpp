#include <algorithm>
#include <string>

#include "codec/encode/code_length_internal.h"
#include "codec/encode/plan_internal.h"
#include "codec/syntax/settings_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

// Settles masks and ranges of each run.
class Planner {
 public:
  Planner(const ClipData& clip, const Decision& decision, const std::vector<std::size_t>& begins,
          const PlanOptions& options)
      : clip_(clip),
        decision_(decision),
        begins_(begins),
        hazardous_(options.hazardous),
        coded_(coded_channels(decision)) {
    default_ranges_ = options.default_ranges && fits_default_ranges();
    faps_ = std::size_t(std::count_if(coded_.begin(), coded_.end(),
                                      [this](std::size_t i) { return !channel(i).body; }));
  }

  Result<std::vector<Run>> plan() {
    if (auto ok = check_reach(); !ok) return ok.error();
    std::vector<Run> runs;
    for (std::size_t i = 0; i < begins_.size(); ++i) {
      Result<Run> run =
          i == 0 && decision_.first ? settle_first() : settle(begins_[i], end_of(i) - begins_[i]);
      if (!run) return run.error();
      runs.push_back(std::move(*run));
    }
    return runs;
  }

 private:
  std::size_t end_of(std::size_t run) const {
    return run + 1 < begins_.size() ? begins_[run + 1] : clip_.planes();
  }
  const Channel& channel(std::size_t i) const { return clip_.channels[i]; }
  int quant(std::size_t i) const { return decision_.quant(channel(i)); }
  int scale(std::size_t i) const { return scale_at(channel(i).body, quant(i)); }
  std::span<const std::int32_t> levels(std::size_t i, std::size_t first, std::size_t count) const {
    return std::span(decision_.rows[i].levels).subspan(first, count);
  }

  Result<Run> settle(std::size_t first, std::size_t count) const {
    Run run;
    run.first = first;
    run.count = count;
    set_up(run);
    if (decision_.first) {
      // The first plane has defined these.
      for (const RangeKind kind : {kPredictiveMax, kPredictiveMin}) {
        run.face.send_range[kind] = run.body.send_range[kind] = false;
      }
    }
    if (default_ranges_) {
      for (const RangeKind kind : {kIntraMax, kIntraMin}) run.face.send_range[kind] = false;
    }
    const std::size_t detours = detours_of(first, count);
    for (std::size_t n = 0; n < coded_.size(); ++n) {
      const std::size_t i = coded_[n];
      RunCost ranges = run_ranges(levels(i, first, count), scale(i));
      if (!ranges.fits) return too_large(i, first);
      for (std::size_t turn = turn_of(n); turn < detours; turn += coded_.size()) {
        take_detour(ranges, is_last(n));
      }
      set_ranges(i, ranges, run);
    }
    guard_fap4(run.face);
    return run;
  }

  // Whether all intra planes could do with the default ranges: once ranges are sent, decoders have
  // no others until new ones come.
  bool fits_default_ranges() const {
    bool any = false;
    for (const std::size_t i : coded_) {
      if (channel(i).body) continue;
      any = true;
      const int number = range_number(fap::info(channel(i).number).default_i_range, 1);
      const std::int32_t most = level_range(number, scale(i));
      for (const std::size_t plane : begins_) {
        if (std::abs(std::int64_t(decision_.rows[i].levels[plane])) > most) return false;
      }
    }
    return any;
  }

  // The coarse plane, with ranges for the changes of all runs behind it.
  Result<Run> settle_first() const {
    Run run;
    run.count = 1;
    set_up(run);
    run.face.fap_quant = decision_.first->fap_quant;
    run.body.bap_quant = decision_.first->bap_quant;
    const std::size_t detours = detours_of(0, clip_.planes());
    for (std::size_t n = 0; n < coded_.size(); ++n) {
      const std::size_t i = coded_[n];
      const int coarse = scale_at(channel(i).body, decision_.first->quant(channel(i)));
      RunCost ranges = run_ranges(std::span(&decision_.first->levels[i], 1), coarse);
      for (std::size_t k = 1; k < begins_.size(); ++k) {
        const RunCost of_run = run_ranges(levels(i, begins_[k], end_of(k) - begins_[k]), coarse);
        for (const RangeKind kind : {kPredictiveMax, kPredictiveMin}) {
          ranges.range[kind] = std::max(ranges.range[kind], of_run.range[kind]);
        }
      }
      for (std::size_t turn = turn_of(n); turn < detours; turn += coded_.size()) {
        take_detour(ranges, is_last(n));
      }
      set_ranges(i, ranges, run);
    }
    guard_fap4(run.face);
    return run;
  }

  void set_ranges(std::size_t i, const RunCost& ranges, Run& run) const {
    const std::size_t number = std::size_t(channel(i).number);
    for (std::size_t kind = 0; kind < 4; ++kind) {
      (channel(i).body ? run.body.range[kind][number] : run.face.range[kind][number]) =
          ranges.range[kind];
    }
  }

  // How many ranges a run is to have wider. A hazard that outlives its detours asks for more each
  // time: ranges behind it in its segment do not move it, and those before it may be many.
  std::size_t detours_of(std::size_t first, std::size_t count) const {
    const auto begin = std::lower_bound(hazardous_.begin(), hazardous_.end(), first);
    const auto end = std::lower_bound(begin, hazardous_.end(), first + count);
    std::ptrdiff_t most = 0;  // times that one plane had a hazard
    for (auto it = begin; it != end;) {
      const auto next = std::upper_bound(it, end, *it);
      most = std::max(most, next - it);
      it = next;
    }
    // Further detours than that find every range as wide as it can be.
    return std::min(std::size_t((end - begin) * most), 2 * kMaxRange * coded_.size());
  }

  // The order in which detours take the coded parameters: the last FAP and the last BAP come first.
  std::size_t turn_of(std::size_t n) const {
    if (n + 1 == faps_) return 0;
    return coded_.size() - 1 - n + (n >= faps_ && faps_ > 0 ? 1 : 0);
  }

  // The last FAP or BAP: its range of kPredictiveMin stands before the values of the intra plane.
  bool is_last(std::size_t n) const { return n + 1 == faps_ || n + 1 == coded_.size(); }

  // Wider ranges than needed, for other bits in the intra plane as well as in those behind it.
  // Zeros come from the highest symbols of a range, so its upper side moves: with room below alone,
  // a parameter at rest would write zeros in every plane. Zeros of the last range of all may reach
  // into the values behind it, so that one gets both sides.
  static void take_detour(RunCost& ranges, bool last) {
    const auto widen = [&ranges](RangeKind kind, RangeKind other) {
      if (ranges.range[kind] == kMaxRange) kind = other;
      if (ranges.range[kind] < kMaxRange) ++ranges.range[kind];
    };
    widen(kIntraMax, kIntraMin);
    widen(kPredictiveMax, kPredictiveMin);
    if (last) widen(kPredictiveMin, kPredictiveMax);
  }

  void set_up(Run& run) const {
    run.face.fap_quant = decision_.fap_quant;
    run.body.bap_quant = decision_.bap_quant;
    run.face.send_range = {true, true, true, true};
    run.body.send_range = {true, true, true, true};
    run.face.mask[1] = clip_.has_viseme;
    run.face.mask[2] = clip_.has_expression;
    std::bitset<fap::kGroupCount> interpolated;
    for (std::size_t i = 0; i < clip_.channels.size(); ++i) {
      const std::size_t number = std::size_t(channel(i).number);
      const Role role = decision_.rows[i].role;
      if (channel(i).body) {
        run.body.mask[number] = role == Role::coded;
      } else {
        run.face.mask[number] = role == Role::coded;
        const int group = fap::info(channel(i).number).group;
        if (role == Role::mirrored) interpolated.set(std::size_t(group - 1));
      }
    }
    set_mask_types(run.face, interpolated);
    guard_last_group(run.body.mask);
    set_mask_types(run.body);
  }

  // Reconstructions are 32-bit numbers.
  Result<void> check_reach() const {
    for (const std::size_t i : coded_) {
      const std::int64_t step = step_at(channel(i), quant(i));
      const auto row = levels(i, 0, clip_.planes());
      for (std::size_t plane = 0; plane < row.size(); ++plane) {
        const std::int64_t value = row[plane] * step;
        if (value == std::int32_t(value)) continue;
        return make_error(Code::out_of_range, what(i, plane) +
                                                  " cannot be coded: it would be rounded to a "
                                                  "number of more than 32 bits");
      }
    }
    return {};
  }

  Error too_large(std::size_t i, std::size_t plane) const {
    const std::int32_t step = step_at(channel(i), quant(i));
    return make_error(Code::out_of_range,
                      what(i, plane) + " cannot be coded: the limit is +-" +
                          std::to_string(level_range(kMaxRange, scale(i)) * step) +
                          (quant(i) == 0 ? " without quantisation; use --quant 1" : ""));
  }

  std::string what(std::size_t i, std::size_t plane) const {
    const int number = channel(i).number;
    std::string name = (channel(i).body ? "BAP " : "FAP ") + std::to_string(number);
    if (!channel(i).body) name += " (" + std::string(fap::info(number).name) + ")";
    return name + " = " + std::to_string(channel(i).value[plane]) + " in frame " +
           std::to_string(clip_.number[plane]);
  }

  const ClipData& clip_;
  const Decision& decision_;
  const std::vector<std::size_t>& begins_;
  const std::vector<std::size_t>& hazardous_;
  std::vector<std::size_t> coded_;  // channels, FAPs first
  std::size_t faps_ = 0;            // of them
  bool default_ranges_ = false;     // no intra ranges are sent
};

}  // namespace

Result<std::vector<Run>> plan_runs(const ClipData& clip, const Decision& decision,
                                   const std::vector<std::size_t>& begins,
                                   const PlanOptions& options) {
  return Planner(clip, decision, begins, options).plan();
}

}  // namespace animeme::fba::internal
