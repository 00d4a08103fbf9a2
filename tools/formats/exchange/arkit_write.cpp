#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "dam/signal/arkit_signal.h"
#include "dam/signal/fap_signal.h"
#include "fap/fill.h"
#include "tools/formats/exchange/arkit.h"
#include "tools/formats/exchange/detail/json_text.h"

namespace animeme::exchange {

namespace {

constexpr int kDecimals = 6;

std::string timecode(std::size_t frame, const fap::Rate& rate) {
  // As cameras count: 29.97 frames a second are numbered like 30, without dropping any.
  const auto per_second =
      rate.valid() ? std::int64_t(std::ceil(rate.frames_per_second() - 1e-9)) : 1;
  const auto number = std::int64_t(frame);
  const std::int64_t seconds = number / per_second;
  char text[64];
  std::snprintf(text, sizeof text, "%02d:%02d:%02d:%02d.000", int(seconds / 3600 % 100),
                int(seconds / 60 % 60), int(seconds % 60), int(number % per_second));
  return text;
}

std::string capital(std::string_view name) {
  std::string out(name);
  out[0] = char(out[0] - 'a' + 'A');
  return out;
}

}  // namespace

ArkitCurves fit_arkit(const fap::Sequence& clip, const std::function<void(double)>& progress) {
  ArkitCurves curves{clip.rate, {}};
  fap::ArkitFitter fitter;
  for (const fap::Frame& frame : clip.frames) {
    curves.frames.push_back(fitter.fit(frame));
    if (progress) progress(double(curves.frames.size()) / double(clip.frames.size()));
  }
  return curves;
}

Result<ArkitCurves> arkit_of_signal(const dam::Signal& signal,
                                    const std::function<void(double)>& progress) {
  const bool faps = std::any_of(
      signal.names.begin(), signal.names.end(),
      [](const std::string& name) { return dam::fap_of_channel(name) >= fap::kFirstLowLevel; });
  const auto layout = dam::find_arkit_layout(signal.names);
  if (faps || !layout) {
    const auto clip = dam::to_sequence(signal);
    if (!clip) return clip.error();
    fap::FillOptions whole;
    whole.complete = true;
    whole.max_frames = std::int64_t(clip->frames.size()) + 1;
    const auto face = fap::fill(*clip, whole);
    if (!face) return face.error();
    return fit_arkit(*face, progress);
  }
  ArkitCurves curves{signal.rate, {}};
  const std::size_t controls = signal.names.size();
  for (std::size_t i = 0; i < signal.frames(); ++i)
    curves.frames.push_back(layout->frame({&signal.values[i * controls], controls}));
  return curves;
}

std::string write_live_link(const ArkitCurves& curves) {
  std::string text = "Timecode,BlendShapeCount";
  for (const std::string_view name : fap::kArkitNames) text += "," + capital(name);
  text += "\n";
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    text += timecode(i, curves.rate) + "," + std::to_string(fap::kArkitChannelCount);
    for (const double value : curves.frames[i]) text += "," + decimals(value, kDecimals);
    text += "\n";
  }
  return text;
}

std::string write_arkit_json(const ArkitCurves& curves, std::string_view audio) {
  std::string text = track_head("animeme-arkit", curves.rate, audio);
  char separator = '[';
  for (const std::string_view name : fap::kArkitNames) {
    text += separator + json_text(name);
    separator = ',';
  }
  return text + "]" + track_frames(curves.frames, kDecimals);
}

}  // namespace animeme::exchange
