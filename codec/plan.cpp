#include <algorithm>
#include <optional>
#include <string>

#include "codec/code_length_internal.h"
#include "codec/plan_internal.h"
#include "codec/state_internal.h"

namespace animeme::fba::internal {

namespace {

using Planes = std::vector<std::size_t>;  // indices, ascending

constexpr int kTurnsBeforeIntra = 3;  // detours taken for one plane

class Planner {
 public:
  Planner(const ClipData& clip, const Decision& decision, const PlanOptions& options)
      : clip_(clip), decision_(decision), options_(options) {
    for (std::size_t i = 0; i < clip.channels.size(); ++i) {
      if (decision.rows[i].role != Role::coded) continue;
      coded_.push_back(i);
      if (!channel(i).body) ++faps_;
    }
  }

  Result<std::vector<Run>> plan() {
    if (auto ok = check_reach(); !ok) return ok.error();
    Planes begins = due();
    begins = split_where_needed(begins);
    if (options_.extra_intra) begins = split_where_it_pays(begins);
    std::vector<Run> runs;
    for (std::size_t i = 0; i < begins.size(); ++i) {
      const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : clip_.planes();
      Result<Run> run = settle(begins[i], end - begins[i]);
      if (!run) return run.error();
      runs.push_back(std::move(*run));
    }
    return runs;
  }

 private:
  const Channel& channel(std::size_t i) const { return clip_.channels[i]; }
  int quant(std::size_t i) const { return decision_.quant(channel(i)); }
  int scale(std::size_t i) const { return scale_at(channel(i).body, quant(i)); }
  std::span<const std::int32_t> levels(std::size_t i, std::size_t first, std::size_t count) const {
    return std::span(decision_.rows[i].levels).subspan(first, count);
  }

  // Where other ranges do not help against a trap (there may be no parameter that has any, or all
  // are as wide as they can be), an intra plane will.
  Planes due() const {
    const std::size_t period =
        options_.intra_period > 0 ? std::size_t(options_.intra_period) : clip_.planes();
    Planes begins;
    for (std::size_t plane = 0; plane < clip_.planes(); plane += period) begins.push_back(plane);
    const Planes& trapped = options_.trapped;
    for (auto it = trapped.begin(); it != trapped.end();) {
      const auto next = std::upper_bound(it, trapped.end(), *it);
      if ((coded_.empty() || next - it > kTurnsBeforeIntra) && can_be_intra(*it)) {
        begins.push_back(*it);
      }
      it = next;
    }
    tidy(begins);
    return begins;
  }

  bool can_be_intra(std::size_t plane) const {
    return std::all_of(coded_.begin(), coded_.end(), [&](std::size_t i) {
      return std::abs(std::int64_t(decision_.rows[i].levels[plane])) <=
             level_range(kMaxRange, scale(i));
    });
  }

  static void tidy(Planes& planes) {
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  }

  // An intra plane at every change that no range can hold.
  Planes split_where_needed(Planes begins) const {
    for (const std::size_t i : coded_) {
      const auto row = levels(i, 0, clip_.planes());
      const std::int64_t limit = level_range(kMaxRange, scale(i));
      for (std::size_t plane = 1; plane < row.size(); ++plane) {
        if (std::abs(std::int64_t(row[plane]) - row[plane - 1]) > limit) begins.push_back(plane);
      }
    }
    tidy(begins);
    return begins;
  }

  // What a run costs without the symbols of FAP 1 and 2 and the headers of its planes; nothing if
  // its intra plane cannot be coded.
  std::optional<Bits> cost(std::size_t first, std::size_t count) const {
    Bits bits = 80 * kOneBit;  // header and masks, within a few bits
    for (const std::size_t i : coded_) {
      const RunCost run = run_cost(levels(i, first, count), scale(i));
      if (!run.fits) return std::nullopt;
      bits += run.bits;
    }
    return bits;
  }

  // The plane whose change alone makes the ranges of its run so wide that learning them costs
  // most, if that could be more than an intra plane does; 0: none.
  std::size_t costly_jump(std::size_t first, std::size_t count) const {
    std::vector<Bits> loss(count, 0);
    for (const std::size_t i : coded_) {
      const auto row = levels(i, first, count);
      std::int64_t largest = 0;
      std::int64_t second = 0;
      std::size_t at = 0;
      for (std::size_t plane = 1; plane < count; ++plane) {
        const std::int64_t change = std::abs(std::int64_t(row[plane]) - row[plane - 1]);
        if (change > largest) {
          second = largest;
          largest = change;
          at = plane;
        } else {
          second = std::max(second, change);
        }
      }
      const std::uint32_t wide = alphabet(largest, scale(i));
      const std::uint32_t narrow = alphabet(second, scale(i));
      if (wide == narrow) continue;
      const std::uint32_t planes = std::uint32_t(count);
      loss[at] += log2_factorial(wide + planes) - log2_factorial(wide) -
                  log2_factorial(narrow + planes) + log2_factorial(narrow);
    }
    const auto worst = std::max_element(loss.begin(), loss.end());
    const Bits intra_plane = Bits(80 + 24 * coded_.size()) * kOneBit;
    return *worst > intra_plane ? std::size_t(worst - loss.begin()) : 0;
  }

  static std::uint32_t alphabet(std::int64_t change, int scale) {
    return std::uint32_t(2 * level_range(range_number(change, scale), scale) + 1);
  }

  Planes split_where_it_pays(const Planes& begins) const {
    Planes out;
    for (std::size_t i = 0; i < begins.size(); ++i) {
      const std::size_t end = i + 1 < begins.size() ? begins[i + 1] : clip_.planes();
      split(begins[i], end - begins[i], out);
    }
    tidy(out);
    return out;
  }

