#include "tools/formats/inspect/stream_internal.h"

#include <algorithm>

#include "fap/rate_text.h"
#include "fap/tables.h"
#include "tools/formats/common/bit_rate.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/activity.h"

namespace animeme::inspect {

using tools::Json;

namespace {

// Runs of numbers: "3-13, 51-60".
template <std::size_t N>
std::string mask_text(const std::bitset<N>& mask, const char* separator = ", ") {
  std::string text;
  for (std::size_t number = 1; number < N; ++number) {
    if (!mask[number]) continue;
    std::size_t last = number;
    while (last + 1 < N && mask[last + 1]) ++last;
    if (!text.empty()) text += separator;
    text += std::to_string(number);
    if (last > number) text += "-" + std::to_string(last);
    number = last;
  }
  return text.empty() ? "none" : text;
}

constexpr const char* kRangeNames[4] = {"i_max", "i_min", "p_max", "p_min"};

template <std::size_t N>
Json types_of(const std::array<fba::MaskType, N>& types) {
  return tools::json_list(types, [](fba::MaskType type) { return int(type); });
}

// The four sets that were sent, for the parameters from `first` on.
template <class Settings>
void add_ranges(Json& json, const Settings& settings, std::size_t first, const char* prefix) {
  for (std::size_t kind = 0; kind < 4; ++kind) {
    if (!settings.send_range[kind]) continue;
    Json ranges = Json::array();
    for (std::size_t number = first; number < settings.mask.size(); ++number) {
      if (settings.mask[number]) ranges.push_back(settings.range[kind][number] * 60);
    }
    json[std::string(prefix) + kRangeNames[kind]] = ranges;
  }
}

std::string time_code_text(const fba::TimeCode& code) {
  return tools::format("%02d:%02d:%02d", code.hours, code.minutes, code.seconds);
}

void add_temporal(Json& json, const fba::TemporalHeader& temporal) {
  if (temporal.skip) json["skip"] = *temporal.skip;
  if (temporal.rate) json["rate"] = fap::format_rate(temporal.rate->rate());
  if (temporal.time_code) json["time_code"] = time_code_text(*temporal.time_code);
}

}  // namespace

Json describe_plane(const fba::Plane& plane) {
  const bool face = fba::has_face(plane.object_mask);
  const bool body = fba::has_body(plane.object_mask);
  Json json = {{"number", plane.number},
               {"seconds", plane.seconds},
               {"type", plane.intra ? "I" : "P"},
               {"bit", plane.bit_begin},
               {"bits", plane.bit_end - plane.bit_begin},
               {"start_code", plane.start_code},
               {"face", face},
               {"body", body}};
  add_temporal(json, plane.temporal);
  if (face && plane.face.mask[1]) json["viseme_def"] = plane.face.viseme.def;
  if (face && plane.face.mask[2]) {
    json["init_face"] = plane.face.expression.init_face;
    json["expression_def"] = plane.face.expression.def;
  }
  if (plane.intra && plane.face_settings) {
    const fba::FaceSettings& settings = *plane.face_settings;
    json["fap_quant"] = settings.fap_quant;
    json["mask_types"] = types_of(settings.mask_type);
    json["faps"] = mask_text(settings.mask);
    json["gender"] = settings.male ? "male" : "female";
    add_ranges(json, settings, fap::kFirstLowLevel, "");
  }
  if (plane.intra && plane.body_settings) {
    const fba::BodySettings& settings = *plane.body_settings;
    json["bap_quant"] = settings.bap_quant;
    json["bap_mask_types"] = types_of(settings.mask_type);
    json["baps"] = mask_text(settings.mask);
    json["bap_gender"] = settings.male ? "male" : "female";
    add_ranges(json, settings, 1, "bap_");
  }
  return json;
}

namespace {

// "I -60..1860 P -120..60": the widest of the ranges that were sent.
template <class Settings>
std::string widest_ranges(const Settings& settings, std::size_t first) {
  const auto widest = [&](std::size_t kind) -> std::string {
    if (!settings.send_range[kind]) return "?";
    int m = 0;
    for (std::size_t number = first; number < settings.mask.size(); ++number) {
      if (settings.mask[number]) m = std::max<int>(m, settings.range[kind][number]);
    }
    return (kind % 2 == 1 && m > 0 ? "-" : "") + std::to_string(m * 60);
  };
  std::string text;
  for (const std::size_t kind : {std::size_t(fba::kIntraMax), std::size_t(fba::kPredictiveMax)}) {
    if (!settings.send_range[kind] && !settings.send_range[kind + 1]) continue;
    text += kind == fba::kIntraMax ? " I " : " P ";
    text += widest(kind + 1) + ".." + widest(kind);
  }
  return text.empty() ? " ranges as before" : " ranges" + text;
}

template <class Settings>
std::string settings_text(const Settings& settings, const char* name, int quant,
                          std::size_t first) {
  std::string types;
  for (const fba::MaskType type : settings.mask_type) types += char('0' + int(type));
  return std::string("  ") + name + " " + mask_text(settings.mask, ",") + " types " + types +
         " quant " + std::to_string(quant) + widest_ranges(settings, first);
}

std::string details(const fba::Plane& plane) {
  std::string text;
  const fba::TemporalHeader& temporal = plane.temporal;
  if (plane.start_code) text += "  start code";
  if (temporal.rate) text += "  rate " + fap::format_rate(temporal.rate->rate());
  if (temporal.time_code) text += "  time " + time_code_text(*temporal.time_code);
  if (temporal.skip) text += "  skip " + std::to_string(*temporal.skip);
  if (fba::has_face(plane.object_mask)) {
    if (plane.face.mask[1] && plane.face.viseme.def) text += "  viseme_def";
    if (plane.face.mask[2] && plane.face.expression.init_face) text += "  init_face";
    if (plane.face.mask[2] && plane.face.expression.def) text += "  expression_def";
  }
  if (!plane.intra) return text;
  if (plane.face_settings) {
    const fba::FaceSettings& face = *plane.face_settings;
    text += settings_text(face, "FAP", face.fap_quant, fap::kFirstLowLevel);
  }
  if (plane.body_settings) {
    const fba::BodySettings& body = *plane.body_settings;
    text += settings_text(body, "BAP", body.bap_quant, 1);
  }
  return text;
}

}  // namespace

namespace {

Json describe_face(const Extent<fap::Frame>& face, fap::Rate rate) {
  Json faps = Json::array();
  for (int number = fap::kFirstLowLevel; number <= fap::kFapCount; ++number) {
    if (!face.used[std::size_t(number)]) continue;
    const auto& range = face.range[std::size_t(number)];
    faps.push_back({{"fap", number},
                    {"name", fap::info(number).name},
                    {"min", range.low},
                    {"max", range.high}});
  }
  return {{"frames", face.frames},
          {"rate", fap::format_rate(rate)},
          {"seconds", rate.seconds(double(face.last + 1))},
          {"coded_faps", mask_text(face.used)},
          {"faps", faps}};
}

Json describe_body(const Extent<fba::BodyFrame>& body, fap::Rate rate) {
  Json baps = Json::array();
  for (std::size_t number = 1; number <= fba::kBapCount; ++number) {
    if (!body.used[number]) continue;
    baps.push_back(
        {{"bap", number}, {"min", body.range[number].low}, {"max", body.range[number].high}});
  }
  return {{"frames", body.frames},
          {"rate", fap::format_rate(rate)},
          {"seconds", rate.seconds(double(body.last + 1))},
          {"coded_baps", mask_text(body.used)},
          {"baps", baps}};
}

}  // namespace

template <class Frame>
void Extent<Frame>::add(const Frame& frame) {
  ++frames;
  last = frame.number;
  for (std::size_t number = 1; number < range.size(); ++number) {
    if (!frame.mask[number]) continue;
    const std::int32_t value = frame.value[number];
    Range& one = range[number];
    one.low = used[number] ? std::min(one.low, value) : value;
    one.high = used[number] ? std::max(one.high, value) : value;
    used.set(number);
  }
}

void StreamExtent::add(const fba::Plane& plane) {
  if (planes++ == 0) rate = plane.rate;
  intra += plane.intra ? 1 : 0;
  last = plane.number;
  if (plane.face_settings && !fap_quant) fap_quant = plane.face_settings->fap_quant;
  if (plane.body_settings && !bap_quant) bap_quant = plane.body_settings->bap_quant;
  if (fba::has_face(plane.object_mask)) face.add(plane.face);
  if (plane.body) body.add(*plane.body);
}

Json describe_clip(const fap::Sequence& clip) {
  Extent<fap::Frame> face;
  for (const fap::Frame& frame : clip.frames) face.add(frame);
  return describe_face(face, clip.rate);
}

Json describe_clip(const Extent<fap::Frame>& clip, fap::Rate rate) {
  return describe_face(clip, rate);
}

template void Extent<fap::Frame>::add(const fap::Frame& frame);

Json describe_body(const fba::BodySequence& body) {
  Extent<fba::BodyFrame> extent;
  for (const fba::BodyFrame& frame : body.frames) extent.add(frame);
  return describe_body(extent, body.rate);
}

Json describe_stream(const StreamExtent& stream, const fba::StreamInfo& info,
                     const std::vector<std::string>& warnings, std::size_t bytes) {
  const double seconds = stream.rate.seconds(double(stream.last + 1));
  Json json = {{"planes", stream.planes},
               {"intra_planes", stream.intra},
               {"body_planes", stream.body.frames},
               {"bytes", bytes},
               {"seconds", seconds},
               {"kbit_per_s", tools::kbit_per_s(bytes, seconds)},
               {"clip", describe_face(stream.face, stream.rate)}};
  if (info.profile_and_level) json["profile_and_level"] = *info.profile_and_level;
  if (stream.bap_quant) json["body"] = describe_body(stream.body, stream.rate);
  json["warnings"] = warnings;
  if (stream.fap_quant) json["fap_quant"] = *stream.fap_quant;
  if (stream.bap_quant) json["bap_quant"] = *stream.bap_quant;
  return json;
}

std::string planes_heading() {
  return tools::format("%8s %10s %10s %7s  %-4s %s\n", "number", "seconds", "bit", "bits", "type",
                       "of    says");
}

std::string plane_text(const fba::Plane& plane) {
  constexpr const char* kParts[4] = {"-", "face", "body", "both"};
  return tools::format("%8lld %10.3f %10lld %7lld  %-4s %-4s%s\n", (long long)plane.number,
                       plane.seconds, (long long)plane.bit_begin,
                       (long long)(plane.bit_end - plane.bit_begin), plane.intra ? "I" : "P",
                       kParts[std::size_t(plane.object_mask)], details(plane).c_str());
}

}  // namespace animeme::inspect
