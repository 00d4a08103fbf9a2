#include "tools/formats/inspect/activity.h"

#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <type_traits>

#include "fap/tables.h"

namespace animeme::inspect {

namespace {

// Follows one parameter. Values are compared and, if they are numbers, measured.
template <class Value>
class Follower {
 public:
  // `since`: frames since the one before, 0 for the first. Nothing: the frame leaves it out.
  void add(const std::optional<Value>& given, std::int64_t since) {
    frames_ += given ? 1 : 0;
    if (!given && !held_) return;
    const Value value = given.value_or(held_.value_or(Value()));
    if (held_) {
      ++steps_;
      moved_ += value != *held_ ? 1 : 0;
      if constexpr (std::is_arithmetic_v<Value>) {
        const double speed = (double(value) - double(*held_)) / double(since);
        squares_ += speed * speed;
      }
    }
    if (given && (!held_ || value != *held_)) seen_.insert(value);
    held_ = value;
  }
  bool occurred() const { return held_.has_value(); }

  // `all`: frames of the clip.
  Activity measured(int number, std::int64_t all, fap::Rate rate) const {
    Activity out;
    out.number = number;
    out.frames = frames_;
    out.distinct = seen_.size();
    if (all > 1) out.moves = double(moved_) / double(all - 1);
    out.is_amount = std::is_arithmetic_v<Value>;
    if constexpr (std::is_arithmetic_v<Value>) {
      out.min = *seen_.begin();
      out.max = *seen_.rbegin();
      if (steps_ > 0) {
        out.rms_speed = std::sqrt(squares_ / double(steps_)) * rate.frames_per_second();
      }
    }
    return out;
  }

 private:
  std::set<Value> seen_;
  std::optional<Value> held_;
  std::int64_t frames_ = 0, steps_ = 0, moved_ = 0;
  double squares_ = 0;
};

// Frames so far, and how far they are apart.
class Numbers {
 public:
  std::int64_t since(std::int64_t number) {
    const std::int64_t since = all_++ == 0 ? 0 : number - last_;
    last_ = number;
    return since;
  }
  std::int64_t all() const { return all_; }

 private:
  std::int64_t all_ = 0, last_ = 0;
};

// Two FAPs that occur together and have the same value throughout.
struct Pair {
  int a, b;
  bool equal = true, present = false;

  void add(const fap::Frame& frame) {
    const std::size_t left = std::size_t(a), right = std::size_t(b);
    equal = equal && frame.mask[left] == frame.mask[right] &&
            (!frame.mask[left] || frame.value[left] == frame.value[right]);
    present = present || frame.mask[left];
  }
};

template <class Value>
std::optional<Value> value_if(bool given, const Value& value) {
  return given ? std::optional<Value>(value) : std::nullopt;
}

}  // namespace

struct FaceActivity::Impl {
  using Viseme = std::tuple<std::int32_t, std::int32_t, std::int32_t, bool>;
  using Expression = std::tuple<std::int32_t, std::int32_t, std::int32_t, std::int32_t, bool, bool>;

  Numbers numbers;
  Follower<Viseme> viseme;
  Follower<Expression> expression;
  std::array<Follower<std::int32_t>, fap::kFapCount + 1> fap;
  std::vector<Pair> pairs;
};

FaceActivity::FaceActivity() : impl_(std::make_unique<Impl>()) {
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    for (const int other : {fap::info(fap).mirror, fap::info(fap).partner}) {
      if (other != 0) impl_->pairs.push_back({fap, other});
    }
  }
}
FaceActivity::~FaceActivity() = default;

void FaceActivity::add(const fap::Frame& frame) {
  const std::int64_t since = impl_->numbers.since(frame.number);
  const fap::Viseme& v = frame.viseme;
  const fap::Expression& e = frame.expression;
  impl_->viseme.add(value_if(frame.mask[1], Impl::Viseme(v.select1, v.select2, v.blend, v.def)),
                    since);
  impl_->expression.add(value_if(frame.mask[2], Impl::Expression(e.select1, e.intensity1, e.select2,
                                                                 e.intensity2, e.init_face, e.def)),
                        since);
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    impl_->fap[fap].add(value_if(frame.mask[fap], frame.value[fap]), since);
  }
  for (Pair& pair : impl_->pairs) pair.add(frame);
}

std::vector<Activity> FaceActivity::measured(fap::Rate rate) const {
  std::vector<Activity> out;
  const std::int64_t all = impl_->numbers.all();
  if (impl_->viseme.occurred()) out.push_back(impl_->viseme.measured(1, all, rate));
  if (impl_->expression.occurred()) out.push_back(impl_->expression.measured(2, all, rate));
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const Follower<std::int32_t>& one = impl_->fap[std::size_t(fap)];
    if (!one.occurred()) continue;
    out.push_back(one.measured(fap, all, rate));
    for (const Pair& pair : impl_->pairs) {
      if (pair.a == fap && pair.equal && pair.present) out.back().equal_to.push_back(pair.b);
    }
  }
  return out;
}

struct BodyActivity::Impl {
  Numbers numbers;
  std::vector<Follower<std::int32_t>> bap = std::vector<Follower<std::int32_t>>(fba::kBapCount + 1);
};

BodyActivity::BodyActivity() : impl_(std::make_unique<Impl>()) {}
BodyActivity::~BodyActivity() = default;

void BodyActivity::add(const fba::BodyFrame& frame) {
  const std::int64_t since = impl_->numbers.since(frame.number);
  for (std::size_t bap = 1; bap <= std::size_t(fba::kBapCount); ++bap) {
    impl_->bap[bap].add(value_if(frame.mask[bap], frame.value[bap]), since);
  }
}

std::vector<Activity> BodyActivity::measured(fap::Rate rate) const {
  std::vector<Activity> out;
  for (int bap = 1; bap <= fba::kBapCount; ++bap) {
    const Follower<std::int32_t>& one = impl_->bap[std::size_t(bap)];
    if (one.occurred()) out.push_back(one.measured(bap, impl_->numbers.all(), rate));
  }
  return out;
}

std::vector<Activity> measure_activity(const fap::Sequence& clip) {
  FaceActivity activity;
  for (const fap::Frame& frame : clip.frames) activity.add(frame);
  return activity.measured(clip.rate);
}

std::vector<Activity> measure_activity(const fba::BodySequence& body) {
  BodyActivity activity;
  for (const fba::BodyFrame& frame : body.frames) activity.add(frame);
  return activity.measured(body.rate);
}

}  // namespace animeme::inspect
