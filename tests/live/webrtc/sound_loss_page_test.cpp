// How much sound a browser lacks in a network that loses packets, with and without what is sent
// against that.
#include <fstream>

#include "tests/live/webrtc/browser.h"
#include "tests/support/folders.h"
#include "tools/formats/media/audio.h"

namespace animeme::test {
namespace sound_loss_page_test {

class SoundLossPage : public WebRtcBrowser {
 protected:
  /// A voice of 8 s.
  static media::EncodedAudio voice(int expected_loss) {
    auto pcm = media::read_audio(std::string(kSourceFolder) + "/tools/release/samples/voice.wav");
    EXPECT_TRUE(pcm);
    const std::vector<float> once = pcm->samples;
    while (pcm->duration() < 8) {
      pcm->samples.insert(pcm->samples.end(), once.begin(), once.end());
    }
    pcm->samples.resize(std::size_t(pcm->sample_rate) * 8);
    auto sound = media::encode_audio(
        *pcm, {media::AudioCodec::opus, 48000, 5, media::AacSearch::fast, expected_loss});
    EXPECT_TRUE(sound);
    return std::move(*sound);
  }
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
    run(webrtc::make_webrtc_sink("webrtc://127.0.0.1:0" + query), voice(expected_loss));
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
        "%4.0f %% lost %-18s fec %2d: %5.2f %% concealed; %.0f packets lost of %.0f, "
        "%.0f of FEC or RED, %.1f kbit/s\n",
        100 * loss, query.c_str(), expected_loss, percent, grown("packetsLost"),
        grown("packetsReceived") + grown("packetsLost"), grown("fecPacketsReceived"),
        grown("bytesReceived") * 8 / 1000 / seconds);
    lost_ = grown("packetsLost");
    server_->stop();
    server_.reset();
    relay_.reset();
    return percent;
  }

  double lost_ = 0;
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

// For the table in README.md: ANIMEME_LOSS_TABLE=1.
TEST_F(SoundLossPage, Table) {
  if (std::getenv("ANIMEME_LOSS_TABLE") == nullptr) GTEST_SKIP() << "takes four minutes";
  for (const double loss : {0.0, 0.03, 0.1}) {
    concealed("?audio-repeat=0", 0, loss, 2, 20);
    if (loss > 0) concealed("?audio-repeat=0", int(100 * loss), loss, 2, 20);
    concealed("?audio-repeat=1", 0, loss, 2, 20);
    concealed("?audio-repeat=2", 0, loss, 2, 20);
    concealed("", 0, loss, 12, 20);
  }
}

}  // namespace sound_loss_page_test
}  // namespace animeme::test
