#include "tools/formats/media/live/loopback.h"

#include <random>

namespace animeme::media {

namespace {

// What lies between the two ends.
struct Wire {
  std::deque<LiveEvent> events;
  ReceiveStats received;
  std::int64_t lost[2] = {0, 0};  // since the last unit of the track
};

class LoopbackSink : public LiveSink {
 public:
  LoopbackSink(std::shared_ptr<Wire> wire, const LoopbackOptions& options)
      : wire_(std::move(wire)), options_(options), random_(options.seed) {}

  Result<void> start(const LiveInfo& info) override {
    wire_->events.emplace_back(info);
    return {};
  }
  Result<void> send(const LiveUnit& unit) override {
    const auto track = std::size_t(unit.track);
    ++(unit.track == LiveTrack::face ? stats_.face_units : stats_.audio_units);
    ++stats_.packets;
    stats_.bytes += std::int64_t(unit.bytes.size());
    if (double(random_()) < options_.loss * 4294967296.0) {
      ++wire_->lost[track];
      ++wire_->received.lost;
      return {};
    }
    if (wire_->lost[track] > 0) wire_->events.emplace_back(LiveGap{unit.track, wire_->lost[track]});
    wire_->lost[track] = 0;
    wire_->events.emplace_back(unit);
    return {};
  }
  Result<void> poll() override { return {}; }
  Result<void> finish() override {
    wire_->events.emplace_back(LiveEnd{});
    return {};
  }
  SendStats stats() const override { return stats_; }

 private:
  std::shared_ptr<Wire> wire_;
  LoopbackOptions options_;
  std::mt19937 random_;
  SendStats stats_;
};

class LoopbackSource : public LiveSource {
 public:
  explicit LoopbackSource(std::shared_ptr<Wire> wire) : wire_(std::move(wire)) {}

  Result<LiveEvent> next(double) override {
    if (wire_->events.empty()) return LiveEvent(LiveIdle{});
    if (const auto* unit = std::get_if<LiveUnit>(&wire_->events.front())) {
      ++wire_->received.packets;
      wire_->received.bytes += std::int64_t(unit->bytes.size());
    }
    Result<LiveEvent> event{LiveEvent(LiveIdle{})};
    std::swap(*event, wire_->events.front());  // not moved: g++ 12 warns in vain
    wire_->events.pop_front();
    return event;
  }
  ReceiveStats stats() const override { return wire_->received; }

 private:
  std::shared_ptr<Wire> wire_;
};

}  // namespace

Loopback make_loopback(const LoopbackOptions& options) {
  auto wire = std::make_shared<Wire>();
  return {std::make_unique<LoopbackSink>(wire, options), std::make_unique<LoopbackSource>(wire)};
}

}  // namespace animeme::media
