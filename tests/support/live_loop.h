// Presentations for the tests of live transports, and what it takes to send one and receive it in
// the same thread.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/encode/live.h"
#include "tests/support/audio_formats.h"
#include "tools/formats/media/live/live.h"

namespace animeme::test {

struct Presentation {
  media::LiveInfo info;
  std::vector<media::LiveUnit> units;  // in the order of time
};

/// Packets that nobody could decode, as long as the face. Transports must not care.
inline void add_sound(Presentation& show, const media::AudioFormat& format, unsigned seed = 1) {
  double end = 0.1;
  for (const media::LiveUnit& unit : show.units) {
    end = std::max(end, double(unit.time + unit.duration) / show.info.timescale);
  }
  std::mt19937 random(seed);
  for (std::int64_t time = -format.priming; time < std::int64_t(end * format.sample_rate);
       time += format.frame_samples) {
    media::LiveUnit unit{
        .track = media::LiveTrack::audio, .time = time, .duration = format.frame_samples};
    unit.bytes.resize(20 + random() % 300);
    for (std::uint8_t& byte : unit.bytes) byte = std::uint8_t(random());
    unit.bytes[0] = 0x01;  // FF Fx would be taken for a header of ADTS
    if (format.codec == media::AudioCodec::opus) unit.bytes[0] = 0x78;  // one frame of 20 ms
    show.units.push_back(std::move(unit));
  }
  show.info.audio = format;
  const auto seconds = [&](const media::LiveUnit& unit) {
    const bool face = unit.track == media::LiveTrack::face;
    return double(unit.time) / (face ? show.info.timescale : unsigned(format.sample_rate));
  };
  std::stable_sort(show.units.begin(), show.units.end(),
                   [&](const auto& a, const auto& b) { return seconds(a) < seconds(b); });
}

/// The first `most` units of a stream, without sound.
inline Presentation presentation(const fba::AccessUnits& face, std::size_t most = SIZE_MAX) {
  Presentation show;
  show.info.face_config = face.config;
  show.info.timescale = face.timescale;
  if (face.config.size() > 4) show.info.visual_profile = face.config[4];
  for (const fba::AccessUnit& unit : face.units) {
    if (show.units.size() == most) break;
    show.units.push_back(
        {media::LiveTrack::face, unit.bytes, unit.intra, unit.time, unit.duration});
  }
  return show;
}

/// A face that moves, coded as for live use.
inline Presentation live_presentation(int frames, int intra_period, unsigned seed = 7) {
  fba::LiveEncoder encoder({.intra_seconds = intra_period / 25.0});
  std::mt19937 random(seed);
  fba::AccessUnits face{.config = {0, 0, 1, 0xB0, 0x61, 0, 0, 1, 0xB5, 0x89, 0x47}};
  std::array<int, 6> value{};
  for (int i = 0; i < frames; ++i) {
    fap::Frame frame;
    for (int k = 0; k < 6; ++k) {
      value[std::size_t(k)] += int(random() % 41) - 20;
      frame.set(3 + k, value[std::size_t(k)]);
    }
    auto unit = encoder.write(frame);
    EXPECT_TRUE(unit) << (unit ? "" : unit.error().describe());
    if (unit) face.units.push_back({std::move(*unit), encoder.intra(), i * 1000, 1000});
  }
  return presentation(face);
}

inline std::vector<media::LiveUnit> of_track(const std::vector<media::LiveUnit>& units,
                                             media::LiveTrack track) {
  std::vector<media::LiveUnit> found;
  for (const media::LiveUnit& unit : units) {
    if (unit.track == track) found.push_back(unit);
  }
  return found;
}

struct Received {
  std::vector<media::LiveInfo> infos;
  std::vector<media::LiveUnit> units;
  std::vector<std::pair<std::size_t, media::LiveGap>> gaps;  // in front of which unit
  bool ended = false;
  std::string error;

  std::vector<media::LiveUnit> of(media::LiveTrack track) const { return of_track(units, track); }
};

/// Transports that do not tell how long a unit lasts give the distance to the next one.
enum class Durations : std::uint8_t { compared, ignored };

inline void expect_equal(const std::vector<media::LiveUnit>& got,
                         const std::vector<media::LiveUnit>& want,
                         Durations durations = Durations::compared) {
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    media::LiveUnit unit = want[i];
    if (durations == Durations::ignored) unit.duration = got[i].duration;
    ASSERT_EQ(got[i], unit) << "unit " << i;
  }
}

/// Takes one event. False: nothing came in time, or it is over.
inline bool receive(media::LiveSource& source, Received& got, double seconds) {
  Result<media::LiveEvent> event = source.next(seconds);
  if (!event) {
    got.error = event.error().describe();
    return false;
  }
  if (auto* info = std::get_if<media::LiveInfo>(&*event)) got.infos.push_back(*info);
  if (auto* gap = std::get_if<media::LiveGap>(&*event))
    got.gaps.emplace_back(got.units.size(), *gap);
  if (auto* unit = std::get_if<media::LiveUnit>(&*event)) got.units.push_back(std::move(*unit));
  if (std::holds_alternative<media::LiveEnd>(*event)) got.ended = true;
  return !got.ended && !std::holds_alternative<media::LiveIdle>(*event);
}

/// Sends all of it, never far ahead of the receiver, and receives to the end.
inline Received loop(media::LiveSink& sink, media::LiveSource& source, const Presentation& show,
                     const std::function<bool(std::size_t)>& skip = {}) {
  constexpr std::size_t kWindow = 24;
  Received got;
  std::size_t sent = 0;
  for (std::size_t i = 0; i < show.units.size(); ++i) {
    if (skip && skip(i)) continue;
    const Result<void> ok = sink.send(show.units[i]);
    EXPECT_TRUE(ok) << (ok ? "" : ok.error().describe());
    ++sent;
    while (got.units.size() + kWindow < sent && receive(source, got, 5)) {
    }
    while (receive(source, got, 0)) {
    }
    if (!got.error.empty()) return got;
  }
  EXPECT_TRUE(sink.finish());
  while (!got.ended && receive(source, got, 5)) {
  }
  return got;
}

/// The unit as it comes back through a clock of `rate` ticks a second, but for its duration.
inline media::LiveUnit through_clock(media::LiveUnit unit, std::int64_t timescale,
                                     std::int64_t rate) {
  const std::int64_t twice = 2 * unit.time * rate;
  const std::int64_t around = twice + (twice < 0 ? -timescale : timescale);
  unit.time = around / (2 * timescale);
  return unit;
}

}  // namespace animeme::test