  void split(std::size_t first, std::size_t count, Planes& out) const {
    out.push_back(first);
    const std::size_t jump = costly_jump(first, count);
    if (jump == 0) return;
    const std::optional<Bits> one = cost(first, count);
    const std::optional<Bits> before = cost(first, jump);
    const std::optional<Bits> behind = cost(first + jump, count - jump);
    if (!one || !before || !behind || *before + *behind >= *one) return;
    split(first, jump, out);
    split(first + jump, count - jump, out);
  }

  Result<Run> settle(std::size_t first, std::size_t count) const {
    Run run;
    run.first = first;
    run.count = count;
    set_up(run);
    const std::size_t detours = trapped_in(first, count);
    for (std::size_t n = 0; n < coded_.size(); ++n) {
      const std::size_t i = coded_[n];
      RunCost ranges = run_ranges(levels(i, first, count), scale(i));
      if (!ranges.fits) return too_large(i, first);
      for (std::size_t turn = turn_of(n); turn < detours; turn += coded_.size()) {
        take_detour(ranges, is_last(n));
      }
      for (std::size_t kind = 0; kind < 4; ++kind) {
        const std::size_t number = std::size_t(channel(i).number);
        (channel(i).body ? run.body.range[kind][number] : run.face.range[kind][number]) =
            ranges.range[kind];
      }
    }
    guard_fap4(run.face);
    return run;
  }

  std::size_t trapped_in(std::size_t first, std::size_t count) const {
    const Planes& trapped = options_.trapped;
    return std::size_t(std::lower_bound(trapped.begin(), trapped.end(), first + count) -
                       std::lower_bound(trapped.begin(), trapped.end(), first));
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
    std::array<bool, fap::kGroupCount + 1> interpolated{};
    for (std::size_t i = 0; i < clip_.channels.size(); ++i) {
      const std::size_t number = std::size_t(channel(i).number);
      const Role role = decision_.rows[i].role;
      if (channel(i).body) {
        run.body.mask[number] = role == Role::coded;
      } else {
        run.face.mask[number] = role == Role::coded;
        if (role == Role::mirrored) {
          interpolated[std::size_t(fap::info(channel(i).number).group)] = true;
        }
      }
    }
    guard_unsaid(interpolated, run.face.mask);
    for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
      const fap::GroupInfo& info = fap::kGroups[group];
      int coded = 0;
      for (int n = 0; n < info.size; ++n) coded += run.face.mask[std::size_t(info.first + n)];
      run.face.mask_type[group] = mask_type(coded, info.size, interpolated[group + 1]);
    }
    guard_last_group(run.body.mask);
    std::size_t slot = 0;
    for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
      int coded = 0;
      for (int n = 0; n < kBodyGroupSizes[group]; ++n) coded += run.body.mask[kBapOrder[slot++]];
      run.body.mask_type[group] = mask_type(coded, kBodyGroupSizes[group], false);
    }
  }

  // FAPs that the clip does not have rest at 0 in a group that holds. In a group that became one of
  // type 2 for the sake of others they are coded as zeros, or a decoder would move them.
  void guard_unsaid(const std::array<bool, fap::kGroupCount + 1>& interpolated,
                    fap::Mask& mask) const {
    fap::Mask in_clip;
    for (const Channel& channel : clip_.channels) {
      if (!channel.body) in_clip.set(std::size_t(channel.number));
    }
    const fap::Mask coded = mask;
    const auto moves = [&coded](int fap) { return fap != 0 && coded[std::size_t(fap)]; };
    for (int number = fap::kFirstLowLevel; number <= fap::kFapCount; ++number) {
      const fap::FapInfo& fap = fap::info(number);
      if (in_clip[std::size_t(number)] || !interpolated[std::size_t(fap.group)]) continue;
      const int across = fap.partner == 0 ? 0 : fap::info(fap.partner).mirror;
      if (moves(fap.mirror) || moves(fap.partner) || moves(across)) mask.set(std::size_t(number));
    }
  }

  static MaskType mask_type(int coded, int size, bool interpolated) {
    if (coded == 0) return MaskType::none;
    if (coded == size) return MaskType::all;
    return interpolated ? MaskType::interpolate : MaskType::hold;
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
  const PlanOptions& options_;
  std::vector<std::size_t> coded_;  // channels, FAPs first
  std::size_t faps_ = 0;            // of them
};

bool is_event(const ClipData& clip, std::size_t plane) {
  if (clip.viseme.empty()) return false;
  const bool same = clip.viseme[plane] == clip.viseme[plane - 1] &&
                    clip.expression[plane] == clip.expression[plane - 1];
  return !same || clip.viseme[plane].def || clip.expression[plane].def ||
         clip.expression[plane].init_face;
}

}  // namespace

std::vector<std::size_t> moving_planes(const ClipData& clip, const Decision& decision) {
  std::vector<bool> moving(clip.planes(), false);
  moving.back() = true;
  for (const Row& row : decision.rows) {
    for (std::size_t plane = 1; plane < moving.size(); ++plane) {
      if (row.levels[plane] != row.levels[plane - 1]) moving[plane] = true;
    }
  }
  std::vector<std::size_t> planes = {0};
  for (std::size_t plane = 1; plane < moving.size(); ++plane) {
    const bool far = plane + 1 < moving.size() &&
                     clip.number[plane + 1] - clip.number[planes.back()] > kMaxSkip + 1;
    if (moving[plane] || is_event(clip, plane) || far) planes.push_back(plane);
  }
  return planes;
}

Result<std::vector<Run>> plan_runs(const ClipData& clip, const Decision& decision,
                                   const PlanOptions& options) {
  return Planner(clip, decision, options).plan();
}

}  // namespace animeme::fba::internal
