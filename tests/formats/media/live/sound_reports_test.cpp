// What receivers of RTP report of lost sound changes how the program codes it.
#include <gtest/gtest.h>

#include "tests/formats/media/live/stream_support.h"
#include "tools/formats/media/audio.h"
#include "tools/formats/media/live/pacer.h"
#include "tools/formats/media/rtp/rtcp.h"
#include "tools/formats/media/rtp/rtp_packet.h"
#include "tools/formats/media/rtp/udp_socket.h"

namespace animeme {
namespace sound_reports_test {

using test::Running;
using test::Streams;

// RFC 6716, sections 3.1 and 4.2.4: a frame of 20 ms for one channel that has the one before it
// again.
bool repeats_the_last(std::span<const std::uint8_t> packet) {
  const unsigned toc = packet.empty() ? 0xFF : packet[0];
  const bool has_silk = (toc >> 3) < 16, of_20_ms = (toc >> 3 & 1) != 0, one = (toc & 3) == 0;
  return one && has_silk && of_20_ms && packet.size() > 1 && (packet[1] >> 6 & 1) != 0;
}

class SoundReports : public Streams {
 protected:
  struct Heard {
    int before = 0, without = 0;  // packets with and without a copy, until the report
    int after = 0;                // packets with one behind it
  };
  // A receiver that says after `quiet` seconds that it loses a sixth of the sound.
  Heard receive(std::vector<std::string> arguments, double quiet) {
    const int port = test::free_ports();
    url = "rtp://127.0.0.1:" + std::to_string(port);
    auto sound = media::UdpSocket::bind("127.0.0.1", port + 2);
    auto control = media::UdpSocket::bind("127.0.0.1", port + 3);
    EXPECT_TRUE(sound && control);
    Heard heard;
    if (!sound || !control) return heard;
    Running send(sender(std::move(arguments)), dir / "s.out", dir / "s.err");
    const media::UdpSocket* sockets[] = {&*sound, &*control};
    std::optional<media::UdpAddress> reports_to;
    std::optional<double> begun;
    double reported = 0;
    std::uint32_t ssrc = 0;
    media::Clock& clock = media::steady_clock();
    for (;;) {
      const auto some = media::wait_for_any(sockets, begun ? 3 : 30);
      if (!some || !*some) break;  // it is over
      media::UdpAddress from;
      for (auto got = control->receive(&from); got && *got; got = control->receive(&from)) {
        reports_to = from;
      }
      for (auto got = sound->receive(); got && *got; got = sound->receive()) {
        const auto packet = media::read_rtp(**got);
        if (!packet) continue;
        if (!begun) begun = clock.now();
        ssrc = packet->ssrc;
        const bool again = repeats_the_last(packet->payload);
        if (reported > 0) {
          heard.after += again;
        } else {
          ++(again ? heard.before : heard.without);
        }
      }
      if (!begun || !reports_to || clock.now() - *begun < quiet) continue;
      if (clock.now() - reported < 1) continue;
      reported = clock.now();
      media::RtcpMessage report;
      report.reports.push_back({7, std::nullopt, {{.ssrc = ssrc, .fraction = 256 / 6}}});
      EXPECT_TRUE(control->send(media::write_rtcp(report), *reports_to));
    }
    EXPECT_EQ(send.wait(), 0) << test::slurp(dir / "s.err");
    EXPECT_GT(reported, 0) << "the sender has sent no reports";
    return heard;
  }
};

TEST_F(SoundReports, ChangeTheSoundOfLines) {
  test::spill(dir / "lines.txt",
              "How many boats are there, and who paid for all of them?\n"
              "There are seven boats, and nobody paid for any of them.\n");
  const std::vector<std::string> lines = {"--say", dir / "lines.txt"};
  const Heard heard = receive(lines, 2.5);
  EXPECT_EQ(heard.before, 0);
  EXPECT_GT(heard.without, 50);
  EXPECT_GT(heard.after, 40);

  std::vector<std::string> fixed = lines;
  fixed.insert(fixed.end(), {"--audio-fec", "0"});
  const Heard none = receive(fixed, 2.5);
  EXPECT_EQ(none.before + none.after, 0);
}

TEST_F(SoundReports, ChangeTheSoundOfAVoice) {
  auto voice =
      media::read_audio(std::string(test::kSourceFolder) + "/tools/release/samples/voice.wav");
  ASSERT_TRUE(voice);
  const std::vector<float> once = voice->samples;
  while (voice->duration() < 6) {
    voice->samples.insert(voice->samples.end(), once.begin(), once.end());
  }
  ASSERT_TRUE(media::write_wav(dir / "voice.wav", *voice));
  const Heard heard = receive({"--say-audio", dir / "voice.wav"}, 2.5);
  EXPECT_EQ(heard.before, 0);
  EXPECT_GT(heard.without, 50);
  EXPECT_GT(heard.after, 40);
}

}  // namespace sound_reports_test
}  // namespace animeme
