#include "tools/live/web/detail/values.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "codec/decode/fill.h"
#include "codec/syntax/plane.h"
#include "fap/fill.h"
#include "fap/tables.h"
#include "tools/formats/common/json.h"

namespace animeme::web {
namespace {

using tools::Json;

/// What a receiver shows after `coded`, if it showed `before`: all low-level FAPs, and of FAP 1 and
/// 2 those that were ever sent.
fap::Frame resolve(const fap::Frame& before, const fap::Frame& coded,
                   const fba::FaceSettings& settings) {
  fap::Sequence two{{25, 1}, {before, coded}, {}};
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    two.frames[0].mask.set(std::size_t(fap));  // neutral at first, and nothing is derived here
  }
  two.frames[0].number = 0;
  two.frames[1].number = 1;
  const fap::GroupRules rules[2] = {{}, fba::group_rules(settings)};
  Result<fap::Sequence> filled = fap::fill(two, rules, {.keep_high_level = true});
  return filled && filled->frames.size() == 2 ? filled->frames[1] : coded;
}

double microseconds(double seconds) { return std::round(seconds * 1e6) / 1e6; }

}  // namespace

std::string values_hello(std::uint32_t timescale) {
  Json hello{{"version", 1}, {"timescale", timescale}};
  Json& faps = hello["faps"];
  for (const fap::FapInfo& info : fap::kFaps) {
    faps[std::to_string(info.number)] = {{"name", info.name}, {"unit", fap::unit_name(info.unit)}};
  }
  return hello.dump();
}

std::optional<fap::Frame> Values::push(std::span<const std::uint8_t> unit) {
  // A decoder wants to see what stands behind a plane. All units begin with a start code, so these
  // bytes can be told before the next unit is there, and nobody waits for it.
  static constexpr std::uint8_t kPrefix[] = {0, 0, 1};
  const bool begins =
      unit.size() > 3 && std::equal(std::begin(kPrefix), std::end(kPrefix), unit.begin());
  if (!begins) return std::nullopt;
  decoder_.push(ahead_ ? unit.subspan(std::size(kPrefix)) : unit);
  decoder_.push(kPrefix);
  ahead_ = true;
  bool face = false;
  for (;;) {
    Result<fba::Event> event = decoder_.next();
    if (!event) {
      const Code code = event.error().code;
      if (code == Code::need_data || code == Code::end_of_stream) break;
      continue;  // it goes on at the next intra plane
    }
    if (event->kind != fba::Event::Kind::plane || !has_face(event->plane.object_mask)) continue;
    const fba::FaceSettings plain;
    const auto& settings = event->plane.face_settings ? *event->plane.face_settings : plain;
    shown_ = resolve(shown_, event->plane.face, settings);
    sent_ |= event->plane.face.mask;
    face = true;
  }
  if (!face) return std::nullopt;
  // FAPs that nobody has ever sent and that follow from none are 0 and left out.
  fap::Frame shown = shown_;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    const auto at = std::size_t(fap);
    shown.mask[at] = sent_[at] || shown.value[at] != 0;
  }
  return shown;
}

std::string write_values(const ValuesMessage& message, const fap::Frame& face) {
  Json json{{"time", microseconds(message.time)},
            {"duration", microseconds(message.duration)},
            {"intra", message.intra},
            {"bytes", message.bytes}};
  Json& values = json["values"] = Json::object();
  for (int fap = 1; fap <= fap::kFapCount; ++fap) {
    if (!face.mask[std::size_t(fap)]) continue;
    Json& value = values[std::to_string(fap)];
    if (fap == 1) {
      value = {{"select1", face.viseme.select1},
               {"select2", face.viseme.select2},
               {"blend", face.viseme.blend}};
    } else if (fap == 2) {
      value = {{"select1", face.expression.select1},
               {"intensity1", face.expression.intensity1},
               {"select2", face.expression.select2},
               {"intensity2", face.expression.intensity2}};
    } else {
      value = face.value[std::size_t(fap)];
    }
  }
  return json.dump();
}

}  // namespace animeme::web
