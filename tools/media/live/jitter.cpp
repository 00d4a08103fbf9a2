#include "tools/media/live/jitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace animeme::media {
namespace {

constexpr std::int64_t kMaxJump = 3000;

}  // namespace

std::int64_t Unwrapper::add(std::uint32_t value) {
  if (!known_) {
    known_ = true;
    last_ = value;
  } else {
    last_ += std::int32_t(value - std::uint32_t(last_));
  }
  return last_;
}

std::int64_t ReorderBuffer::extend(std::uint16_t sequence) const {
  return highest_ + std::int16_t(std::uint16_t(sequence - std::uint16_t(highest_)));
}

void ReorderBuffer::begin_at(std::int64_t sequence) {
  expected_before_ = expected();
  begun_ = true;
  next_ = first_ = highest_ = sequence;
  given_.reset();
  waiting_.clear();
}

bool ReorderBuffer::was_given(std::int64_t sequence) const {
  return next_ - sequence <= std::int64_t(kHistory) && given_[std::size_t(sequence) % kHistory];
}

void ReorderBuffer::count_old(std::int64_t sequence) {
  if (sequence < first_ || was_given(sequence)) {
    ++counts_.duplicates;
  } else {
    ++counts_.late;
  }
}

bool ReorderBuffer::add(RtpPacket packet, double now) {
  if (!begun_) {
    begin_at(packet.sequence);
    begin_until_ = now + limits_.seconds;
  }
  std::int64_t sequence = extend(packet.sequence);
  if (std::abs(sequence - highest_) > kMaxJump) {
    const bool goes_on = jump_ && std::uint16_t(jump_->packet.sequence + 1) == packet.sequence;
    if (!goes_on) {
      jump_ = Waiting{std::move(packet), now};
      return false;
    }
    begin_at(jump_->packet.sequence);
    begin_until_ = now;
    restarted_ = true;
    ++counts_.received;
    waiting_.emplace(first_, *std::exchange(jump_, std::nullopt));
    sequence = first_ + 1;
  }
  jump_.reset();
  if (sequence < next_ && beginning(now)) next_ = first_ = sequence;
  if (sequence < next_) {
    count_old(sequence);
    return false;
  }
  if (!waiting_.try_emplace(sequence, Waiting{std::move(packet), now}).second) {
    ++counts_.duplicates;
    return false;
  }
  ++counts_.received;
  if (sequence < highest_) ++counts_.reordered;
  highest_ = std::max(highest_, sequence);
  return true;
}

// Nothing has been given out yet and there is time to wait.
bool ReorderBuffer::beginning(double now) const {
  return now < begin_until_ && next_ == first_ && waiting_.size() <= limits_.packets && !flushing_;
}

bool ReorderBuffer::must_go(double now) const {
  if (flushing_ || waiting_.size() > limits_.packets) return true;
  const std::optional<double> when = deadline();
  return when && *when <= now;
}

std::optional<ReorderBuffer::Item> ReorderBuffer::next(double now) {
  if (restarted_) {
    restarted_ = false;
    return Missing{};
  }
  if (waiting_.empty() || beginning(now)) return std::nullopt;
  const auto head = waiting_.begin();
  if (head->first != next_) {
    if (!must_go(now)) return std::nullopt;
    const Missing missing{head->first - next_};
    counts_.lost += missing.packets;
    for (; next_ < head->first; ++next_) given_.reset(std::size_t(next_) % kHistory);
    return missing;
  }
  RtpPacket packet = std::move(head->second.packet);
  waiting_.erase(head);
  given_.set(std::size_t(next_) % kHistory);
  ++next_;
  return packet;
}

std::optional<double> ReorderBuffer::deadline() const {
  if (waiting_.empty()) return std::nullopt;
  if (waiting_.begin()->first == next_) {
    const double since = waiting_.begin()->second.since;
    return next_ == first_ ? std::max(since, begin_until_) : since;
  }
  double oldest = waiting_.begin()->second.since;
  for (const auto& [sequence, waiting] : waiting_) oldest = std::min(oldest, waiting.since);
  return oldest + limits_.seconds;
}

void JitterMeter::add(std::uint32_t timestamp, double now, std::uint32_t clock) {
  const double transit = (now - last_arrival_) * clock - std::int32_t(timestamp - last_timestamp_);
  if (begun_) jitter_ += (std::abs(transit) - jitter_) / 16;
  begun_ = true;
  last_arrival_ = now;
  last_timestamp_ = timestamp;
}

}  // namespace animeme::media
