// Faces, sounds and bad networks for the RTP tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/decode/decoder.h"
#include "codec/encode/live.h"
#include "tests/support/audio_formats.h"
#include "tests/support/files.h"
#include "tests/support/random_clip.h"
#include "tools/formats/media/live/recovery.h"
#include "tools/formats/media/rtp/rtp_receiver.h"
#include "tools/formats/media/rtp/rtp_sender.h"

namespace animeme::test {

/// A presentation as it is sent.
struct LiveTalk {
  media::LiveInfo info;
  std::vector<media::LiveUnit> units;  // in order of time
};

inline LiveTalk talk_of(const fba::AccessUnits& face) {
  LiveTalk talk;
  talk.info.face_config = face.config;
  talk.info.timescale = face.timescale;
  talk.info.visual_profile = face.config.at(4);
  for (const fba::AccessUnit& unit : face.units) {
    talk.units.push_back(
        {media::LiveTrack::face, unit.bytes, unit.intra, unit.time, unit.duration});
  }
  return talk;
}

/// A face that walks at random, with an intra plane every `period` planes.
inline LiveTalk random_talk(int planes, int period = 25, fap::Rate rate = {25, 1}) {
  Random random(7);
  fba::LiveEncoder encoder({.rate = rate, .fap_quant = 4, .intra_seconds = rate.seconds(period)});
  Bytes stream;
  fap::Frame frame;
  for (int i = 0; i < planes; ++i) {
    for (int fap = 3; fap <= 60; fap += 3) {
      frame.set(fap, std::clamp(frame.value[std::size_t(fap)] + random.range(-40, 40), -500, 500));
    }
    const auto unit = encoder.write(frame);
    EXPECT_TRUE(unit) << unit.error().describe();
    if (unit) stream.insert(stream.end(), unit->begin(), unit->end());
  }
  const Bytes end = encoder.finish();
  stream.insert(stream.end(), end.begin(), end.end());
  const auto units = fba::split_access_units(stream);
  EXPECT_TRUE(units) << units.error().describe();
  return units ? talk_of(*units) : LiveTalk();
}

/// Puts packets of noise between the planes, up to the end of the face.
inline void add_sound(LiveTalk& talk, const media::AudioFormat& format) {
  talk.info.audio = format;
  Random random(11);
  const double end =
      double(talk.units.back().time + talk.units.back().duration) / talk.info.timescale;
  const int frame = format.frame_samples;
  for (std::int64_t time = -format.priming; double(time) / format.sample_rate < end;
       time += frame) {
    Bytes bytes(std::size_t(random.range(20, 200)));
    for (std::uint8_t& byte : bytes) byte = std::uint8_t(random.next());
    if (format.codec == media::AudioCodec::opus) bytes[0] = 0x78;  // one CELT frame of 20 ms
    talk.units.push_back({media::LiveTrack::audio, bytes, false, time, frame});
  }
  const auto seconds = [&](const media::LiveUnit& unit) {
    const bool face = unit.track == media::LiveTrack::face;
    return double(unit.time) / (face ? talk.info.timescale : std::uint32_t(format.sample_rate));
  };
  std::stable_sort(talk.units.begin(), talk.units.end(),
                   [&](const auto& a, const auto& b) { return seconds(a) < seconds(b); });
}

inline double seconds_of(const LiveTalk& talk, const media::LiveUnit& unit) {
  const bool face = unit.track == media::LiveTrack::face;
  return double(unit.time) /
         (face ? double(talk.info.timescale) : double(talk.info.audio->sample_rate));
}

inline std::vector<media::LiveUnit> only(const std::vector<media::LiveUnit>& units,
                                         media::LiveTrack track) {
  std::vector<media::LiveUnit> out;
  for (const media::LiveUnit& unit : units) {
    if (unit.track == track) out.push_back(unit);
  }
  return out;
}

/// What a network does to datagrams, by chance.
struct Trouble {
  int loss = 0;       ///< percent
  int duplicate = 0;  ///< percent
  int reorder = 0;    ///< percent that come 30 ms late
  int burst = 1;      ///< so many packets in a row are lost at a time
  double jitter = 0;  ///< seconds that a packet is delayed at most, each on its own
};

/// A network that does so, the same way for the same seed.
class BadNetwork {
 public:
  BadNetwork(std::uint64_t seed, const Trouble& trouble) : random_(seed), trouble_(trouble) {}

