#include "tools/formats/inspect/sizes.h"

#include <cmath>
#include <map>

#include "codec/decode/decoder.h"
#include "codec/decode/fill.h"
#include "codec/encode/encode.h"
#include "fap/tables.h"
#include "tools/formats/common/json.h"
#include "tools/formats/common/text.h"
#include "tools/formats/inspect/activity.h"

namespace animeme::inspect {

using tools::Json;

namespace {

using Bytes = std::vector<std::uint8_t>;

fba::FaceSettings all_settings() {
  fba::FaceSettings settings;
  for (std::size_t group = 1; group < fap::kGroupCount; ++group) {
    settings.mask_type[group] = fba::MaskType::all;
  }
  for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) settings.mask.set(fap);
  settings.send_range = {true, true, true, true};
  for (auto& set : settings.range) set.fill(31);
  return settings;
}

// As the programs do whose streams are found in the wild: all FAPs, widest ranges, one intra plane.
Result<Bytes> encode_all(const fap::Sequence& clip) {
  const fba::FaceSettings settings = all_settings();
  fba::Encoder encoder;
  fap::Frame held;
  for (std::size_t i = 0; i < clip.frames.size(); ++i) {
    const fap::Frame& frame = clip.frames[i];
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (frame.mask[fap]) held.value[fap] = frame.value[fap];
    }
    fba::PlaneInput plane;
    plane.intra = i == 0;
    if (plane.intra) plane.temporal.rate = fba::code_rate(clip.rate);
    if (i + 1 < clip.frames.size() && clip.frames[i + 1].number != frame.number + 1) {
      plane.temporal.skip = std::uint32_t(clip.frames[i + 1].number - frame.number - 1);
    }
    plane.face = &held;
    plane.face_settings = &settings;
    if (auto ok = encoder.write(plane); !ok) return ok.error();
  }
  return encoder.finish();
}

Result<fap::Sequence> shown(const Bytes& stream) {
  Result<fba::DecodedStream> decoded = fba::decode(stream);
  if (!decoded) return decoded.error();
  return fba::fill(*decoded);
}

// All FAPs of the clip have the same values in both.
Result<bool> same_values(const fap::Sequence& clip, const Bytes& a, const Bytes& b) {
  Result<fap::Sequence> frames_a = shown(a);
  if (!frames_a) return frames_a.error();
  Result<fap::Sequence> frames_b = shown(b);
  if (!frames_b) return frames_b.error();
  const fap::Mask used = used_mask(clip.frames);
  if (frames_a->frames.size() != frames_b->frames.size()) return false;
  for (std::size_t i = 0; i < frames_a->frames.size(); ++i) {
    for (std::size_t fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
      if (!used[fap]) continue;
      if (frames_a->frames[i].value[fap] != frames_b->frames[i].value[fap]) return false;
    }
  }
  return true;
}

double log2_factorial(double n) { return std::lgamma(n + 1) / std::log(2.0); }

// Code length of the differences of a row in an adaptive model that starts flat, with exactly the
// symbols from the smallest to the largest difference. The format has ranges in steps of 60 only,
// and needs headers, ranges and intra values besides: with one intra plane no choice of ranges
// gets below.
double floor_of(const std::vector<std::int64_t>& levels) {
  std::map<std::int64_t, int> count;
  for (std::size_t i = 1; i < levels.size(); ++i) ++count[levels[i] - levels[i - 1]];
  if (count.empty()) return 0;
  const double n = double(count.rbegin()->first - count.begin()->first) + 1;
  double bits = log2_factorial(n - 1 + double(levels.size() - 1)) - log2_factorial(n - 1);
  for (const auto& [level, times] : count) bits -= log2_factorial(times);
  return bits;
}

// The same of all FAPs that a stream codes.
double floor_of(const fba::DecodedStream& stream, int quant) {
  double bits = 0;
  for (int fap = fap::kFirstLowLevel; fap <= fap::kFapCount; ++fap) {
    if (!stream.planes.front().face.mask[std::size_t(fap)]) continue;
    const int step = quant == 0 ? 1 : fap::info(fap).quant_step * quant;
    std::vector<std::int64_t> levels;
    for (const fba::Plane& plane : stream.planes) {
      levels.push_back(plane.face.value[std::size_t(fap)] / step);
    }
    bits += floor_of(levels);
  }
  return bits;
}

Json clip_json(const ClipSizes& clip) {
  return {{"clip", clip.name},
          {"planes", clip.planes},
          {"all_bits", clip.all_bits},
          {"file_bits", clip.file_bits},
          {"file_ratio", clip.file_ratio()},
          {"same_values", clip.same_values},
          {"floor_bits", clip.floor_bits},
          {"floor_ratio", clip.floor_ratio()},
          {"kept_bits", clip.kept_bits},
          {"kept_to_file", clip.kept_ratio()},
          {"live_5s_bits", clip.live5_bits},
          {"live_5s_to_file", clip.live5_ratio()},
          {"live_1s_bits", clip.live1_bits},
          {"live_1s_to_file", clip.live1_ratio()},
          {"live_1s_kbit_per_s", clip.live1_kbps()},
          {"limited_bits", clip.limited_bits},
          {"limited_ratio", clip.limited_ratio()},
          {"limited_fap_quant", clip.limited_quant},
          {"limited_rms", clip.limited_rms}};
}

double mean(const std::vector<ClipSizes>& clips, double (ClipSizes::*ratio)() const) {
  double sum = 0;
  for (const ClipSizes& clip : clips) sum += (clip.*ratio)();
  return sum / double(clips.size());
}

}  // namespace

