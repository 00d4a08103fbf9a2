// A presentation that is sent again and again, at its pace: while a tone sounds the mouth is open.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <thread>
#include <utility>

#include "codec/encode/live.h"
#include "tests/web/chromium.h"
#include "tools/media/encoded_audio.h"
#include "tools/media/live/pacer.h"
#include "tools/media/live/presentation.h"
#include "tools/webrtc/webrtc.h"

namespace animeme::test {

constexpr double kTonePeriod = 0.8, kToneLength = 0.2;  // seconds

inline media::EncodedAudio tones(double seconds, media::AudioCodec codec) {
  media::Pcm pcm{48000, std::vector<float>(std::size_t(seconds * 48000))};
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    const double t = double(i) / 48000;
    if (std::fmod(t, kTonePeriod) >= kToneLength) continue;
    pcm.samples[i] = float(0.4 * std::sin(2 * std::numbers::pi * 500 * t));
  }
  auto sound = media::encode_audio(pcm, {.codec = codec});
  EXPECT_TRUE(sound);
  return std::move(*sound);
}

inline fba::AccessUnits mouths(double seconds) {
  fba::LiveEncoder encoder({.intra_seconds = 20 / 25.0});
  fba::AccessUnits face{.config = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47}};
  for (int i = 0; i < int(seconds * 25); ++i) {
    const double t = i / 25.0;
    const bool open = std::fmod(t + 1e-9, kTonePeriod) < kToneLength;
    fap::Frame frame;
    frame.set(3, open ? 700 : 0);
    frame.set(5, open ? -700 : 0);
    frame.set(12, int(200 + 150 * std::sin(t * 2)));
    frame.set(50, int(4000 * std::sin(t)));
    auto unit = encoder.write(frame);
    EXPECT_TRUE(unit);
    if (unit) face.units.push_back({std::move(*unit), encoder.intra(), i * 1000, 1000});
  }
  return face;
}

/// Sends to a sink that is not started yet, from a thread, until it is stopped.
class Station {
 public:
  explicit Station(std::unique_ptr<media::LiveSink> sink,
                   media::AudioCodec codec = media::AudioCodec::opus)
      : sink_(std::move(sink)),
        input_(mouths(8), tones(8, codec), media::ClipOptions{.loop = true}) {
    started_ = sink_->start(input_.info());
    if (started_) thread_ = std::thread([this] { run(); });
  }
  ~Station() { stop(); }

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
    while (auto due = input_.next_due()) {
      while (!over_ && !pacer.wait_until(*due)) {
      }
      if (over_) return;
      auto units = input_.take(*due);
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
  media::ClipInput input_;
  Result<void> started_;
  std::atomic<bool> over_ = false;
  bool finished_ = false;
  mutable std::mutex mutex_;
  std::map<std::int64_t, media::LiveUnit> sent_;
  std::thread thread_;
};

/// Waits until an expression is true in the page.
inline bool wait_for(Chromium& browser, const std::string& expression, int seconds = 30) {
  return browser.evaluate("new Promise(done => { const end = Date.now() + " +
                          std::to_string(seconds * 1000) + "; (function look() { if (" +
                          expression +
                          ") done(true); else if (Date.now() > end) done(false); else "
                          "setTimeout(look, 10); })(); })") == true;
}

}  // namespace animeme::test
