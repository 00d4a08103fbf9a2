#include "tools/inspect/activity.h"

#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <type_traits>

#include "fap/tables.h"

namespace animeme::inspect {

namespace {

// Follows one parameter over a clip. `value_of` gives what counts as its value; values are
// compared and, if they are numbers, measured.
template <class Frame, class ValueOf>
Activity follow(const std::vector<Frame>& frames, fap::Rate rate, int number, ValueOf value_of) {
  using Value = decltype(value_of(frames.front()));
  Activity out;
  out.number = number;
  std::set<Value> seen;
  std::optional<Value> held;
  double squares = 0;
  std::int64_t steps = 0;
  std::int64_t moved = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i];
    const bool present = frame.mask[std::size_t(number)];
    out.frames += present ? 1 : 0;
    if (!present && !held) continue;
    const Value value = present ? value_of(frame) : *held;
    if (held) {
      ++steps;
      moved += value != *held ? 1 : 0;
      if constexpr (std::is_arithmetic_v<Value>) {
        const double seconds = rate.seconds(double(frame.number - frames[i - 1].number));
        const double speed = (double(value) - double(*held)) / seconds;
        squares += speed * speed;
      }
    }
    if (present) seen.insert(value);
    held = value;
  }
  out.distinct = seen.size();
  if (frames.size() > 1) out.moves = double(moved) / double(frames.size() - 1);
  out.is_amount = std::is_arithmetic_v<Value>;
  if constexpr (std::is_arithmetic_v<Value>) {
    out.min = *seen.begin();
    out.max = *seen.rbegin();
    if (steps > 0) out.rms_speed = std::sqrt(squares / double(steps));
  }
  return out;
}

bool equal_throughout(const fap::Sequence& clip, int a, int b) {
  const std::size_t left = std::size_t(a);
  const std::size_t right = std::size_t(b);
  bool present = false;
  for (const fap::Frame& frame : clip.frames) {
    if (frame.mask[left] != frame.mask[right]) return false;
    if (frame.mask[left] && frame.value[left] != frame.value[right]) return false;
    present |= frame.mask[left];
  }
  return present;
}

}  // namespace

std::vector<Activity> measure_activity(const fap::Sequence& clip) {
  const fap::Mask used = used_mask(clip.frames);
  std::vector<Activity> out;
  if (used[1]) {
    out.push_back(follow(clip.frames, clip.rate, 1, [](const fap::Frame& f) {
      return std::tuple(f.viseme.select1, f.viseme.select2, f.viseme.blend, f.viseme.def);
    }));
  }
  if (used[2]) {
    out.push_back(follow(clip.frames, clip.rate, 2, [](const fap::Frame& f) {
      const fap::Expression& e = f.expression;
      return std::tuple(e.select1, e.intensity1, e.select2, e.intensity2, e.init_face, e.def);
    }));
  }
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const std::size_t index = std::size_t(fap);
    if (!used[index]) continue;
    Activity one = follow(clip.frames, clip.rate, fap,
                          [index](const fap::Frame& f) { return f.value[index]; });
    for (const int other : {fap::info(fap).mirror, fap::info(fap).partner}) {
      if (other != 0 && equal_throughout(clip, fap, other)) one.equal_to.push_back(other);
    }
    out.push_back(std::move(one));
  }
  return out;
}

std::vector<Activity> measure_activity(const fba::BodySequence& body) {
  const auto used = used_mask(body.frames);
  std::vector<Activity> out;
  for (int bap = 1; bap <= fba::kBapCount; ++bap) {
    const std::size_t index = std::size_t(bap);
    if (!used[index]) continue;
    out.push_back(follow(body.frames, body.rate, bap,
                         [index](const fba::BodyFrame& f) { return f.value[index]; }));
  }
  return out;
}

}  // namespace animeme::inspect
