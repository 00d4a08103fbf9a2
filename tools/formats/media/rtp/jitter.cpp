#include "tools/formats/media/rtp/jitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace animeme::media {
namespace {

constexpr std::int64_t kMaxJump = 3000;
constexpr double kNoCopy = 5;     // seconds behind the original
constexpr double kPausing = 0.5;  // nothing new comes any more
constexpr double kWindow = 15;
constexpr double kMargin = 1.25;
constexpr double kTick = 0.01;  // seconds: what is less late needs no more waiting

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
  waiting_bytes_ = 0;
}

ReorderBuffer ReorderBuffer::renewed() const {
  ReorderBuffer fresh(limits_);
  fresh.lateness_ = lateness_;
  fresh.latest_ = latest_;
  fresh.longest_wait_ = longest_wait_;
  return fresh;
}

double ReorderBuffer::wait() const {
  const double worst = std::max(lateness_.worst, lateness_.worst_before);
  const double wanted = worst > kTick ? kMargin * worst : 0;
  return std::clamp(wanted, limits_.seconds, std::max(limits_.seconds, limits_.most_seconds));
}

// Copies come soon. What is as old as this is of a sender that counts anew.
bool ReorderBuffer::is_elsewhere(std::int64_t sequence, double now) const {
  if (std::abs(sequence - highest_) > kMaxJump) return true;
  if (sequence >= next_ || now - last_new_ < kPausing) return false;
  const bool known = highest_ - sequence < std::int64_t(kHistory) && sequence >= first_;
  return known ? now - since_[std::size_t(sequence) % kHistory] > kNoCopy
               : now - since_[std::size_t(std::max(first_, highest_ - std::int64_t(kHistory) + 1)) %
                              kHistory] >
                     kNoCopy;
}

void ReorderBuffer::expect_up_to(std::int64_t sequence, double now) {
  last_new_ = now;
  for (std::int64_t each = std::max(highest_ + 1, sequence - std::int64_t(kHistory) + 1);
       each <= sequence; ++each) {
    since_[std::size_t(each) % kHistory] = now;
  }
  highest_ = sequence;
}

void ReorderBuffer::measure(std::int64_t sequence, double now) {
  if (now - lateness_.begin > kWindow) {
    const bool long_ago = now - lateness_.begin > 2 * kWindow;
    lateness_ = {now, 0, long_ago ? 0 : lateness_.worst};
  }
  if (sequence > highest_ || sequence < first_ || highest_ - sequence >= std::int64_t(kHistory)) {
    return;
  }
  const double late = now - since_[std::size_t(sequence) % kHistory];
  if (late > kNoCopy) return;
  lateness_.worst = std::max(lateness_.worst, late);
  latest_ = std::max(latest_, late);
  longest_wait_ = std::max(longest_wait_, wait());
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
    expect_up_to(highest_, now);
  } else {
    measure(extend(packet.sequence), now);
  }
  std::int64_t sequence = extend(packet.sequence);
  if (is_elsewhere(sequence, now)) {
    const bool goes_on = jump_ && std::uint16_t(jump_->packet.sequence + 1) == packet.sequence;
    if (!goes_on) {
      jump_ = Waiting{std::move(packet), now};
      return false;
    }
    begin_at(jump_->packet.sequence);
    begin_until_ = now;
    restarted_ = true;
    ++counts_.received;
    since_[std::size_t(first_) % kHistory] = jump_->since;
    waiting_bytes_ += jump_->packet.payload.size();
    waiting_.emplace(first_, *std::exchange(jump_, std::nullopt));
    sequence = first_ + 1;
  }
  jump_.reset();
  if (sequence < next_ && beginning(now)) next_ = first_ = sequence;
  if (sequence < next_) {
    count_old(sequence);
    return false;
  }
  const std::size_t bytes = packet.payload.size();
  if (!waiting_.try_emplace(sequence, Waiting{std::move(packet), now}).second) {
    ++counts_.duplicates;
    return false;
  }
  waiting_bytes_ += bytes;
  ++counts_.received;
  if (sequence < highest_) ++counts_.reordered;
  if (sequence > highest_) {
    expect_up_to(sequence, now);
  } else {
    since_[std::size_t(sequence) % kHistory] = now;
  }
  return true;
}

// Nothing has been given out yet and there is time to wait.
bool ReorderBuffer::beginning(double now) const {
  return now < begin_until_ && next_ == first_ && waiting_.size() <= limits_.packets &&
         waiting_bytes_ <= limits_.bytes && !flushing_;
}

bool ReorderBuffer::must_go(double now) const {
  if (flushing_ || waiting_.size() > limits_.packets || waiting_bytes_ > limits_.bytes) return true;
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
  waiting_bytes_ -= packet.payload.size();
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
  return oldest + wait();
}

void JitterMeter::add(std::uint32_t timestamp, double now, std::uint32_t clock) {
  const double transit = (now - last_arrival_) * clock - std::int32_t(timestamp - last_timestamp_);
  if (begun_) jitter_ += (std::abs(transit) - jitter_) / 16;
  begun_ = true;
  last_arrival_ = now;
  last_timestamp_ = timestamp;
}

}  // namespace animeme::media
