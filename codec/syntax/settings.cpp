#include <span>
#include <string>

#include "codec/syntax/settings_internal.h"

namespace animeme::fba::internal {

namespace {

Result<void> check_bounds(int value, int low, int high, const char* what) {
  if (value >= low && value <= high) return {};
  return make_error(Code::out_of_range, std::string(what) + " = " + std::to_string(value) +
                                            " lies outside " + std::to_string(low) + ".." +
                                            std::to_string(high));
}

// `coded` of the `size` members of a group.
MaskType mask_type(int coded, int size, bool interpolated) {
  if (coded == 0) return MaskType::none;
  if (coded == size) return MaskType::all;
  return interpolated ? MaskType::interpolate : MaskType::hold;
}

// Whether a member of a group may be as it is in the mask.
bool agrees(MaskType type, bool coded) {
  return !(type == MaskType::none && coded) && !(type == MaskType::all && !coded);
}

}  // namespace

Error invalid(std::string message) {
  return make_error(Code::invalid_argument, std::move(message));
}

Result<void> check_quant(const char* name, int quant) {
  if (quant >= 0 && quant <= 31) return {};
  return invalid(std::string(name) + " must be 0..31");
}

Result<void> check_numbers(int fap_quant, int bap_quant, double intra_seconds) {
  if (auto ok = check_quant("fap_quant", fap_quant); !ok) return ok;
  if (auto ok = check_quant("bap_quant", bap_quant); !ok) return ok;
  if (intra_seconds >= 0) return {};  // not NaN either
  return invalid("the intra period must not be negative");
}

Result<void> check_high_level(const fap::Frame& frame) {
  struct Bounded {
    std::size_t fap;
    std::int32_t value;
    int most;
    const char* what;
  };
  const fap::Viseme& viseme = frame.viseme;
  const fap::Expression& expression = frame.expression;
  const Bounded all[] = {{1, viseme.select1, 14, "viseme_select1 of FAP 1"},
                         {1, viseme.select2, 14, "viseme_select2 of FAP 1"},
                         {1, viseme.blend, 63, "viseme_blend of FAP 1"},
                         {2, expression.select1, 6, "expression_select1 of FAP 2"},
                         {2, expression.intensity1, 63, "expression_intensity1 of FAP 2"},
                         {2, expression.select2, 6, "expression_select2 of FAP 2"},
                         {2, expression.intensity2, 63, "expression_intensity2 of FAP 2"}};
  for (const Bounded& value : all) {
    if (!frame.mask[value.fap]) continue;
    if (auto ok = check_bounds(value.value, 0, value.most, value.what); !ok) return ok;
  }
  return {};
}

bool mask_agrees(const FaceSettings& settings) {
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    const fap::GroupInfo& info = fap::kGroups[group];
    for (int i = 0; i < info.size; ++i) {
      const bool coded = settings.mask[std::size_t(info.first + i)];
      if (!agrees(settings.mask_type[group], coded)) return false;
    }
  }
  return true;
}

bool mask_agrees(const BodySettings& settings) {
  std::size_t slot = 0;
  for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
    const MaskType type = settings.mask_type[group];
    if (type == MaskType::interpolate) return false;
    for (int i = 0; i < kBodyGroupSizes[group]; ++i, ++slot) {
      if (!agrees(type, settings.mask[kBapOrder[slot]])) return false;
    }
  }
  return true;
}

void set_mask_types(FaceSettings& settings, std::bitset<fap::kGroupCount> interpolated) {
  for (std::size_t group = 0; group < fap::kGroupCount; ++group) {
    const fap::GroupInfo& info = fap::kGroups[group];
    int coded = 0;
    for (int i = 0; i < info.size; ++i) coded += settings.mask[std::size_t(info.first + i)] ? 1 : 0;
    settings.mask_type[group] = mask_type(coded, info.size, interpolated[group]);
  }
}

void set_mask_types(BodySettings& settings) {
  std::size_t slot = 0;
  for (std::size_t group = 0; group < kBodyGroupCount; ++group) {
    const int size = kBodyGroupSizes[group];
    int coded = 0;
    for (int i = 0; i < size; ++i) coded += settings.mask[kBapOrder[slot++]] ? 1 : 0;
    settings.mask_type[group] = mask_type(coded, size, false);
  }
}

void guard_fap4(FaceSettings& settings) {
  const bool zero = settings.range[kIntraMax][4] == 0 && settings.range[kIntraMin][4] == 0;
  if (settings.mask[4] && zero) settings.range[kIntraMax][4] = 1;
}

void guard_last_group(std::bitset<kBapCount + 1>& mask) {
  const auto group = std::span(kBapOrder).last(kBodyGroupSizes.back());
  const auto coded =
      std::count_if(group.begin(), group.end(), [&](int bap) { return mask[std::size_t(bap)]; });
  if (coded == 1 && mask[group.front()]) mask.set(group.back());
}

}  // namespace animeme::fba::internal
