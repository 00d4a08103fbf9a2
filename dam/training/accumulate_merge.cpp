// Adding up parts.
#include <algorithm>

#include "dam/training/accumulate.h"
#include "dam/training/training_sums_internal.h"

namespace animeme::dam {
namespace {

/// What differs between two bases, in words; empty if nothing does.
std::string difference(const SumsBase& a, const SumsBase& b) {
  if (a == b) return {};
  if (a.pause_edge != b.pause_edge) return "pause edges";
  if (a.offset_frames != b.offset_frames) return "weights of sentence offsets";
  if (a.refined.time_margin != b.refined.time_margin) return "time margins";
  if (a.refined.duration_exponent != b.refined.duration_exponent) return "duration exponents";
  for (std::size_t p = 0; p < std::min(a.phones.size(), b.phones.size()); ++p)
    if (!(a.phones[p] == b.phones[p]) || !(a.refined.dominance[p] == b.refined.dominance[p]))
      return "dominances or usual durations (first of " + a.phones[p].label + ")";
  return "phones";
}

/// A sentence that both have, empty: none.
std::string common_sentence(const SumsState& a, const SumsState& b) {
  for (const auto& sentence : b.sentences)
    if (a.sentences.contains(sentence)) return sentence.first;
  return {};
}

void add_statistics(const SumsState& from, SumsState& to) {
  to.speech_frames += from.speech_frames;
  to.rest_frames += from.rest_frames;
  for (std::size_t c = 0; c < to.controls.size(); ++c) {
    const ControlSums& a = from.controls[c];
    ControlSums& b = to.controls[c];
    b.low = std::min(a.low, b.low);
    b.high = std::max(a.high, b.high);
    b.sum.add(a.sum);
    b.squares.add(a.squares);
    b.rest_sum.add(a.rest_sum);
  }
  for (std::size_t p = 0; p < to.phones.size(); ++p) {
    to.phones[p].examples += from.phones[p].examples;
    to.phones[p].log_duration.add(from.phones[p].log_duration);
    to.phones[p].longest = std::max(to.phones[p].longest, from.phones[p].longest);
  }
  to.closures.add(from.closures);
  to.lip_tooth.add(from.lip_tooth);
  to.shut.add(from.shut);
  to.sentences.insert(from.sentences.begin(), from.sentences.end());
}

}  // namespace

Result<void> TrainingSums::check_same_base(const TrainingSums& other) const {
  const std::string what = difference(state_->base, other.state_->base);
  if (what.empty()) return {};
  return refused("the sums were made for other " + what +
                 "; make all parts with the same model for the dominance and the same options");
}

Result<void> TrainingSums::merge(const TrainingSums& other) {
  SumsState& to = *state_;
  const SumsState& from = *other.state_;
  if (auto ok = check_same_base(other); !ok) return ok;
  if (from.controls.empty()) return {};
  if (!to.controls.empty() && other.controls() != controls())
    return refused("the sums have other controls; make all parts with the same --controls");
  if (!to.controls.empty() && !(to.rate == from.rate))
    return refused("the sums have another frame rate; resample one of the corpora");
  if (const std::string id = common_sentence(to, from); !id.empty())
    return refused("the sentence '" + id +
                   "' is in two of the parts and would count twice; give every sentence to one "
                   "part only");
  if (!fits(from.kept, to.kept) || !fits(from.held, to.held))
    return refused("the sums have too many frames for one model; train on some of the parts");
  if (to.controls.empty()) set_controls(to, other.controls(), from.rate);
  widen(to, from.space);
  add_fit(from.kept, from, to, to.kept);
  add_fit(from.held, from, to, to.held);
  add_statistics(from, to);
  return {};
}

Result<TrainingSums> merge_training_sums(std::span<const std::filesystem::path> paths) {
  if (paths.empty()) return refused("there are no sums to merge");
  auto sums = load_training_sums(paths[0]);
  for (const auto& path : paths.subspan(1)) {
    if (!sums) break;
    const auto part = load_training_sums(path);
    if (!part) return part.error();
    if (auto ok = sums->merge(*part); !ok) return std::move(ok).error().in_file(path.string());
  }
  return sums;
}

}  // namespace animeme::dam
