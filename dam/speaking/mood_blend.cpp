// How moods follow each other in time.
#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "dam/maths/raised_cosine.h"
#include "dam/speaking/moods.h"

namespace animeme::dam {
namespace {

constexpr double kComes = 0.4, kGoes = 0.6;  // seconds
constexpr double kBridged = 0.6;             // seconds between spans of one mood

double turn_of(const Mood& before, const Mood& after) {
  const double was = before.neutral() ? 0 : before.intensity;
  const double will = after.neutral() ? 0 : after.intensity;
  return will < was ? kGoes : kComes;
}

// What a set of spans says, by their places in a list.
Mood mood_among(const Mood& around, std::span<const MoodSpan> spans,
                const std::set<std::size_t>& here) {
  Mood mood = around;
  double gain = 1;
  for (const std::size_t i : here) {
    if (spans[i].mood) mood = *spans[i].mood;
    gain *= spans[i].gain;
  }
  mood.intensity = std::clamp(mood.intensity * gain, 0.0, 1.0);
  if (mood.neutral()) return {};
  return mood;
}

}  // namespace

MoodBlend::MoodBlend(const Mood& mood) {
  steps_.push_back({-std::numeric_limits<double>::infinity(), kComes, mood, mood_pose(mood)});
}

void MoodBlend::change(double seconds, const Mood& mood) {
  while (steps_.size() > 1 && steps_.back().begin >= seconds) steps_.pop_back();
  if (mood == steps_.back().mood) return;
  steps_.push_back({seconds, turn_of(steps_.back().mood, mood), mood, mood_pose(mood)});
}

std::vector<MoodBlend::Share> MoodBlend::shares(double seconds) const {
  // How far the way to each step has been gone; never further than to the one before it, so that
  // the shares of all are positive however fast they follow each other.
  std::vector<Share> shares;
  double gone = 1;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double next =
        k + 1 == steps_.size()
            ? 0.0
            : std::min(gone, raised_step((seconds - steps_[k + 1].begin) / steps_[k + 1].duration));
    if (gone > next) shares.push_back({&steps_[k].mood, &steps_[k].pose, gone - next});
    gone = next;
  }
  return shares;
}

MoodPose MoodBlend::at(double seconds) const {
  MoodPose pose;
  for (const Share& one : shares(seconds)) pose.add(*one.pose, one.share);
  return pose;
}

void MoodBlend::forget(double seconds) {
  std::size_t over = 0;
  while (over + 1 < steps_.size() &&
         steps_[over + 1].begin + steps_[over + 1].duration <= seconds) {
    ++over;
  }
  steps_.erase(steps_.begin(), steps_.begin() + std::ptrdiff_t(over));
}

bool MoodBlend::neutral() const {
  return std::all_of(steps_.begin(), steps_.end(),
                     [](const Step& step) { return step.mood.neutral(); });
}

MoodTrack::MoodTrack(const Mood& around, std::span<const MoodSpan> spans) {
  std::vector<std::pair<double, std::size_t>> begins, ends;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    if (!(spans[i].end > spans[i].start)) continue;
    begins.emplace_back(spans[i].start, i);
    ends.emplace_back(spans[i].end, i);
  }
  std::sort(begins.begin(), begins.end());
  std::sort(ends.begin(), ends.end());
  const Mood outside = around.neutral() ? Mood{} : around;
  parts_.push_back({-std::numeric_limits<double>::infinity(), outside});
  std::set<std::size_t> here;
  for (std::size_t b = 0, e = 0; e < ends.size();) {
    const double time =
        std::min(ends[e].first, b < begins.size() ? begins[b].first : ends[e].first);
    for (; e < ends.size() && ends[e].first == time; ++e) here.erase(ends[e].second);
    for (; b < begins.size() && begins[b].first == time; ++b) here.insert(begins[b].second);
    const Mood mood = mood_among(outside, spans, here);
    if (mood == parts_.back().mood) continue;
    const std::size_t last = parts_.size();
    const bool bridged = last > 1 && parts_[last - 1].mood == outside &&
                         parts_[last - 2].mood == mood && time - parts_[last - 1].start < kBridged;
    if (bridged) {
      parts_.pop_back();
    } else {
      parts_.push_back({time, mood});
    }
  }
}

bool MoodTrack::neutral() const {
  return std::all_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.mood.neutral(); });
}

MoodBlend MoodTrack::blend() const {
  MoodBlend blend(parts_.front().mood);
  for (std::size_t i = 1; i < parts_.size(); ++i) {
    // One that goes, goes behind the words.
    const bool comes = !parts_[i].mood.neutral();
    blend.change(parts_[i].start - (comes ? kMoodLead : 0), parts_[i].mood);
  }
  return blend;
}

}  // namespace animeme::dam
