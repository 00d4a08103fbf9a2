#include "dam/script/timeline_internal.h"

#include <algorithm>
#include <limits>

namespace animeme::dam {
namespace {

Occurrence silent(double start, double duration) {
  return {std::string(kSilence), start, std::max(duration, kShortestPhone), {}, {}, 0};
}

void add_pause(std::vector<Occurrence>& out, double start, double end, double edge) {
  if (end - start > 2 * edge) {
    out.push_back(silent(start, edge));
    out.push_back(silent(end - edge, edge));
  } else if (end - start > kTimeTolerance) {
    out.push_back(silent(start, end - start));
  }
}

/// Neighbours that do not touch have the resting mouth between them.
void link(std::vector<Occurrence>& list) {
  for (std::size_t i = 1; i < list.size(); ++i) {
    if (list[i].start - list[i - 1].end() > kTimeTolerance) continue;
    list[i].left = list[i - 1].label;
    list[i - 1].right = list[i].label;
  }
}

}  // namespace

std::vector<Stretch> speech_stretches(const Script& script) {
  std::vector<Stretch> list;
  for (const Phone& phone : script.phones) {
    if (phone.label == kSilence) continue;
    if (!list.empty() && phone.start - list.back().end <= kTimeTolerance)
      list.back().end = std::max(list.back().end, phone.end);
    else
      list.push_back({phone.start, phone.end});
  }
  return list;
}

std::vector<Occurrence> make_timeline(const Script& script, double pause_edge) {
  std::vector<Occurrence> out;
  double spoken_until = 0;
  for (const Phone& phone : script.phones) {
    if (phone.label == kSilence) continue;
    if (out.empty())
      out.push_back(silent(phone.start - pause_edge, pause_edge));
    else
      add_pause(out, spoken_until, phone.start, pause_edge);
    out.push_back(
        {phone.label, phone.start, std::max(phone.duration(), kShortestPhone), {}, {}, 0});
    spoken_until = phone.end;
  }
  if (!out.empty()) out.push_back(silent(spoken_until, pause_edge));
  link(out);
  return out;
}

void hold_drawn_out(std::vector<Occurrence>& timeline,
                    const std::function<double(const std::string&)>& longest_of) {
  for (Occurrence& o : timeline) {
    if (o.label != kSilence) o.hold = std::max(0.0, o.duration - longest_of(o.label));
  }
}

double distance_to_speech(const std::vector<Stretch>& stretches, double time) {
  const auto after = std::partition_point(stretches.begin(), stretches.end(),
                                          [&](const Stretch& s) { return s.end < time; });
  double distance = std::numeric_limits<double>::infinity();
  if (after != stretches.end()) distance = std::max(0.0, after->start - time);
  if (after != stretches.begin()) distance = std::min(distance, time - std::prev(after)->end);
  return distance;
}

}  // namespace animeme::dam
