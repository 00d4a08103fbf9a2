// A face that moves, sent to an engine that is a program of its own: reader.py.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "codec/decode/access_unit.h"
#include "codec/encode/live.h"
#include "fap/arkit.h"
#include "tests/support/folders.h"
#include "tests/support/program.h"
#include "tools/live/engines/engines.h"

namespace animeme::test {

using Json = nlohmann::json;

/// Talk, blinks, brows, gaze and a head that turns, at any time.
inline fap::ArkitFrame face_at(double seconds) {
  fap::ArkitFrame face{};
  const auto set = [&](std::string_view name, double value) {
    face[std::size_t(fap::find_arkit(name).value())] = value;
  };
  const auto wave = [&](double hertz, double phase) {
    return 0.5 + 0.5 * std::sin(2 * std::numbers::pi * hertz * seconds + phase);
  };
  set("jawOpen", 0.5 * wave(3.1, 0));
  set("mouthPucker", 0.4 * wave(1.3, 1));
  set("mouthSmileLeft", 0.3 * wave(0.4, 2));
  set("mouthSmileRight", 0.35 * wave(0.4, 2.2));
  set("jawLeft", std::max(0.0, std::sin(seconds)) * 0.3);
  set("jawRight", std::max(0.0, -std::sin(seconds)) * 0.3);
  set("browInnerUp", 0.5 * wave(0.3, 0.5));
  set("eyeBlinkLeft", std::fmod(seconds, 3) < 0.2 ? 0.9 : 0);
  set("eyeBlinkRight", std::fmod(seconds, 3) < 0.2 ? 0.9 : 0);
  set("headYaw", 0.3 * std::sin(0.7 * seconds));
  set("headPitch", 0.2 * std::sin(0.9 * seconds + 1));
  set("headRoll", 0.1 * std::sin(1.1 * seconds + 2));
  set("leftEyeYaw", 0.2 * std::sin(1.7 * seconds));
  set("rightEyeYaw", 0.2 * std::sin(1.7 * seconds));
  return face;
}

/// Its planes, and what the encoder says that receivers have.
struct MovingFace {
  media::LiveInfo info;
  std::vector<media::LiveUnit> units;
  std::vector<fap::Frame> shown;  ///< by plane: all low-level FAPs
  fap::Rate rate;
};

inline MovingFace moving_face(double seconds, fap::Rate rate = {25, 1}) {
  MovingFace out;
  out.rate = rate;
  fba::LiveOptions options;
  options.rate = rate;
  options.verify = false;
  fba::LiveEncoder encoder(options);
  // Eyes by their angles, so that the gaze has no shape that takes the lids along.
  fap::ArkitChannels channels = fap::kAllArkit;
  for (const char* look : {"In", "Out", "Up", "Down"}) {
    for (const char* side : {"Left", "Right"}) {
      channels.reset(std::size_t(*fap::find_arkit(std::string("eyeLook") + look + side)));
    }
  }
  const auto count = std::int64_t(std::llround(seconds * rate.frames_per_second()));
  for (std::int64_t i = 0; i < count; ++i) {
    const fap::Frame frame = fap::arkit_to_fap(face_at(rate.seconds(double(i))), channels);
    auto bytes = encoder.write(frame);
    EXPECT_TRUE(bytes);
    if (!bytes) return out;
    if (i == 0) {
      fba::LiveEncoder sample(options);
      auto stream = *sample.write(frame);
      const auto end = sample.finish();
      stream.insert(stream.end(), end.begin(), end.end());
      const auto units = fba::split_access_units(stream);
      out.info.face_config = units->config;
      out.info.timescale = units->timescale;
    }
    const auto ticks = std::int64_t(std::llround(out.info.timescale / rate.frames_per_second()));
    out.units.push_back(
        {media::LiveTrack::face, std::move(*bytes), encoder.intra(), i * ticks, ticks});
    fap::Frame shown = encoder.reconstruction();
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!shown.mask[std::size_t(fap)]) shown.set(fap, 0);
    }
    out.shown.push_back(shown);
  }
  return out;
}

/// What `animeme export` makes of it: fap::ArkitFitter from frame to frame.
inline std::vector<fap::ArkitFrame> fit_of(const MovingFace& face) {
  fap::ArkitFitter fitter;
  std::vector<fap::ArkitFrame> out;
  for (const fap::Frame& frame : face.shown) out.push_back(fitter.fit(frame));
  return out;
}

/// One datagram as it was sent.
struct Sent {
  double seconds;
  std::vector<std::uint8_t> bytes;
};

inline std::vector<Sent> sent_to(const std::string& url, const MovingFace& face) {
  std::vector<Sent> sent;
  engines::EngineSinkOptions options;
  options.instead = [&](double seconds, std::span<const std::uint8_t> bytes) {
    sent.push_back({seconds, {bytes.begin(), bytes.end()}});
  };
  auto sink = engines::make_engine_sink(url, options);
  EXPECT_TRUE(sink) << (sink ? "" : sink.error().describe());
  if (!sink) return sent;
  EXPECT_TRUE((*sink)->start(face.info));
  for (const media::LiveUnit& unit : face.units) EXPECT_TRUE((*sink)->send(unit));
  EXPECT_TRUE((*sink)->finish());
  return sent;
}

/// What reader.py makes of it, a frame each.
inline std::vector<Json> read_by_others(const std::string& protocol,
                                        const std::vector<Sent>& sent) {
  const TempDir dir;
  std::string file;
  for (const Sent& each : sent) {
    const auto size = std::uint32_t(each.bytes.size());
    char head[12];  // little endian, as the machines that run tests are
    std::memcpy(head, &each.seconds, 8);
    std::memcpy(head + 8, &size, 4);
    file.append(head, 12);
    file.append(each.bytes.begin(), each.bytes.end());
  }
  spill(dir / "sent", file);
  const std::string script = std::string(test::kSourceFolder) + "/tests/live/engines/reader.py";
  const ProgramResult read = run_command({"python3", script, protocol, dir / "sent"});
  EXPECT_EQ(read.exit_code, 0) << read.err;
  std::vector<Json> frames;
  for (std::size_t at = 0; at < read.out.size();) {
    const std::size_t end = read.out.find('\n', at);
    frames.push_back(Json::parse(read.out.substr(at, end - at)));
    at = end + 1;
  }
  return frames;
}

/// "JawOpen" of "jawOpen".
inline std::string capital(std::string_view name) {
  std::string out(name);
  out[0] = char(out[0] - 'a' + 'A');
  return out;
}

}  // namespace animeme::test
