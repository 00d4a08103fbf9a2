// A face through a network that loses packets, to a receiver that asks for intra planes.
#pragma once

#include <utility>
#include <vector>

#include "codec/encode/intra_on_request.h"
#include "tests/formats/media/live/rtp_support.h"

namespace animeme::test {

struct AskedRun {
  media::RecoveryStats recovery;
  double bytes = 0;  ///< of the face, with headers of RTP, UDP and IP
};

/// The unit that is sent.
inline media::LiveUnit passed(fba::IntraOnRequest& filter, media::LiveUnit unit, bool wanted) {
  if (auto recoded = filter.pass(unit.bytes, wanted)) {
    unit.bytes = std::move(recoded->bytes);
    unit.intra = recoded->intra;
  }
  return unit;
}

/// Each packet is sent once. What the receiver sends takes 20 ms back.
inline AskedRun run_asking(const LiveTalk& talk, bool requests, const Trouble& trouble,
                           std::uint64_t seed) {
  constexpr double kBack = 0.02;
  constexpr std::size_t kUdpAndIp = 28;
  media::RtpSender sender(talk.info, {.repeat = 1}, "127.0.0.1", 5004, 1, 0);
  media::RtpReceiver receiver(*media::read_sdp(media::write_sdp(sender.session())),
                              {.reorder_seconds = 0.02, .send_reports = requests}, 1);
  BadNetwork network(seed, trouble);
  fba::IntraOnRequest filter;
  media::FaceRecovery recovery;
  std::vector<std::pair<double, Bytes>> back;
  AskedRun result;
  for (const media::LiveUnit& unit : talk.units) {
    const double now = 1 + seconds_of(talk, unit);
    std::erase_if(back, [&](const auto& each) {
      if (each.first > now) return false;
      sender.rtcp(each.second, now);
      return true;
    });
    media::RtpSender::Datagrams out;
    EXPECT_TRUE(sender.send(passed(filter, unit, sender.intra_wanted(now)), now, out));
    for (const media::RtpDatagram& each : out) {
      if (!each.control) result.bytes += double(each.bytes.size() + kUdpAndIp);
    }
    network.put(out, now);
    std::vector<media::LiveEvent> events;
    deliver(network, receiver, now, events);
    for (media::LiveEvent& event : events) recovery.accept(std::move(event));
    for (media::RtpDatagram& report : receiver.reports(now)) {
      back.emplace_back(now + kBack, std::move(report.bytes));
    }
  }
  result.recovery = recovery.stats();
  return result;
}

}  // namespace animeme::test
