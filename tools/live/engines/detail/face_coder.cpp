#include "tools/live/engines/detail/face_coder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "codec/decode/access_unit.h"

namespace animeme::engines {
namespace {

constexpr std::size_t kEnough = 12;  // faces that tell their rate
constexpr double kLongEnough = 1;    // seconds likewise
constexpr double kUntimed = 2;       // seconds of those that have no time of their own
constexpr std::size_t kMostWaiting = 1000;
constexpr int kCommon[] = {15, 24, 25, 30, 45, 48, 50, 60, 72, 75, 90, 100, 120};
constexpr double kNearby = 0.08;            // share that a rate is off one in common use
constexpr std::ptrdiff_t kObjectBytes = 5;  // its start code, and a byte of stuffing
constexpr double kMostFilled = 1;           // seconds that are filled in

int snapped(double rate) {
  const int common =
      *std::min_element(std::begin(kCommon), std::end(kCommon),
                        [rate](int a, int b) { return std::abs(rate - a) < std::abs(rate - b); });
  if (std::abs(rate - common) <= kNearby * common) return common;
  return int(std::lround(std::clamp(rate, 15.0, 120.0)));
}

}  // namespace

FaceCoder::FaceCoder(std::optional<int> rate, double intra_seconds)
    : rate_(rate), intra_seconds_(intra_seconds) {}

void FaceCoder::restart() {
  encoder_.reset();
  waiting_.clear();
  last_.reset();
  channels_.reset();
}

// The usual step by the sender's clock; by ours, where packets come in heaps, the mean of all.
bool FaceCoder::measure() {
  const bool timed = waiting_.back().face.seconds.has_value();
  const double length = waiting_.back().seconds - waiting_.front().seconds;
  const bool enough = timed ? waiting_.size() >= kEnough || length >= kLongEnough
                            : length >= kUntimed || waiting_.size() >= kMostWaiting;
  if (!enough) return false;
  std::vector<double> steps;
  for (std::size_t i = 1; i < waiting_.size(); ++i) {
    steps.push_back(waiting_[i].seconds - waiting_[i - 1].seconds);
  }
  const auto middle = steps.begin() + std::ptrdiff_t(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double step = timed ? *middle : length / double(steps.size());
  rate_ = snapped(step > 0 ? 1 / step : 60);
  return true;
}

Result<void> FaceCoder::push(double seconds, const ReceivedFace& face,
                             std::deque<media::LiveEvent>& out) {
  if (rate_) return place(seconds, face, out);
  waiting_.push_back({seconds, face});
  if (!measure()) return {};
  for (const Waiting& each : std::exchange(waiting_, {})) {
    if (auto ok = place(each.seconds, each.face, out); !ok) return ok;
  }
  return {};
}

Result<void> FaceCoder::begin(const ReceivedFace& face, std::deque<media::LiveEvent>& out) {
  fba::LiveOptions options;
  options.rate = fap::make_rate(std::uint32_t(*rate_));
  options.intra_seconds = intra_seconds_;
  // What a stream looks like is asked of one that has a single plane.
  fba::LiveEncoder sample(options);
  auto stream = sample.write(fap::arkit_to_fap(face.values, face.channels));
  if (!stream) return stream.error();
  const auto end = sample.finish();
  stream->insert(stream->end(), end.begin(), end.end());
  const auto units = fba::split_access_units(*stream);
  if (!units) return units.error();
  media::LiveInfo info;
  info.face_config = units->config;
  info.timescale = units->timescale;
  ticks_ = units->units.front().duration;
  encoder_ = std::make_unique<fba::LiveEncoder>(options);
  fresh_ = true;
  out.emplace_back(std::move(info));
  return {};
}

Result<void> FaceCoder::code(const fap::ArkitFrame& values, std::deque<media::LiveEvent>& out) {
  auto bytes = encoder_->write(fap::arkit_to_fap(values, channels_));
  if (!bytes) return bytes.error();
  media::LiveUnit unit;
  unit.bytes = std::move(*bytes);
  // The object begins once: what comes behind a gap is the same stream.
  if (std::exchange(fresh_, false) && std::exchange(begun_, true)) {
    unit.bytes.erase(unit.bytes.begin(), unit.bytes.begin() + kObjectBytes);
  }
  unit.intra = encoder_->intra();
  unit.time = *last_ * ticks_;
  unit.duration = ticks_;
  out.emplace_back(std::move(unit));
  return {};
}

Result<void> FaceCoder::place(double seconds, const ReceivedFace& face,
                              std::deque<media::LiveEvent>& out) {
  const std::int64_t place = std::llround(seconds * *rate_);
  if (last_ && place <= *last_) {
    ++late_;
    return {};
  }
  if (encoder_ && last_ && double(place - *last_) > kMostFilled * *rate_) {
    out.emplace_back(media::LiveGap{media::LiveTrack::face, 0});
    encoder_.reset();
    last_.reset();
  }
  if (!encoder_) {
    if (auto ok = begin(face, out); !ok) return ok;
  }
  channels_ |= face.channels;
  const fap::ArkitFrame from = last_ ? shown_ : face.values;
  const std::int64_t before = last_.value_or(place - 1);
  for (std::int64_t at = before + 1; at <= place; ++at) {
    last_ = at;
    const double share = double(at - before) / double(place - before);
    for (std::size_t i = 0; i < from.size(); ++i) {
      shown_[i] = at == place ? face.values[i] : from[i] + (face.values[i] - from[i]) * share;
    }
    if (auto ok = code(shown_, out); !ok) return ok;
  }
  return {};
}

}  // namespace animeme::engines
