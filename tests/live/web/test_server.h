// A server that sends a face and its sound again and again, and a browser that looks at it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <thread>

#include "codec/encode/live.h"
#include "tests/live/web/chromium.h"
#include "tools/formats/media/encoded_audio.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/formats/media/live/presentation.h"
#include "tools/live/web/web.h"

namespace animeme::test {

inline constexpr double kPeriod = 0.8, kSound = 0.2;  // seconds: a tone that long, that often

/// While the tone sounds the mouth is open.
inline media::Pcm make_tones(double seconds) {
  media::Pcm pcm{48000, std::vector<float>(std::size_t(seconds * 48000))};
  for (std::size_t i = 0; i < pcm.samples.size(); ++i) {
    const double t = double(i) / 48000;
    if (std::fmod(t, kPeriod) < kSound) {
      pcm.samples[i] = float(0.4 * std::sin(2 * std::numbers::pi * 500 * t));
    }
  }
  return pcm;
}

inline fba::AccessUnits make_mouth(double seconds) {
  fba::LiveEncoder encoder({.intra_seconds = 20 / 25.0});
  fba::AccessUnits face{.config = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47}};
  for (int i = 0; i < int(seconds * 25); ++i) {
    const double t = i / 25.0;
    const bool open = std::fmod(t + 1e-9, kPeriod) < kSound;
    fap::Frame frame;
    frame.set(3, open ? 700 : 0);
    frame.set(4, open ? -150 : 0);
    frame.set(5, open ? -700 : 0);
    frame.set(6, int(60 * std::sin(t * 3)));
    frame.set(7, int(60 * std::sin(t * 3)));
    frame.set(12, int(200 + 150 * std::sin(t * 2)));
    frame.set(13, int(200 + 150 * std::sin(t * 2)));
    frame.set(31, int(120 * std::sin(t)));
    frame.set(32, int(120 * std::sin(t)));
    frame.set(50, int(4000 * std::sin(t)));
    auto unit = encoder.write(frame);
    EXPECT_TRUE(unit);
    if (unit) face.units.push_back({std::move(*unit), encoder.intra(), i * 1000, 1000});
  }
  return face;
}

/// A server that sends a presentation again and again, at its pace.
class TestServer {
 public:
  /// Without `codec`: without a sound. `url`: where it listens.
  explicit TestServer(std::optional<media::AudioCodec> codec, const web::WebOptions& options = {},
                      const std::string& url = "http://127.0.0.1:0/") {
    media::EncodedAudio sound;
    if (codec) {
      auto coded = media::encode_audio(make_tones(8), {.codec = *codec});
      EXPECT_TRUE(coded);
      sound = std::move(*coded);
    }
    input_.emplace(make_mouth(8), std::move(sound), media::ClipOptions{.loop = true});
    auto sink = web::make_web_sink(url, options);
    EXPECT_TRUE(sink);
    sink_ = std::move(*sink);
    EXPECT_TRUE(sink_->start(input_->info()));
    thread_ = std::thread([this] { run(); });
  }
  ~TestServer() { halt(); }  // and the connections break
  void finish() {
    halt();
    EXPECT_TRUE(sink_->finish());
  }
  std::string address() const { return sink_->address(); }
  int viewers() const { return int(sink_->stats().receivers); }
  /// What is due is lost.
  void pause(bool paused) { paused_ = paused; }
  /// What is due is sent later, all at once.
  void hold(bool held) { held_ = held; }

 private:
  void halt() {
    over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void run() {
    media::Pacer pacer(media::steady_clock());
    while (auto due = input_->next_due()) {
      while (!over_ && (!pacer.wait_until(*due) || held_)) {
        if (held_) usleep(10000);
      }
      if (over_) return;
      auto units = input_->take(*due);
      if (!units) return;
      for (const media::LiveUnit& unit : *units) {
        if (paused_) continue;
        EXPECT_TRUE(sink_->send(unit));
      }
    }
  }

  std::optional<media::ClipInput> input_;
  std::unique_ptr<web::WebSink> sink_;
  std::atomic<bool> over_ = false, paused_ = false, held_ = false;
  std::thread thread_;
};

/// Waits until an expression is true in the page.
inline bool wait_for(Chromium& browser, const std::string& expression, int seconds = 60,
                     bool click = true) {
  return browser.evaluate("new Promise(done => { const end = Date.now() + 1000 * " +
                              std::to_string(seconds) + "; (function look() { if (" + expression +
                              ") done(true); else if (Date.now() > end) done(false); "
                              "else setTimeout(look, 50); })(); })",
                          click) == true;
}

/// Why a browser that draws in software cannot play in real time here, which takes a processor for
/// itself; empty: it can.
inline std::string too_busy() {
  double load = 0;
  const double cores = std::max(1u, std::thread::hardware_concurrency());
  if (getloadavg(&load, 1) != 1 || load <= 5 * cores) return {};
  return "this machine is too busy to play in real time: load " + std::to_string(load);
}

/// Script that tells when tones and mouths began, as they come out of the browser: {tones, mouths},
/// seconds. `connect` ends what leads from `context` to `tap`.
inline std::string tones_and_mouths(const std::string& connect, int milliseconds) {
  return R"(new Promise(async done => {
    const context = new AudioContext();
    const tap = context.createAnalyser();
    tap.fftSize = 512;
    )" + connect +
         R"(;
    await context.resume();
    const wave = new Float32Array(512), tones = [], mouths = [];
    let loud = false, open = false, begin = performance.now();
    animeme.addEventListener('frame', ({detail: {values}}) => {
      if ((values[3] > 300) !== open) {
        open = !open;
        if (open) mouths.push(performance.now() / 1000);
      }
    });
    const timer = setInterval(() => {
      tap.getFloatTimeDomainData(wave);
      const level = Math.sqrt(wave.reduce((sum, x) => sum + x * x, 0) / wave.length);
      if ((level > 0.1) !== loud) {
        loud = !loud;
        if (loud) tones.push(performance.now() / 1000);
      }
      if (performance.now() - begin > )" +
         std::to_string(milliseconds) + R"() {
        clearInterval(timer);
        done({tones, mouths, latency: context.outputLatency, base: context.baseLatency});
      }
    }, 4);
  }))";
}

}  // namespace animeme::test
