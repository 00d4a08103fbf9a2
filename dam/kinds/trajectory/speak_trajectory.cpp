#include <algorithm>
#include <cmath>

#include "dam/kinds/trajectory/fit_control.h"
#include "dam/kinds/trajectory/trajectory.h"
#include "dam/speaking/synthesise.h"

namespace animeme::dam {
namespace {

constexpr double kChunk = 30;        // seconds solved at once: bounds the memory
constexpr double kFadesWithin = 60;  // times the smoothness: what is further has no influence

std::vector<Gaussians> gaussians_of(const TrajectoryParameters& p) {
  const std::size_t controls = p.smoothness.size(), states = p.mean.size() / controls;
  std::vector<Gaussians> list(controls);
  for (std::size_t c = 0; c < controls; ++c) {
    list[c].log_smoothness = std::log(p.smoothness[c]);
    for (std::size_t s = 0; s < states; ++s) {
      list[c].mean.push_back(p.mean[s * controls + c]);
      list[c].log_precision.push_back(-std::log(p.variance[s * controls + c]));
    }
  }
  return list;
}

/// Frames [begin, end) of the speech from the phones around them.
class Speaker {
 public:
  Speaker(const Speech& speech, std::span<double> rows)
      : speech_(speech),
        rows_(rows),
        parameters_(std::get<TrajectoryParameters>(speech.model.parameters)),
        gaussians_(gaussians_of(parameters_)),
        margin_(kFadesWithin *
                *std::max_element(parameters_.smoothness.begin(), parameters_.smoothness.end())) {
    for (std::size_t j = 0; j < speech.timeline.size(); ++j)
      pieces_.push_back({speech.timeline[j].start, speech.timeline[j].duration, speech.phone[j]});
    ends_ = run_ends(pieces_);
  }

  void frames(std::size_t begin, std::size_t end) const {
    const double low = speech_.time(begin), high = speech_.time(end - 1);
    const auto is_before = [&](std::size_t run_end) { return pieces_[run_end - 1].end() < low; };
    const Grid grid = [&] {
      Grid made;
      for (auto e = std::partition_point(ends_.begin(), ends_.end(), is_before); e != ends_.end();
           ++e) {
        const std::size_t first = e == ends_.begin() ? 0 : *std::prev(e);
        if (pieces_[first].start > high) break;
        add_run(std::span(pieces_).subspan(first, *e - first), parameters_.states,
                {low - margin_, high + margin_}, made);
      }
      return made;
    }();
    const std::size_t controls = gaussians_.size();
    for (std::size_t c = 0; c < controls; ++c) {
      const Trajectory trajectory(grid, parameters_.order, gaussians_[c]);
      auto run = grid.runs.begin();
      for (std::size_t i = begin; i < end; ++i) {
        const double time = speech_.time(i);
        while (run != grid.runs.end() && run->end < time) ++run;
        if (run == grid.runs.end()) break;
        if (time >= run->start) rows_[i * controls + c] = trajectory.read(read_at(*run, time));
      }
    }
  }

 private:
  const Speech& speech_;
  std::span<double> rows_;
  const TrajectoryParameters& parameters_;
  std::vector<Gaussians> gaussians_;
  double margin_;
  std::vector<Piece> pieces_;
  std::vector<std::size_t> ends_;
};

}  // namespace

void speak_trajectory(const Speech& speech, std::span<double> rows, SynthesisReport&) {
  const Speaker speaker(speech, rows);
  const double frames = std::max(1.0, kChunk * speech.rate.frames_per_second());
  const auto chunk = std::size_t(frames);
  for (std::size_t begin = 0; begin < speech.frames; begin += chunk)
    speaker.frames(begin, std::min(speech.frames, begin + chunk));
}

/// A pull fades by 1 / e within about the smoothness; ten times that is nothing.
double reach_of_trajectory(const Model& model) {
  const auto& smoothness = std::get<TrajectoryParameters>(model.parameters).smoothness;
  return 10 * *std::max_element(smoothness.begin(), smoothness.end());
}

}  // namespace animeme::dam
