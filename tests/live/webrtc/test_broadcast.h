// The presentation of tests/live/web/test_server.h, sent to any sink.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "tests/live/web/test_server.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/expected_loss.h"
#include "tools/live/webrtc/webrtc.h"

namespace animeme::test {

inline media::EncodedAudio make_sound(double seconds, media::AudioCodec codec) {
  auto sound = media::encode_audio(make_tones(seconds), {.codec = codec});
  EXPECT_TRUE(sound);
  return std::move(*sound);
}

/// Sends to a sink that is not started yet, from a thread, until it is stopped.
class Broadcast {
 public:
  explicit Broadcast(std::unique_ptr<media::LiveSink> sink,
                     media::AudioCodec codec = media::AudioCodec::opus)
      : Broadcast(std::move(sink), make_sound(8, codec)) {}
  Broadcast(std::unique_ptr<media::LiveSink> sink, media::EncodedAudio sound)
      : Broadcast(std::move(sink),
                  std::make_unique<media::ClipInput>(make_mouth(8), std::move(sound),
                                                     media::ClipOptions{.loop = true})) {}
  Broadcast(std::unique_ptr<media::LiveSink> sink, std::unique_ptr<media::LiveInput> input)
      : sink_(std::move(sink)), input_(std::move(input)) {
    started_ = sink_->start(input_->info());
    if (started_) thread_ = std::thread([this] { run(); });
  }
  ~Broadcast() { stop(); }

  const Result<void>& started() const { return started_; }
  media::LiveSink& sink() { return *sink_; }
  /// Units of the face so far, by their time.
  std::map<std::int64_t, media::LiveUnit> sent() const {
    const std::lock_guard lock(mutex_);
    return sent_;
  }
  /// Says goodbye, if that was not done before.
  void stop() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
    if (!std::exchange(finished_, true) && started_) {
      EXPECT_TRUE(sink_->finish());
    }
  }

 private:
  void run() {
    media::Pacer pacer(media::steady_clock());
    media::ExpectedLoss expected;
    while (auto due = input_->next_due()) {
      while (!over_ && !pacer.wait_until(*due)) {
      }
      if (over_) return;
      expected.follow(sink_->stats(), media::steady_clock().now(), *input_);
      auto units = input_->take(*due);
      if (!units) return;
      for (const media::LiveUnit& unit : *units) {
        if (!sink_->send(unit)) return;
        if (unit.track != media::LiveTrack::face) continue;
        const std::lock_guard lock(mutex_);
        sent_[unit.time] = unit;
      }
    }
  }

  std::unique_ptr<media::LiveSink> sink_;
  std::unique_ptr<media::LiveInput> input_;
  Result<void> started_;
  std::atomic<bool> over_ = false;
  bool finished_ = false;
  mutable std::mutex mutex_;
  std::map<std::int64_t, media::LiveUnit> sent_;
  std::thread thread_;
};

}  // namespace animeme::test
