#include "dam/corpus/train_options.h"

#include <limits>

namespace animeme::dam {
namespace {

struct Range {
  const char* name;
  double value, low, high;
};

}  // namespace

Result<void> validate(const TrainOptions& o) {
  const AnimemeOptions& a = o.animeme;
  const RefinedOptions& r = o.refined;
  const double infinity = std::numeric_limits<double>::infinity();
  const Range ranges[] = {
      {"animeme.order", double(a.order), 0, kMaxOrder},
      {"animeme.resample_points", double(a.resample_points), 2, 32},
      {"animeme.preference", a.preference, 0.1, 100},
      {"animeme.damping", a.damping, 0.5, 0.99},
      {"animeme.affinity_iterations", double(a.affinity_iterations), 1, 10000},
      {"animeme.affinity_limit", double(a.affinity_limit), 2, 5000},
      {"animeme.mode_examples", double(a.mode_examples), 1, 1e6},
      {"animeme.reassign_rounds", double(a.reassign_rounds), 0, 100},
      {"animeme.context_weight", a.context_weight, 0, 1e6},
      {"animeme.ridge", a.ridge, 0, 1e6},
      {"animeme.width_prior", a.width_prior, 0, 1e6},
      {"animeme.time_margin", a.time_margin, 0, infinity},
      {"refined.ridge", r.ridge, 0, 1000},
      {"refined.rare_words", r.rare_words, 0, 1},
      {"refined.width_prior", r.width_prior, 0, 1e6},
      {"refined.offset_frames", r.offset_frames, 0.01, 1e9},
      {"refined.time_margin", r.time_margin, 0, 100},
      {"refined.duration_exponent", r.duration_exponent, 0, 2},
      {"refined.terms", double(r.terms), 1, kAllTerms},
      {"trajectory.states", double(o.trajectory.states), 1, 8},
      {"trajectory.order", double(o.trajectory.order), 1, 4},
      {"trajectory.mean_prior", o.trajectory.mean_prior, 0, 1e6},
      {"trajectory.variance_prior", o.trajectory.variance_prior, 0, 1e6},
      {"trajectory.tolerance", o.trajectory.tolerance, 0, 1},
      {"table.pose_prior", o.table.pose_prior, 0, 1e9},
      {"table.points", double(o.table.points), 2, 64},
      {"table.reach", o.table.reach, 0.01, 0.5},
      {"table.minimum", double(o.table.minimum), 1, 1e6},
      {"table.trust", o.table.trust, 0, 1e6},
      {"max_iterations", double(o.max_iterations), 0, 1000},
      {"tolerance", o.tolerance, 0, 1},
      {"pause_edge", o.pause_edge, 0.05, 5},
      {"threads", double(o.threads), 0, 1024},
  };
  for (const Range& x : ranges)
    if (!(x.value >= x.low && x.value <= x.high))
      return make_error(Code::invalid_argument, std::string("training option ") + x.name +
                                                    " must lie between " + std::to_string(x.low) +
                                                    " and " + std::to_string(x.high));
  if ((r.terms & 1) == 0)
    return make_error(Code::invalid_argument,
                      "training option refined.terms must include the term of the phone");
  if (method_name(o.method).empty())
    return make_error(Code::invalid_argument, "training option method is unknown");
  return {};
}

}  // namespace animeme::dam