Result<ClipSizes> measure_sizes(const std::string& name, const fap::Sequence& clip, int quant,
                                double max_rms) {
  ClipSizes sizes;
  sizes.name = name;
  sizes.planes = clip.frames.size();
  if (sizes.planes > 0) {
    sizes.seconds =
        clip.rate.seconds(double(clip.frames.back().number - clip.frames.front().number + 1));
  }
  fba::EncodeReport report;
  const auto coded = [&](fba::EncodeOptions options, double& bits) -> Result<Bytes> {
    Result<Bytes> stream = fba::encode(clip, options, {}, &report);
    if (stream) bits = double(stream->size()) * 8;
    return stream;
  };
  fba::EncodeOptions options = fba::file_options();
  options.fap_quant = quant;
  Result<Bytes> file = coded(options, sizes.file_bits);
  if (!file) return file.error();
  options.kept_ranges = true;
  if (auto kept = coded(options, sizes.kept_bits); !kept) return kept.error();
  options = fba::live_options();
  options.fap_quant = quant;
  options.stream.plane_start_codes = fba::PlaneStartCodes::intra;
  options.intra_seconds = 5;
  if (auto live = coded(options, sizes.live5_bits); !live) return live.error();
  options.intra_seconds = 1;
  if (auto live = coded(options, sizes.live1_bits); !live) return live.error();
  options = fba::file_options();
  options.max_rms = max_rms;
  if (auto limited = coded(options, sizes.limited_bits); !limited) return limited.error();
  sizes.limited_quant = report.fap_quant;
  sizes.limited_rms = report.rms;
  Result<Bytes> all = encode_all(clip);
  if (!all) return all.error();
  sizes.all_bits = double(all->size()) * 8;
  options = {};
  options.fap_quant = quant;
  Result<Bytes> plain = fba::encode(clip, options);
  if (!plain) return plain.error();
  Result<bool> same = same_values(clip, *plain, *file);
  if (!same) return same.error();
  sizes.same_values = *same;
  Result<fba::DecodedStream> decoded = fba::decode(*file);
  if (!decoded) return decoded.error();
  sizes.floor_bits = floor_of(*decoded, quant);
  return sizes;
}

std::string sizes_heading() {
  return tools::format(
      "bits a plane; shares of all 66, of file, and kbit/s:\n"
      "%-22s %6s %7s %7s %6s %6s | %6s %6s %6s %7s | %7s %6s %5s %5s\n",
      "clip", "planes", "all 66", "file", "", "floor", "kept", "live5", "live1", "kbit/s",
      "limited", "", "quant", "error");
}

std::string sizes_row(const ClipSizes& clip) {
  const double planes = double(clip.planes);
  return tools::format(
      "%-22s %6zu %7.1f %7.1f %6.3f %6.3f | %6.3f %6.3f %6.3f %7.2f | %7.1f %6.3f %5d %5.2f%s\n",
      clip.name.c_str(), clip.planes, clip.all_bits / planes, clip.file_bits / planes,
      clip.file_ratio(), clip.floor_ratio(), clip.kept_ratio(), clip.live5_ratio(),
      clip.live1_ratio(), clip.live1_kbps(), clip.limited_bits / planes, clip.limited_ratio(),
      clip.limited_quant, clip.limited_rms, clip.same_values ? "" : "  VALUES DIFFER");
}

std::string sizes_means(const std::vector<ClipSizes>& clips, int quant, double max_rms) {
  return tools::format("%-22s %6zu %7s %7s %6.3f %6.3f | %6.3f %6.3f %6.3f %7.2f | %7s %6.3f\n",
                       "mean of the clips", clips.size(), "", "",
                       mean(clips, &ClipSizes::file_ratio), mean(clips, &ClipSizes::floor_ratio),
                       mean(clips, &ClipSizes::kept_ratio), mean(clips, &ClipSizes::live5_ratio),
                       mean(clips, &ClipSizes::live1_ratio), mean(clips, &ClipSizes::live1_kbps),
                       "", mean(clips, &ClipSizes::limited_ratio)) +
         tools::format(
             "\nall 66: every FAP coded in ranges of +-1860 at fap_quant 1, one intra plane\n"
             "file: preset file at fap_quant %d, the same values as plain once filled in\n"
             "floor: the differences of these values alone, in models exactly as wide as they are\n"
             "kept: the same with --kept-ranges, share of file\n"
             "live5, live1: preset live, random access points every 5 s and every second, share of "
             "file; "
             "kbit/s of live1\n"
             "limited: preset file with an error of at most %g FAP units RMS over the FAPs that "
             "move\n",
             quant, max_rms);
}

std::string sizes_json(const std::vector<ClipSizes>& clips, int quant, double max_rms) {
  const Json json = {{"fap_quant", quant},
                     {"max_rms", max_rms},
                     {"clips", tools::json_list(clips, clip_json)},
                     {"mean_file_ratio", mean(clips, &ClipSizes::file_ratio)},
                     {"mean_floor_ratio", mean(clips, &ClipSizes::floor_ratio)},
                     {"mean_kept_to_file", mean(clips, &ClipSizes::kept_ratio)},
                     {"mean_live_5s_to_file", mean(clips, &ClipSizes::live5_ratio)},
                     {"mean_live_1s_to_file", mean(clips, &ClipSizes::live1_ratio)},
                     {"mean_live_1s_kbit_per_s", mean(clips, &ClipSizes::live1_kbps)},
                     {"mean_limited_ratio", mean(clips, &ClipSizes::limited_ratio)}};
  return tools::pretty(json);
}

}  // namespace animeme::inspect