  void put(const std::vector<media::RtpDatagram>& datagrams, double now) {
    for (const media::RtpDatagram& each : datagrams) {
      if (random_.range(1, 100 * trouble_.burst) <= trouble_.loss) losing_ = trouble_.burst;
      const bool lost = losing_ > 0;
      losing_ -= lost ? 1 : 0;
      const bool twice = random_.chance(trouble_.duplicate);
      double delay = random_.chance(trouble_.reorder) ? 0.03 : 0;
      if (trouble_.jitter > 0) delay += trouble_.jitter * random_.range(0, 1000) / 1000.0;
      if (lost) continue;
      for (int i = 0; i < (twice ? 2 : 1); ++i) under_way_.push_back({now + delay, each});
    }
  }
  /// What has arrived by now, with its times, in order.
  std::vector<std::pair<double, media::RtpDatagram>> take(double now) {
    std::stable_sort(under_way_.begin(), under_way_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    const auto end = std::find_if(under_way_.begin(), under_way_.end(),
                                  [now](const auto& each) { return each.first > now; });
    std::vector<std::pair<double, media::RtpDatagram>> out(under_way_.begin(), end);
    under_way_.erase(under_way_.begin(), end);
    return out;
  }

 private:
  Random random_;
  Trouble trouble_;
  int losing_ = 0;  // packets of a burst that are still to be lost
  std::vector<std::pair<double, media::RtpDatagram>> under_way_;
};

/// Hands datagrams over and collects what comes out.
inline void deliver(BadNetwork& network, media::RtpReceiver& receiver, double now,
                    std::vector<media::LiveEvent>& events) {
  for (const auto& [at, datagram] : network.take(now)) {
    if (datagram.control) {
      receiver.rtcp(datagram.track, datagram.bytes, {}, at);
    } else {
      receiver.rtp(datagram.track, datagram.bytes, {}, at);
    }
    while (auto event = receiver.next(at)) events.push_back(std::move(*event));
  }
  while (auto event = receiver.next(now)) events.push_back(std::move(*event));
}

/// Sends a talk in its own time (which costs none here) and returns the events.
inline std::vector<media::LiveEvent> transfer(const LiveTalk& talk, BadNetwork& network,
                                              media::RtpReceiver& receiver,
                                              media::RtpSender& sender) {
  std::vector<media::LiveEvent> events;
  const double begin = talk.units.empty() ? 0 : 1 - seconds_of(talk, talk.units.front());
  double now = 0;
  for (const media::LiveUnit& unit : talk.units) {
    media::RtpSender::Datagrams out;
    now = begin + seconds_of(talk, unit);
    const auto sent = sender.send(unit, now, out);
    EXPECT_TRUE(sent) << sent.error().describe();
    network.put(out, now);
    deliver(network, receiver, now, events);
  }
  media::RtpSender::Datagrams out;
  sender.finish(now, out);
  network.put(out, now);
  for (int step = 0; step < 40; ++step) deliver(network, receiver, now += 0.05, events);
  return events;
}

inline std::vector<media::LiveEvent> transfer(const LiveTalk& talk,
                                              const media::RtpOptions& options = {},
                                              const Trouble& trouble = {}, std::uint64_t seed = 1) {
  media::RtpSender sender(talk.info, options, "127.0.0.1", 5004, seed, media::ntp_now());
  const auto session = media::read_sdp(media::write_sdp(sender.session()));
  EXPECT_TRUE(session) << session.error().describe();
  media::RtpReceiver receiver(*session, {}, 1);
  BadNetwork network(seed, trouble);
  return transfer(talk, network, receiver, sender);
}

inline std::vector<media::LiveUnit> units_in(const std::vector<media::LiveEvent>& events) {
  std::vector<media::LiveUnit> out;
  for (const media::LiveEvent& event : events) {
    if (const auto* unit = std::get_if<media::LiveUnit>(&event)) out.push_back(*unit);
  }
  return out;
}

inline std::vector<media::LiveUnit> recovered(const std::vector<media::LiveEvent>& events,
                                              media::FaceRecovery& recovery) {
  std::vector<media::LiveUnit> out;
  for (const media::LiveEvent& event : events) {
    if (auto unit = recovery.accept(event)) out.push_back(std::move(*unit));
  }
  return out;
}

/// Decodes planes one after the other, as a player does. A plane that cannot be decoded fails the
/// test.
inline std::vector<fba::Plane> decode_units(const Bytes& config,
                                            const std::vector<media::LiveUnit>& units) {
  Bytes stream = config;
  const Bytes object = {0, 0, 1, 0xBA, 0x7F};  // only the first unit of a talk has it
  if (!units.empty() && units.front().bytes.size() > 4 && units.front().bytes[3] != 0xBA) {
    stream.insert(stream.end(), object.begin(), object.end());
  }
  for (const media::LiveUnit& unit : units) {
    stream.insert(stream.end(), unit.bytes.begin(), unit.bytes.end());
  }
  stream.insert(stream.end(), {0, 0, 1, 0xB1});
  const auto decoded = fba::decode(stream);
  EXPECT_TRUE(decoded) << decoded.error().describe();
  return decoded ? decoded->planes : std::vector<fba::Plane>();
}

/// Values as decoded, without running numbers.
inline bool same_values(const fba::Plane& a, const fba::Plane& b) {
  fap::Frame left = a.face;
  fap::Frame right = b.face;
  left.number = right.number = 0;
  const bool body = bool(a.body) == bool(b.body) &&
                    (!a.body || (a.body->mask == b.body->mask && a.body->value == b.body->value));
  return left == right && body;
}

/// Do these units, some of `all`, decode to what they are in the whole?
inline void expect_right(const LiveTalk& all, const std::vector<media::LiveUnit>& units) {
  const auto face = only(all.units, media::LiveTrack::face);
  const std::vector<fba::Plane> whole = decode_units(all.info.face_config, face);
  const std::vector<fba::Plane> part = decode_units(all.info.face_config, units);
  ASSERT_EQ(whole.size(), face.size());
  ASSERT_EQ(part.size(), units.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < units.size(); ++i) {
    while (at < face.size() && face[at].time != units[i].time) ++at;
    ASSERT_LT(at, face.size()) << "a plane at time " << units[i].time << " was never sent";
    ASSERT_EQ(units[i].bytes, face[at].bytes);
    ASSERT_TRUE(same_values(whole[at], part[i])) << "plane " << at;
  }
}

}  // namespace animeme::test
