#include "dam/signal/fap_signal.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "dam/signal/arkit_signal.h"
#include "fap/fill.h"
#include "fap/tables.h"

namespace animeme::dam {
namespace {
constexpr std::int64_t kMaxFrames = 10'000'000;

Result<fap::Sequence> from_arkit(const Signal& signal, const ArkitLayout& layout) {
  fap::Sequence sequence;
  sequence.rate = signal.rate;
  const std::size_t controls = signal.names.size();
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    const std::span row(&signal.values[i * controls], controls);
    for (std::size_t c = 0; c < controls; ++c)
      if (layout.channel[c] >= 0 && !std::isfinite(row[c]))
        return make_error(Code::invalid_argument, "frame " + std::to_string(i) + " of " +
                                                      signal.names[c] + " is not finite");
    sequence.frames.push_back(fap::arkit_to_fap(layout.frame(row), layout.has));
    sequence.frames.back().number = std::int64_t(i);
  }
  return sequence;
}
}  // namespace

std::string fap_channel(int fap) {
  return "fap" + std::to_string(fap) + "_" + std::string(fap::info(fap).name);
}

int fap_of_channel(std::string_view name) {
  if (!name.starts_with("fap")) return 0;
  name.remove_prefix(3);
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || number < 1 || number > fap::kFapCount) return 0;
  const auto rest = name.substr(std::size_t(end - name.data()));
  return rest.empty() || rest.front() == '_' ? number : 0;
}

Result<fap::Sequence> to_sequence(const Signal& signal) {
  std::array<std::ptrdiff_t, fap::kFapCount + 1> channel;
  channel.fill(-1);
  bool any = false;
  for (std::size_t c = 0; c < signal.names.size(); ++c) {
    const int fap = fap_of_channel(signal.names[c]);
    if (fap < fap::kFirstLowLevel) continue;
    if (channel[std::size_t(fap)] >= 0)
      return make_error(Code::invalid_argument,
                        "two channels carry FAP " + std::to_string(fap) + "; remove one");
    channel[std::size_t(fap)] = std::ptrdiff_t(c);
    any = true;
  }
  if (!any) {
    if (const auto arkit = find_arkit_layout(signal.names)) return from_arkit(signal, *arkit);
    return make_error(Code::not_found,
                      "no channel is a FAP; FAP channels are called fapN_name, like fap3_open_jaw");
  }
  fap::Sequence sequence;
  sequence.rate = signal.rate;
  sequence.frames.resize(signal.frames());
  for (std::size_t i = 0; i < signal.frames(); ++i) {
    sequence.frames[i].number = std::int64_t(i);
    for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (channel[std::size_t(fap)] < 0) continue;
      const double value = signal.at(i, std::size_t(channel[std::size_t(fap)]));
      if (!std::isfinite(value))
        return make_error(Code::invalid_argument, "frame " + std::to_string(i) + " of FAP " +
                                                      std::to_string(fap) + " is not finite");
      const auto& info = fap::info(fap);
      const double range = double(info.default_i_range) * double(info.quant_step);
      sequence.frames[i].set(fap, std::int32_t(std::round(std::clamp(value, -range, range))));
    }
  }
  return sequence;
}

Result<Signal> to_signal(const fap::Sequence& sequence) {
  Signal signal;
  signal.rate = sequence.rate;
  fap::Mask mask;
  std::int64_t frames = 0;
  for (const fap::Frame& frame : sequence.frames) {
    if (frame.number < frames || frame.number >= kMaxFrames)
      return make_error(Code::out_of_range, "frame number " + std::to_string(frame.number) +
                                                " is too large or out of order");
    mask |= frame.mask;
    frames = frame.number + 1;
  }
  if (const std::int64_t missing = frames - std::int64_t(sequence.frames.size());
      missing > fap::kMostMissing)
    return make_error(Code::out_of_range, std::to_string(missing) +
                                              " frames are missing, at most " +
                                              std::to_string(fap::kMostMissing) +
                                              " are filled in; correct the frame numbers");
  std::vector<int> faps;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap)
    if (mask[std::size_t(fap)]) faps.push_back(fap);
  for (const int fap : faps) signal.names.push_back(fap_channel(fap));
  signal.values.reserve(std::size_t(frames) * faps.size());
  std::vector<double> held(faps.size(), 0.0);
  std::int64_t number = 0;
  for (const fap::Frame& frame : sequence.frames) {
    for (; number < frame.number; ++number) {
      signal.values.insert(signal.values.end(), held.begin(), held.end());
      signal.measured.push_back(false);
    }
    for (std::size_t c = 0; c < faps.size(); ++c)
      if (frame.mask[std::size_t(faps[c])]) held[c] = frame.value[std::size_t(faps[c])];
    signal.values.insert(signal.values.end(), held.begin(), held.end());
    signal.measured.push_back(true);
    ++number;
  }
  return signal;
}

}  // namespace animeme::dam
