#include "tools/live/sessions/clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "tools/formats/common/text.h"
#include "tools/speech/talking/voice_file.h"

namespace animeme::live {

namespace {

constexpr double kLongInterval = 2;  // seconds that a receiver may have to wait

bool has_limits(const Coding& coding) {
  return coding.max_rms > 0 || coding.max_bits_per_second > 0 || coding.skip_still;
}

Result<fba::AccessUnits> code(const fap::Sequence& face, std::span<const fba::BodyFrame> body,
                              fba::EncodeOptions options, const Coding& coding) {
  if (face.frames.empty() && body.empty()) {
    return make_error(Code::not_found, "there are no frames to stream");
  }
  options.intra_seconds = coding.intra_seconds;
  options.max_rms = coding.max_rms;
  options.max_bits_per_second = bit_rate_of_planes(coding.max_bits_per_second, face.rate);
  options.skip_still = coding.skip_still;
  options.default_ranges = coding.default_ranges;
  options.leave_out = options.leave_out || has_limits(coding);
  const auto stream = fba::encode(face, options, body);
  if (!stream) return stream.error();
  return fba::split_access_units(*stream);
}

/// A decoded stream coded again with its own quantisers and planes: what receivers show, so that
/// sides that were left to them are there.
Result<fba::AccessUnits> code_again(const fba::DecodedStream& stream, const Coding& coding) {
  fba::EncodeOptions options = fba::live_options();
  std::vector<fba::BodyFrame> body;
  for (const fba::Plane& plane : stream.planes) {
    if (plane.face_settings) options.fap_quant = plane.face_settings->fap_quant;
    if (plane.body_settings) options.bap_quant = plane.body_settings->bap_quant;
    if (!plane.body) continue;
    body.push_back(*plane.body);
    body.back().number = plane.number;
  }
  Result<fap::Sequence> face = fba::fill(stream, {.keep_high_level = true});
  if (!face) return face.error();
  face->rate = stream.rate;
  // fill() numbers from 0 and repeats what was skipped.
  const std::int64_t first = stream.planes.empty() ? 0 : stream.planes.front().number;
  std::vector<fap::Frame> frames;
  for (const fba::Plane& plane : stream.planes) {
    const std::size_t at = std::size_t(plane.number - first);
    if (at >= face->frames.size()) continue;
    frames.push_back(face->frames[at]);
    frames.back().number = plane.number;
  }
  face->frames = std::move(frames);
  return code(*face, body, options, coding);
}

/// Marks as intra those units only at which a receiver can join: their plane tells the rate and all
/// ranges that an earlier plane has set.
fba::AccessUnits with_true_joints(fba::AccessUnits units, const fba::DecodedStream& decoded) {
  if (units.units.size() != decoded.planes.size()) return units;
  std::array<bool, 4> face_set{}, body_set{};
  const auto tells_all = [](const auto& settings, std::array<bool, 4>& set) {
    bool all = true;
    for (std::size_t kind = 0; settings && kind < set.size(); ++kind) {
      all = all && (settings->send_range[kind] || !set[kind]);
      set[kind] = set[kind] || settings->send_range[kind];
    }
    return all;
  };
  for (std::size_t i = 0; i < units.units.size(); ++i) {
    const fba::Plane& plane = decoded.planes[i];
    if (!plane.intra) continue;
    const bool face = tells_all(plane.face_settings, face_set);
    const bool body = tells_all(plane.body_settings, body_set);
    units.units[i].intra = i == 0 || (face && body && plane.temporal.rate.has_value());
  }
  return units;
}

std::string interval_text(double seconds) { return tools::format("%.1f s", seconds); }

}  // namespace

double bit_rate_of_planes(double bits_per_second, fap::Rate rate) {
  constexpr double kUnitBits = 36;
  return std::max(bits_per_second - kUnitBits * rate.frames_per_second(), bits_per_second * 0.1);
}

double longest_intra_interval(const fba::AccessUnits& units) {
  if (units.units.empty()) return 0;
  std::int64_t begin = units.units.front().time, longest = 0;
  for (const fba::AccessUnit& unit : units.units) {
    longest = std::max(longest, unit.time - begin);
    if (unit.intra) begin = unit.time;
  }
  const fba::AccessUnit& last = units.units.back();
  longest = std::max(longest, last.time + last.duration - begin);
  return double(longest) / units.timescale;
}

Result<fba::AccessUnits> live_units(const fap::Sequence& clip, const Coding& coding) {
  fba::EncodeOptions options = fba::live_options();
  options.fap_quant = coding.quant;
  return code(clip, {}, options, coding);
}

Result<Clip> code_live_clip(const fap::Sequence& clip, const media::Pcm* audio,
                            const Coding& coding) {
  Result<fba::AccessUnits> face = live_units(clip, coding);
  if (!face) return face.error();
  Clip out{std::move(*face), {}};
  if (audio == nullptr || !coding.sound) return out;
  Result<media::EncodedAudio> sound = media::encode_audio(*audio, coding.audio);
  if (!sound) return sound.error();
  out.sound = std::move(*sound);
  return out;
}

Result<std::optional<fba::AccessUnits>> with_joints(const fba::AccessUnits& units,
                                                    const fba::DecodedStream& decoded,
                                                    const Coding& coding) {
  // A plane of tolerance: periods are whole numbers of planes.
  const double plane = decoded.rate.seconds(1);
  const double longest = longest_intra_interval(with_true_joints(units, decoded));
  if (longest <= coding.intra_seconds + plane && !has_limits(coding) && !coding.default_ranges) {
    return std::optional<fba::AccessUnits>();
  }
  auto again = code_again(decoded, coding);
  if (!again) return again.error();
  const double begin = double(units.units.front().time) / units.timescale;
  for (fba::AccessUnit& unit : again->units) unit.time += std::llround(begin * again->timescale);
  return std::optional(std::move(*again));
}

Result<fba::AccessUnits> for_live_use(fba::AccessUnits units, const fba::DecodedStream& decoded,
                                      const std::string& name, const Coding& coding,
                                      const tools::Log& log) {
  if (!coding.copy) {
    auto again = with_joints(units, decoded, coding);
    if (!again) return again.error().in_file(name);
    if (*again) {
      log.info(name + ": re-encoded" + (has_limits(coding) ? " to be smaller" : "") +
               ", so that receivers can join every " + interval_text(coding.intra_seconds) +
               "; --copy keeps it unchanged");
      return std::move(**again);
    }
  }
  const double longest = longest_intra_interval(with_true_joints(units, decoded));
  if (longest > kLongInterval) {
    log.warn(name + ": up to " + interval_text(longest) +
             " between two intra planes, so a receiver that joins or loses a packet waits that "
             "long; without --copy it is re-encoded");
  }
  return units;
}

Result<media::EncodedAudio> live_sound(const std::string& path, const Coding& coding,
                                       const tools::Log& log) {
  const auto keep = [&](media::AudioCodec codec) {
    return !coding.codec_given || codec == coding.audio.codec;
  };
  return speech::read_coded_sound(path, keep, coding.audio, log);
}

}  // namespace animeme::live
