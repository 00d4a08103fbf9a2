#include "codec/encode/plane_levels_internal.h"

#include <string>

#include "codec/syntax/quantise_internal.h"
#include "codec/syntax/settings_internal.h"

namespace animeme::fba::internal {

namespace {

[[gnu::cold, gnu::noinline]] Error value_error(const char* what, int number, std::int64_t value,
                                               std::int64_t level, std::int64_t low,
                                               std::int64_t high) {
  return make_error(Code::out_of_range, std::string(what) + " " + std::to_string(number) + " = " +
                                            std::to_string(value) + " needs level " +
                                            std::to_string(level) + ", outside the range " +
                                            std::to_string(low) + ".." + std::to_string(high) +
                                            " in force; widen the range or code an intra plane");
}

Error too_large_error(const char* what, int number, std::int64_t value) {
  return make_error(Code::out_of_range,
                    std::string(what) + " " + std::to_string(number) + " = " +
                        std::to_string(value) +
                        " would be rounded to a number of more than 32 bits; use a smaller value");
}

template <class Settings>
bool ranges_legal(const Settings& settings) {
  for (const auto& set : settings.range) {
    for (const std::uint8_t m : set) {
      if (m > 31) return false;
    }
  }
  return true;
}

// `name`: FAP or BAP, `part`: face or body.
template <class Settings>
Result<void> check_settings(const Settings* settings, const char* name, const char* part) {
  if (!mask_agrees(*settings)) return invalid(std::string(name) + " mask and mask types disagree");
  if (!ranges_legal(*settings)) return invalid(std::string(part) + " ranges must be 0..31");
  return {};
}

Result<void> check_intra(const PlaneInput& plane) {
  if (plane.temporal.rate && !plane.temporal.rate->rate().valid()) {
    return invalid("the frame rate is 0");
  }
  if (const FaceSettings* settings = plane.face_settings; has_face(plane.object_mask)) {
    if (settings == nullptr) return invalid("an intra plane needs face settings");
    if (auto ok = check_quant("fap_quant", settings->fap_quant); !ok) return ok;
    if (auto ok = check_settings(settings, "FAP", "face"); !ok) return ok;
  }
  if (const BodySettings* settings = plane.body_settings; has_body(plane.object_mask)) {
    if (settings == nullptr) return invalid("an intra plane needs body settings");
    if (auto ok = check_quant("bap_quant", settings->bap_quant); !ok) return ok;
    if (auto ok = check_settings(settings, "BAP", "body"); !ok) return ok;
  }
  return {};
}

template <class Settings>
void apply(const SlotCoding& before, const Settings& settings, int quant, int scale,
           SlotCoding& coding) {
  coding.begin(before, settings.mask, quant, scale);
  for (const std::uint16_t slot : coding.coded) {
    const std::size_t number = coding.table->number[slot];
    for (std::size_t kind = 0; kind < 4; ++kind) {
      if (!settings.send_range[kind]) continue;
      coding.range[kind][slot] = level_range(settings.range[kind][number], scale);
    }
  }
}

}  // namespace

std::optional<Error> objection(const PlaneInput& plane) {
  if ((has_face(plane.object_mask) && plane.face == nullptr) ||
      (has_body(plane.object_mask) && plane.body == nullptr)) {
    return invalid("a plane needs values for everything in its object mask");
  }
  if (plane.temporal.skip.value_or(0) > kMaxSkip) {
    return invalid("more than a million frames in a row cannot be skipped");
  }
  if (plane.intra) {
    if (auto ok = check_intra(plane); !ok) return ok.error();
    return std::nullopt;
  }
  if (plane.temporal.rate || plane.temporal.time_code) {
    return invalid("frame rate and time code belong in intra planes");
  }
  return std::nullopt;
}

void apply_settings(const SlotCoding& before, const FaceSettings& settings, SlotCoding& coding) {
  apply(before, settings, settings.fap_quant, fap_scale(settings.fap_quant), coding);
}
void apply_settings(const SlotCoding& before, const BodySettings& settings, SlotCoding& coding) {
  apply(before, settings, settings.bap_quant, bap_scale(settings.bap_quant), coding);
}

bool quantise_slots(const SlotState& state, const SlotCoding& coding, bool intra,
                    std::span<const std::int32_t> values, const char* what, SlotLevels& out,
                    std::optional<Error>& error) {
  const std::size_t count = coding.coded.size();
  out.symbol.resize(count);
  out.rec.resize(count);
  const std::uint16_t* coded = coding.coded.data();
  const std::uint16_t* numbers = coding.table->number.data();
  const std::uint16_t* steps = coding.table->step.data();
  const std::int32_t* before = state.value.data();
  const std::int16_t* lowest = coding.range[intra ? kIntraMin : kPredictiveMin].data();
  const std::int16_t* highest = coding.range[intra ? kIntraMax : kPredictiveMax].data();
  std::uint16_t* symbols = out.symbol.data();
  std::int32_t* recs = out.rec.data();
  const std::int32_t scale = coding.scale;
  const bool quantised = coding.quantised;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t slot = coded[i];
    const int number = numbers[slot];
    const std::int64_t value = values[std::size_t(number)];
    const std::int64_t base = intra ? 0 : before[slot];
    const std::int32_t step = quantised ? steps[slot] * scale : 1;
    const std::int64_t level = quantise(value - base, step);
    const std::int64_t low = -lowest[slot];
    const std::int64_t high = highest[slot];
    if (level < low || level > high) {
      error = value_error(what, number, value, level, low, high);
      return false;
    }
    const std::int64_t rec = base + level * step;
    if (rec != std::int32_t(rec)) {
      error = too_large_error(what, number, value);
      return false;
    }
    symbols[i] = std::uint16_t(level - low);
    recs[i] = std::int32_t(rec);
  }
  return true;
}

bool quantise_high(const HighLevelState& state, int fap_quant, bool intra, int first, int last,
                   const HighLevels& values, HighLevels& levels, std::optional<Error>& error) {
  const auto take = [&](std::size_t index, std::int64_t change, std::int32_t step, std::int64_t low,
                        std::int64_t high) {
    const std::int64_t level = step == 1 ? change : quantise(change, step);
    levels[index] = std::int32_t(level);
    if (level >= low && level <= high) return true;
    error = value_error("high-level FAP", index <= kVisemeBlend ? 1 : 2, values[index], level, low,
                        high);
    return false;
  };
  for (auto index = std::size_t(first); index <= std::size_t(last); ++index) {
    if (intra) {
      const std::int64_t max = high_level_max(int(index), fap_quant);
      if (!take(index, values[index], high_level_step(int(index), fap_quant), 0, max)) return false;
    } else {
      const std::int64_t change = std::int64_t(values[index]) - state.value[index];
      const std::int64_t max = state.max[index];
      if (!take(index, change, state.step[index], -max, max)) return false;
    }
  }
  return true;
}

}  // namespace animeme::fba::internal
