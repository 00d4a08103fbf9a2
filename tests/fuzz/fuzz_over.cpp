// A performance (any stream with a face) kept under new speech: nothing that is not finite, time
// that ascends within its limits, and a clip that can be coded. The last bytes are phones of the
// performance and of the speech.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "dam/model/builtin.h"
#include "dam/performance/over_speech.h"
#include "dam/script/phones.h"
#include "dam/signal/fap_signal.h"
#include "dam/speaking/synthesise.h"
#include "tests/fuzz/require.h"

using animeme::test::require;

namespace {

using namespace animeme;

constexpr std::size_t kPhones = 12, kMostFrames = 2000;

// Two bytes a phone: its sound and its length.
dam::Script script_of(std::span<const std::uint8_t> bytes) {
  const auto all = dam::phones();
  dam::Script script;
  double at = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const double end = at + 0.01 + 0.004 * bytes[i + 1];
    script.phones.push_back({at, end, std::string(all[bytes[i] % all.size()].label), "word"});
    at = end;
  }
  return script;
}

void check(const dam::OverReport& report, double seconds) {
  const auto& moments = report.time.moments();
  for (std::size_t i = 1; i < moments.size(); ++i) {
    const double time = moments[i].time - moments[i - 1].time;
    const double source = moments[i].source - moments[i - 1].source;
    require(time > 0 && source > 0);
    require(source / time < 1 + dam::kMostBend + 1e-6);
    require(time / source < 1 + dam::kMostBend + 1e-6);
  }
  require(report.end >= 0 && report.end <= seconds + 1e-6);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const dam::Model model = *dam::builtin_model();
  if (size < 4 * kPhones + 3) return 0;
  const std::span<const std::uint8_t> all(data, size);
  const auto stream = all.first(size - 4 * kPhones - 3);
  const auto flags = all.subspan(stream.size(), 3);
  const dam::Script own = script_of(all.subspan(stream.size() + 3, 2 * kPhones));
  const dam::Script other = script_of(all.last(2 * kPhones));
  const auto decoded = fba::decode(stream);
  if (!decoded) return 0;
  fap::FillOptions fill;
  fill.expand = true;
  fill.max_frames = kMostFrames;
  auto clip = fba::fill(*decoded, fill);
  if (!clip || clip->frames.size() > kMostFrames) return 0;
  for (fap::Frame& frame : clip->frames) frame.mask.reset(1).reset(2);
  const auto performance = dam::Performance::make(
      std::move(*clip), flags[0] & 1 ? own : dam::Script{}, 0.01 * (flags[0] >> 1));
  if (!performance) {
    require(!performance.error().message.empty());
    return 0;
  }
  dam::SynthesisOptions settings;
  constexpr std::array<fap::Rate, 4> kRates = {{{25, 1}, {30, 1}, {60, 1}, {24000, 1001}}};
  settings.rate = kRates[flags[1] % kRates.size()];
  auto signal = dam::synthesise(model, other, settings);
  if (!signal) return 0;
  dam::OverOptions options;
  options.bend = dam::kMostBend * (flags[1] >> 2) / 63;
  if (flags[2] & 1) options.idle = std::nullopt;
  options.keep.set(~fap::Mask(), (flags[2] >> 1) / 127.0);
  const auto report = dam::speak_over(*signal, other, *performance, options);
  if (!report) {
    require(!report.error().message.empty());
    return 0;
  }
  check(*report, settings.rate.seconds(double(signal->frames())));
  const auto spoken = dam::to_sequence(*signal);
  require(spoken && spoken->frames.size() == signal->frames());
  require(fba::encode(*spoken, {}).has_value());
  return 0;
}
