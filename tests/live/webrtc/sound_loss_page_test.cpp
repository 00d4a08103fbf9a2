// How much sound a browser lacks in a network that loses packets, with and without what is sent
// against that.
#include <atomic>
#include <deque>
#include <stdexcept>

#include "tests/live/webrtc/browser.h"
#include "tests/support/folders.h"
#include "tools/formats/media/audio.h"

namespace animeme::test {
namespace sound_loss_page_test {

/// A voice that is encoded while it is sent, without end, with a moving mouth.
class EndlessVoice : public media::LiveInput {
 public:
  explicit EndlessVoice(int expected_loss)
      : follows_(expected_loss < 0),
        face_(make_mouth(8), {}, media::ClipOptions{.loop = true}),
        info_(face_.info()) {
    auto pcm = media::read_audio(std::string(kSourceFolder) + "/tools/release/samples/voice.wav");
    EXPECT_TRUE(pcm);
    auto encoder = media::AudioEncoder::open(
        pcm->sample_rate,
        {media::AudioCodec::opus, 48000, 5, media::AacSearch::fast, expected_loss});
    EXPECT_TRUE(encoder);
    voice_ = std::move(*pcm);
    encoder_.emplace(std::move(*encoder));
    info_.audio = encoder_->format();
    more();
  }

  const media::LiveInfo& info() const override { return info_; }
  double audio_ahead() const override { return 0.05; }
  std::optional<double> next_due() override { return std::min(*face_.next_due(), sound_due()); }
  Result<std::vector<media::LiveUnit>> take(double now) override {
    auto units = face_.take(now);
    while (units && sound_due() <= now) {
      media::AudioPacket& packet = packets_.front();
      units->push_back(
          {media::LiveTrack::audio, std::move(packet.bytes), false, packet.time, packet.duration});
      packets_.pop_front();
      more();
    }
    return units;
  }
  void expect_loss(int percent) override {
    EXPECT_TRUE(encoder_->expect_loss(percent));
    if (follows_) expected_ = percent;
  }
  int expected() const { return expected_; }

 private:
  double sound_due() const { return double(packets_.front().time) / 48000 - audio_ahead(); }
  void more() {
    while (packets_.empty()) {
      std::vector<float> block(std::size_t(voice_.sample_rate / 100));
      for (float& sample : block) sample = voice_.samples[at_++ % voice_.samples.size()];
      auto made = encoder_->push(block);
      if (!made) throw std::runtime_error(made.error().message);
      packets_.insert(packets_.end(), made->begin(), made->end());
    }
  }

  const bool follows_;
  media::ClipInput face_;
  media::LiveInfo info_;
  media::Pcm voice_;
  std::size_t at_ = 0;
  std::optional<media::AudioEncoder> encoder_;
  std::deque<media::AudioPacket> packets_;
  std::atomic<int> expected_ = 0;
};

constexpr int kReports = media::AudioSettings::kLossByReports;

class SoundLossPage : public WebRtcBrowser {
 protected:
  Json inbound() {
    return browser_->evaluate(
        "(async () => [...(await rtc.peer.getStats()).values()].find(one => one.type === "
        "'inbound-rtp'))()");
  }
  /// Percent of the sound that was made up in `seconds`, which begin after `wait` seconds.
  double concealed(const std::string& query, int expected_loss, double loss, int wait,
                   int seconds) {
    browser_.reset();
    browser_.emplace();
    auto voice = std::make_unique<EndlessVoice>(expected_loss);
    voice_ = voice.get();
    run(webrtc::make_webrtc_sink("webrtc://127.0.0.1:0" + query), std::move(voice));
    start(loss, 0.02);
    expect_webrtc();
    std::this_thread::sleep_for(std::chrono::seconds(wait));
    const Json before = inbound();
    std::this_thread::sleep_for(std::chrono::seconds(seconds));
    const Json after = inbound();
    const auto grown = [&](const char* name) {
      return after.value(name, 0.0) - before.value(name, 0.0);
    };
    const double percent = 100 * grown("concealedSamples") / grown("totalSamplesReceived");
    std::printf(
        "%4.0f %% lost %-18s fec %2d (%2d): %5.2f %% concealed; %.0f packets lost of %.0f, "
        "%.0f of FEC or RED, %.1f kbit/s\n",
        100 * loss, query.c_str(), expected_loss, voice_->expected(), percent, grown("packetsLost"),
        grown("packetsReceived") + grown("packetsLost"), grown("fecPacketsReceived"),
        grown("bytesReceived") * 8 / 1000 / seconds);
    lost_ = grown("packetsLost");
    expected_ = voice_->expected();
    server_->stop();
    server_.reset();
    relay_.reset();
    return percent;
  }

  EndlessVoice* voice_ = nullptr;
  double lost_ = 0;
  int expected_ = 0;  // percent, at the end
};

TEST_F(SoundLossPage, PacketsThatGoAgainAreHeard) {
  const double alone = concealed("?audio-repeat=0", 0, 0.1, 1, 10);
  EXPECT_GT(lost_, 10);
  EXPECT_GT(alone, 4);
  const double again = concealed("?audio-repeat=2", 0, 0.1, 1, 10);
  EXPECT_GT(lost_, 10);
  EXPECT_LT(again, alone / 2);
}

TEST_F(SoundLossPage, WhatABrowserReportsDecides) {
  // Reports come every few seconds.
  const double adapted = concealed("", 0, 0.1, 12, 10);
  EXPECT_GT(lost_, 10);
  EXPECT_LT(adapted, 5);
}

// In-band FEC where packets do not go again: the encoder expects what the browser reports.
TEST_F(SoundLossPage, TheEncoderExpectsWhatABrowserReports) {
  const double without = concealed("?audio-repeat=0", 0, 0.1, 1, 10);
  EXPECT_GT(lost_, 10);
  const double followed = concealed("?audio-repeat=0", kReports, 0.1, 12, 10);
  EXPECT_GT(lost_, 10);
  EXPECT_GE(expected_, 5);
  EXPECT_LE(expected_, media::ExpectedLoss::kMost);
  EXPECT_LT(followed, without * 0.8);
  // Packets that go again make up for it better, in as many bits.
  (void)concealed("", kReports, 0.1, 6, 4);
  EXPECT_EQ(expected_, 0);
}

// For the table in README.md: ANIMEME_LOSS_TABLE=1.
TEST_F(SoundLossPage, Table) {
  if (std::getenv("ANIMEME_LOSS_TABLE") == nullptr) GTEST_SKIP() << "takes four minutes";
  for (const double loss : {0.0, 0.03, 0.1}) {
    concealed("?audio-repeat=0", 0, loss, 2, 20);
    if (loss > 0) concealed("?audio-repeat=0", int(100 * loss), loss, 2, 20);
    concealed("?audio-repeat=0", kReports, loss, 12, 20);
    concealed("?audio-repeat=1", 0, loss, 2, 20);
    concealed("?audio-repeat=2", 0, loss, 2, 20);
    concealed("", 0, loss, 12, 20);
  }
}

}  // namespace sound_loss_page_test
}  // namespace animeme::test
