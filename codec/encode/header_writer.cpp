#include "codec/encode/header_writer_internal.h"

#include "codec/decode/unit_writer_internal.h"
#include "codec/syntax/state_internal.h"

namespace animeme::fba::internal {

namespace {

template <class Settings>
void write_ranges(BitWriter& out, const SlotTable& table, const Settings& settings) {
  for (const bool send : settings.send_range) out.bit(send);
  for (std::size_t kind = 0; kind < 4; ++kind) {
    if (!settings.send_range[kind]) continue;
    std::size_t slot = 0;
    for (const std::uint8_t size : table.group_sizes) {
      for (int i = 0; i < size; ++i, ++slot) {
        if (i % 4 == 0) out.bit(1);
        const std::size_t number = table.number[slot];
        if (settings.mask[number]) out.bits(settings.range[kind][number], 5);
      }
    }
  }
}

}  // namespace

void write_temporal(BitWriter& out, bool intra, const TemporalHeader& temporal) {
  if (intra) {
    out.bit(temporal.rate.has_value());
    if (temporal.rate) {
      out.bits(temporal.rate->frame_rate, 8);
      out.bits(temporal.rate->sixteenths, 4);
      out.bit(temporal.rate->frequency_offset);
    }
    out.bit(temporal.time_code.has_value());
    if (temporal.time_code) {
      out.bits(temporal.time_code->hours, 5);
      out.bits(temporal.time_code->minutes, 6);
      out.bit(1);
      out.bits(temporal.time_code->seconds, 6);
    }
  }
  write_skip(out, temporal.skip);
}

void write_face_settings(BitWriter& out, const FaceSettings& settings) {
  out.bits(std::uint32_t(settings.fap_quant), 5);
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    out.bit(1);
    const MaskType type = settings.mask_type[group];
    out.bits(std::uint32_t(type), 2);
    if (type != MaskType::hold && type != MaskType::interpolate) continue;
    for (int i = 0; i < fap::kGroups[group].size; ++i) {
      out.bit(settings.mask[std::size_t(fap::kGroups[group].first + i)]);
    }
  }
  out.bit(settings.male);
  out.bit(0);  // fba_object_coding_type: arithmetic
  write_ranges(out, face_slots(), settings);
}

void write_body_settings(BitWriter& out, const BodySettings& settings) {
  out.bits(std::uint32_t(settings.bap_quant), 5);
  std::size_t slot = 0;
  for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
    out.bit(1);
    const MaskType type = settings.mask_type[group];
    out.bits(std::uint32_t(type), 2);
    for (int i = 0; i < kBodyGroupSizes[group]; ++i, ++slot) {
      if (type == MaskType::hold) out.bit(settings.mask[kBapOrder[slot]]);
    }
  }
  out.bit(settings.male);
  out.bit(0);
  write_ranges(out, body_slots(), settings);
}

}  // namespace animeme::fba::internal
