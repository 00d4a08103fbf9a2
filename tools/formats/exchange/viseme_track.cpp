#include <algorithm>
#include <cmath>

#include "dam/maths/raised_cosine.h"
#include "dam/script/phones.h"
#include "tools/formats/exchange/visemes.h"

namespace animeme::exchange {

namespace {

constexpr double kMostFrames = 10'000'000;
constexpr double kShortestRun = 0.04 - 1e-9;  // seconds

// Viseme of the start of a sound; of HH that of the next one.
int first_viseme(const dam::Script& script, std::size_t i) {
  while (i + 1 < script.phones.size() && script.phones[i].label == "HH") ++i;
  const dam::PhoneInfo* phone = dam::find_phone(script.phones[i].label);
  return phone == nullptr ? 0 : phone->viseme_start;
}

std::size_t strongest(const fap::VisemeWeights& weights) {
  return std::size_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

std::vector<VisemeEvent> runs_of(const VisemeTrack& track) {
  std::vector<VisemeEvent> events;
  std::size_t begin = 0;
  for (std::size_t i = 1; i <= track.frames.size(); ++i) {
    const std::size_t viseme = strongest(track.frames[begin]);
    if (i < track.frames.size() && strongest(track.frames[i]) == viseme) continue;
    const double start = track.rate.seconds(double(begin));
    const double length = track.rate.seconds(double(i)) - start;
    begin = i;
    const bool same = !events.empty() && events.back().viseme == int(viseme);
    if (!events.empty() && (same || length < kShortestRun)) {
      events.back().duration += length;
    } else {
      events.push_back({start, length, {}, int(viseme)});
    }
  }
  return events;
}

}  // namespace

std::vector<VisemeEvent> script_events(const dam::Script& script) {
  std::vector<VisemeEvent> events;
  for (std::size_t i = 0; i < script.phones.size(); ++i) {
    const dam::Phone& phone = script.phones[i];
    const dam::PhoneInfo* info = dam::find_phone(phone.label);
    const int first = first_viseme(script, i);
    if (info == nullptr || info->viseme_start == info->viseme_end) {
      events.push_back({phone.start, phone.duration(), phone.label, first});
      continue;
    }
    const double half = phone.duration() / 2;
    events.push_back({phone.start, half, phone.label, first});
    events.push_back({phone.start + half, half, phone.label, info->viseme_end});
  }
  return events;
}

Result<VisemeTrack> track_of_events(std::vector<VisemeEvent> events, const fap::Rate& rate,
                                    double crossfade) {
  if (!rate.valid()) return make_error(Code::invalid_argument, "the frame rate is invalid");
  VisemeTrack track{rate, std::move(events), {}};
  if (track.events.empty()) return track;
  const std::vector<VisemeEvent>& list = track.events;
  const double end = list.back().time + list.back().duration;
  const double frames = std::ceil(end * rate.frames_per_second() - 1e-6);
  if (!(frames <= kMostFrames)) {
    return make_error(Code::out_of_range, "the script has more than 10 million frames");
  }
  track.frames.resize(std::size_t(std::max(frames, 0.0)));
  const auto border = [&](std::size_t i, double t) {  // between i and the one before
    const double width = std::min({crossfade, list[i - 1].duration, list[i].duration});
    if (!(width > 0)) return t >= list[i].time ? 1.0 : 0.0;
    return dam::raised_step((t - list[i].time) / width + 0.5);
  };
  std::size_t near = 0;
  for (std::size_t frame = 0; frame < track.frames.size(); ++frame) {
    const double t = rate.seconds(double(frame));
    while (near + 1 < list.size() && list[near + 1].time <= t) ++near;
    // No fade is longer than a neighbour, so three events at most are to be seen.
    const double in = near > 0 ? border(near, t) : 1;
    const double out = near + 1 < list.size() ? border(near + 1, t) : 0;
    auto& weights = track.frames[frame];
    weights[std::size_t(list[near].viseme)] += in - out;
    if (near > 0) weights[std::size_t(list[near - 1].viseme)] += 1 - in;
    if (near + 1 < list.size()) weights[std::size_t(list[near + 1].viseme)] += out;
  }
  return track;
}

VisemeTrack track_of_face(const fap::Sequence& clip) {
  VisemeTrack track{clip.rate, {}, {}};
  const bool coded = std::any_of(clip.frames.begin(), clip.frames.end(), [](const auto& frame) {
    return frame.mask[1] && !(fap::coded_viseme(frame.viseme)[0] >= 1);
  });
  fap::VisemeFitter fitter;
  for (fap::Frame frame : clip.frames) {
    frame.mask[1] = frame.mask[1] && coded;
    track.frames.push_back(fitter.fit(frame));
  }
  track.events = runs_of(track);
  return track;
}

}  // namespace animeme::exchange
